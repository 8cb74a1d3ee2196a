"""Grids of volume files as arrays."""

from __future__ import annotations

import os
import struct
from dataclasses import dataclass, field
from typing import Any, Iterable, Optional, Sequence

import numpy as np

from . import _brume

_TYPES = {"float32": "float32", "float64": "float64", "int32": "int32", "int64": "int64", "bool": "boolean"}
_VECTOR_TYPES = {"float32": "vec3f", "float64": "vec3d", "int32": "vec3i"}
_VECTOR_METADATA = {"vec3s": "float32", "vec3d": "float64", "vec3i": "int32"}
_SCALAR_METADATA = {"float": np.float32, "double": np.float64, "int32": np.int32, "int64": np.int64}


@dataclass(eq=False)
class Grid:
    """Values of voxels with their place, as a volume file holds them.

    values: shape (x, y, z), or (x, y, z, 3) for vectors; float32, float64, int32, int64 or bool (vectors: the
        first three).
    name: "density", "flames", ...
    low: index of the voxel values[0, 0, 0]: three whole numbers.
    matrix: shape (4, 4): matrix @ (i, j, k, 1) is the centre of the voxel of index (i, j, k) in the file's world.
    active: bool, shape (x, y, z): which voxels hold something; default: those that differ from the background.
    background: value of all voxels outside of the array; default: 0.
    grid_class: "unknown", "fog volume", "level set" or "staggered".
    metadata: values by name: str, bool, numbers (NumPy's keep their type), arrays of three numbers, and
        (type, bytes) for what has no other form.
    is_mask: whether a grid of bool has no values, only active voxels.
    half: whether a file stores its floats in 16 bits.
    """

    values: np.ndarray
    name: str = "density"
    low: Sequence[int] = (0, 0, 0)
    matrix: np.ndarray = field(default_factory=lambda: np.eye(4))
    active: Optional[np.ndarray] = None
    background: Any = 0
    grid_class: str = "fog volume"
    metadata: dict = field(default_factory=dict)
    is_mask: bool = False
    half: bool = False

    @property
    def origin(self) -> np.ndarray:
        """The low corner of voxel values[0, 0, 0] in the world, shape (3,)."""
        corner = np.append(np.asarray(self.low, dtype=float) - 0.5, 1)
        return (np.asarray(self.matrix, dtype=float) @ corner)[:3]

    @property
    def voxel_size(self) -> np.ndarray:
        """Edge lengths of a voxel along the axes of the array, shape (3,)."""
        return np.linalg.norm(np.asarray(self.matrix, dtype=float)[:3, :3], axis=0)

    def __repr__(self) -> str:
        return f"Grid(name={self.name!r}, shape={np.shape(self.values)}, dtype={np.asarray(self.values).dtype})"


def _metadata_value(kind: str, data: bytes) -> Any:
    if kind == "string":
        return data.decode(errors="surrogateescape")
    if kind == "bool" and len(data) == 1:
        return data != b"\0"
    if kind in _SCALAR_METADATA and len(data) == np.dtype(_SCALAR_METADATA[kind]).itemsize:
        return np.frombuffer(data, _SCALAR_METADATA[kind])[0]
    if kind in _VECTOR_METADATA and len(data) == 3 * np.dtype(_VECTOR_METADATA[kind]).itemsize:
        return np.frombuffer(data, _VECTOR_METADATA[kind]).copy()
    return kind, data


def _metadata_entry(name: str, value: Any) -> tuple:
    if not isinstance(name, str):
        raise TypeError("metadata: expected names of str")
    if isinstance(value, str):
        return name, "string", value.encode(errors="surrogateescape")
    if isinstance(value, (bool, np.bool_)):
        return name, "bool", struct.pack("?", value)
    if isinstance(value, int):
        if not -(2**63) <= value < 2**63:
            raise ValueError(f"metadata: {name}: does not fit 64 bits")
        kind = "int32" if -(2**31) <= value < 2**31 else "int64"
        return name, kind, _SCALAR_METADATA[kind](value).tobytes()
    for kind, scalar in _SCALAR_METADATA.items():
        if isinstance(value, scalar) or (kind == "double" and isinstance(value, float)):
            return name, kind, scalar(value).tobytes()
    if isinstance(value, np.ndarray) and value.shape == (3,):
        for kind, dtype in _VECTOR_METADATA.items():
            if value.dtype == dtype:
                return name, kind, value.tobytes()
    if isinstance(value, tuple) and len(value) == 2 and isinstance(value[0], str) and isinstance(value[1], bytes):
        return name, *value
    raise TypeError(f"metadata: {name}: a value of {type(value).__name__} has no form in files")


