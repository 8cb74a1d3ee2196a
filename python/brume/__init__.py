"""Real-time voxel smoke: levels, worlds, lines of sight, pictures and volumes, in and out as NumPy arrays.

Positions are in metres, y points up, times are in seconds. Arrays of voxels have the axes (x, y, z). Errors are
Python's: ValueError for bad input, OSError for files, MemoryError beyond a limit, RuntimeError without a device.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np


def _find_converter() -> None:
    """Sets BRUME_VDB to the program that the module was built or installed with, unless it is set."""
    parents = Path(__file__).resolve().parents
    for level, path in ((2, "brume-vdb"), (4, "bin/brume-vdb")):  # The build folder; PREFIX.
        if level < len(parents) and (program := parents[level] / path).is_file():
            os.environ.setdefault("BRUME_VDB", str(program))
            return


_find_converter()

from ._brume import Level, Receiver, Renderer, Scenario, Sender, Smoke, World, convert, load, save_png  # noqa: E402
from ._grids import Grid, read_grids, write_grids  # noqa: E402

__all__ = ["Grid", "Level", "Receiver", "Renderer", "Scenario", "Sender", "Smoke", "World", "convert", "load",
           "read_grids", "render", "save_png", "write_grids"]


def _density(self, low=None, high=None, *, dtype="float32"):
    """Densities at the centres of voxels as a Grid, which write_grids takes.

    low, high: the voxels [low, high), three whole numbers each; default: the whole level.
    dtype: "float32", 0 to 1, or "uint8", the steps of 1/255 that the simulation counts in.

    Grid.values has the shape (x, y, z); Grid.low, Grid.matrix, Grid.origin and Grid.voxel_size are its place. Holes
    and the noise of pictures are no part of the densities. Raises ValueError for a box that is empty or
    leaves the level, MemoryError beyond 2^30 voxels.
    """
    dtype = np.dtype(dtype)
    if dtype not in (np.dtype("float32"), np.dtype("uint8")):
        raise ValueError(f"dtype: expected float32 or uint8, got {dtype}")
    size, origin = np.float64(self.level.voxel_size), np.array(self.level.origin, dtype=float)
    matrix = np.diag([size, size, size, 1.0])
    matrix[:3, 3] = origin + size / 2
    time, tick = self.time, self.tick
    values = self._density(low, high, dtype == np.dtype("uint8"))
    return Grid(values=values, low=(0, 0, 0) if low is None else tuple(int(i) for i in low), matrix=matrix,
                background=dtype.type(0),
                metadata={"extinction": np.float32(self.extinction), "tick": np.int32(tick), "time": time})


def render(source, time=None, *, size=(1280, 720), camera=None, march="full", samples=None, linear=False, device=""):
    """A picture of a timeline, scene or volume, as brume render draws it.

    source: a path, or a Scenario of load().
    time: [s], 0 to 3600; default: the end of the timeline.
    size: (width, height) [px], each 1 to 16384.
    camera: (position, target) or (position, target, degrees); default: the timeline's.
    march: rays through the smoke: "full", "half" or "quarter" resolution.
    samples: frames that the picture is the mean of; default: 64 with an aperture or a shutter, else 1.
    linear: radiance before exposure and tone curve, instead of colours.
    device: number or part of the name of a Vulkan device; default: the fastest.

    Returns an array of the shape (height, width, 3), rows from the top: uint8, the bytes of brume render's .png, or
    float32 where linear. For several pictures of one scene, a Renderer is faster. Raises as load and Renderer do.
    """
    if not isinstance(source, Scenario):
        width, height = size
        if not (0 < width <= 16384 and 0 < height <= 16384):
            raise ValueError("size: expected (width, height), each 1 to 16384 pixels")
        source = load(source, aspect=width / height, camera=camera)
    renderer = Renderer(source, size=tuple(size), march=march, linear=linear, device=device)
    return renderer.draw(time, camera=camera, samples=samples)


Smoke.density = _density
Smoke.density.__name__, Smoke.density.__qualname__ = "density", "Smoke.density"