def _grid_of(data: dict) -> Grid:
    background = data["background"]
    metadata = {name.decode(errors="surrogateescape"): _metadata_value(kind.decode(errors="replace"), value)
                for name, kind, value in data["metadata"]}
    return Grid(values=data["values"], name=data["name"].decode(errors="surrogateescape"), low=data["low"],
                matrix=data["matrix"], active=data["active"],
                background=background if len(background) == 3 else background[0], grid_class=data["grid_class"],
                metadata=metadata, is_mask=data["type"] == "mask", half=data["half"])


def _data_of(grid: Grid) -> dict:
    if not isinstance(grid, Grid):
        raise TypeError(f"grids: expected objects of brume.Grid, got {type(grid).__name__}")
    values = np.asarray(grid.values)
    types = _VECTOR_TYPES if values.ndim == 4 else _TYPES
    if values.ndim not in (3, 4) or (values.ndim == 4 and values.shape[3] != 3):
        raise ValueError(f"values: expected the shape (x, y, z) or (x, y, z, 3), got {values.shape}")
    if values.dtype.name not in types:
        raise TypeError(f"values: a file holds {', '.join(types)}, not {values.dtype}")
    if grid.is_mask and values.dtype != bool:
        raise TypeError("values: a mask is an array of bool")
    if not isinstance(grid.name, str) or not isinstance(grid.grid_class, str):
        raise TypeError("name, grid_class: expected str")
    if np.asarray(grid.background).dtype.kind not in "fiub":
        raise TypeError(f"background: expected a value of {values.dtype}")
    dtype = values.dtype.newbyteorder("=")
    components = 3 if values.ndim == 4 else 1
    try:
        background = np.array(np.broadcast_to(np.asarray(grid.background), (components,)), dtype=dtype)
    except (TypeError, ValueError) as error:
        raise ValueError(f"background: is no value of {dtype}") from error
    active = grid.active
    if active is None:
        differs = values != background
        active = values if grid.is_mask else differs.any(axis=3) if components == 3 else differs
    active = np.asarray(active)
    if active.dtype != bool or active.shape != values.shape[:3]:
        raise ValueError(f"active: expected bool of the shape {values.shape[:3]}, got {active.dtype} of {active.shape}")
    return {"name": grid.name, "type": "mask" if grid.is_mask else types[values.dtype.name],
            "grid_class": grid.grid_class, "half": bool(grid.half), "matrix": grid.matrix, "background": background,
            "low": grid.low, "values": np.ascontiguousarray(values, dtype=dtype),
            "active": np.ascontiguousarray(active),
            "metadata": [_metadata_entry(*entry) for entry in grid.metadata.items()]}


def read_grids(path: str | os.PathLike, *, names: Optional[Iterable[str]] = None) -> list[Grid]:
    """Reads the grids of a volume file (.vdb, .nvdb, .brv, or .json that describes a raw array) into arrays.

    names: the grids to take; default: all.

    Each array is the smallest one around all voxels that are active or differ from the background, at most 2^30
    voxels. Metadata of the file itself are not read. .vdb and .nvdb files are read in a child process (see convert).
    Raises FileNotFoundError, ValueError for a damaged file or an unknown name, MemoryError for what is too large,
    RuntimeError without brume-vdb.
    """
    return [_grid_of(data) for data in _brume._read_grids(path, None if names is None else list(names))]


def write_grids(path: str | os.PathLike, grids: Grid | Iterable[Grid]) -> None:
    """Writes grids to a volume file, by its suffix: .vdb, .nvdb, .brv, or .json with a .raw file beside it.

    The file is complete or not there. Voxels that are not active and of the background's value take no space. Raises
    OSError where it cannot be written, ValueError for what the format cannot hold, TypeError for another dtype,
    RuntimeError without brume-vdb.
    """
    _brume._write_grids(path, [_data_of(grid) for grid in ([grids] if isinstance(grids, Grid) else grids)])
