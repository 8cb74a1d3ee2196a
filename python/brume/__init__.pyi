# Types of the module; its docstrings describe units, shapes and ranges.
import os
from typing import Any, Iterable, Literal, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Path = str | os.PathLike[str]
_Point = Sequence[float] | NDArray[Any]
_March = Literal["full", "half", "quarter"]
_Camera = tuple[_Point, _Point] | tuple[_Point, _Point, float]

class Level:
    @staticmethod
    def from_array(solid: NDArray[np.bool_], voxel_size: float = 0.25, origin: _Point = (0.0, 0.0, 0.0)) -> Level: ...
    @staticmethod
    def from_triangles(
        triangles: ArrayLike,
        voxel_size: float = 0.25,
        *,
        size: Optional[Sequence[int]] = None,
        origin: Optional[_Point] = None,
        margin: int = 2,
        roles: Optional[ArrayLike] = None,
    ) -> Level: ...
    @staticmethod
    def load(path: _Path, voxel_size: float = 0.25, *, margin: int = 2) -> Level: ...
    def save(self, path: _Path) -> None: ...
    @property
    def size(self) -> tuple[int, int, int]: ...
    @property
    def voxel_size(self) -> float: ...
    @property
    def origin(self) -> tuple[float, float, float]: ...
    @property
    def solid(self) -> NDArray[np.bool_]: ...
    @property
    def roles(self) -> NDArray[np.uint8]: ...
    @property
    def hash(self) -> int: ...

class Smoke:
    @property
    def level(self) -> Level: ...
    @property
    def solid(self) -> NDArray[np.bool_]: ...
    @property
    def extinction(self) -> float: ...
    @property
    def tick(self) -> int: ...
    @property
    def ticks_per_second(self) -> int: ...
    @property
    def time(self) -> float: ...
    @property
    def state_hash(self) -> int: ...
    @property
    def clouds(self) -> int: ...
    @property
    def flights(self) -> int: ...
    @property
    def holes(self) -> int: ...
    def optical_depth(
        self, a: ArrayLike, b: ArrayLike, drawn: bool = False
    ) -> float | NDArray[np.float32]: ...
    def visible(
        self, a: ArrayLike, b: ArrayLike, threshold: float = 3.0, drawn: bool = False
    ) -> bool | NDArray[np.bool_]: ...
    def sense(
        self, origins: ArrayLike, directions: ArrayLike, max_distance: float = 100.0
    ) -> tuple[float, float] | tuple[NDArray[np.float32], NDArray[np.float32]]: ...
    def density(
        self,
        low: Optional[Sequence[int]] = None,
        high: Optional[Sequence[int]] = None,
        *,
        dtype: Any = "float32",
    ) -> Grid: ...

class World(Smoke):
    def __init__(
        self,
        level: Level,
        *,
        extinction: float = 3.0,
        ticks_per_second: int = 64,
        masks: Sequence[NDArray[np.uint8]] = (),
    ) -> None: ...
    def throw_smoke(
        self,
        origin: _Point,
        at: _Point,
        *,
        time: Optional[float] = None,
        tick: Optional[int] = None,
        voxels: int = 1800,
        bloom: float = 1.0,
        hold: float = 18.0,
        dissolve: float = 3.0,
    ) -> None: ...
    def shoot(
        self,
        origin: _Point,
        toward: _Point,
        *,
        time: Optional[float] = None,
        tick: Optional[int] = None,
        radius: float = 0.2,
        reach: float = 0.25,
        expand: float = 0.05,
        stay: float = 1.0,
        fade: float = 0.35,
        shape: Literal["cylinder", "box"] = "cylinder",
        roll: float = 0.0,
        mask: Optional[int] = None,
    ) -> None: ...
    def blast(
        self,
        at: _Point,
        *,
        time: Optional[float] = None,
        tick: Optional[int] = None,
        radius: float = 5.0,
        speed: float = 32.0,
        remaining: float = 0.02,
        refill_rim: float = 0.5,
        refill_middle: float = 5.0,
    ) -> None: ...
    def move_body(
        self, body: int, to: _Point, *, time: Optional[float] = None, tick: Optional[int] = None
    ) -> None: ...
    def set_solid(
        self,
        low: _Point,
        high: _Point,
        solid: bool = True,
        *,
        time: Optional[float] = None,
        tick: Optional[int] = None,
    ) -> None: ...
    def advance_to(self, time: Optional[float] = None, *, tick: Optional[int] = None) -> None: ...
    def step(self, ticks: int = 1) -> None: ...
    @property
    def earliest_tick(self) -> int: ...
    def forget_before(self, time: Optional[float] = None, *, tick: Optional[int] = None) -> None: ...
    def save(self) -> bytes: ...
    def restore(self, state: bytes) -> None: ...

class Sender:
    def __init__(self, *, history: int = 128) -> None: ...
    def push(self, smoke: Smoke) -> bytes: ...
    def answer(self, request: bytes) -> bytes: ...

class Receiver:
    def __init__(self, *, level: Optional[Level] = None, hold_ticks: int = 0) -> None: ...
    def receive(self, packet: bytes) -> Literal["applied", "old", "missed", "held"]: ...
    def request(self) -> bytes: ...
    @property
    def behind(self) -> bool: ...
    @property
    def tick(self) -> Optional[int]: ...
    @property
    def state_hash(self) -> Optional[int]: ...
    def restore(self, world: World) -> None: ...

class Scenario(Smoke):
    def advance_to(self, time: float) -> None: ...
    @property
    def duration(self) -> float: ...

class Renderer:
    def __init__(
        self,
        scenario: Scenario,
        *,
        size: tuple[int, int] = (1280, 720),
        march: _March = "full",
        linear: bool = False,
        device: str = "",
    ) -> None: ...
    def draw(
        self, time: Optional[float] = None, *, camera: Optional[_Camera] = None, samples: Optional[int] = None
    ) -> NDArray[Any]: ...
    @property
    def device(self) -> str: ...

class Grid:
    values: NDArray[Any]
    name: str
    low: Sequence[int]
    matrix: NDArray[np.float64]
    active: Optional[NDArray[np.bool_]]
    background: Any
    grid_class: str
    metadata: dict[str, Any]
    is_mask: bool
    half: bool
    def __init__(
        self,
        values: NDArray[Any],
        name: str = "density",
        low: Sequence[int] = (0, 0, 0),
        matrix: NDArray[np.float64] = ...,
        active: Optional[NDArray[np.bool_]] = None,
        background: Any = 0,
        grid_class: str = "fog volume",
        metadata: dict[str, Any] = ...,
        is_mask: bool = False,
        half: bool = False,
    ) -> None: ...
    @property
    def origin(self) -> NDArray[np.float64]: ...
    @property
    def voxel_size(self) -> NDArray[np.float64]: ...

def load(
    path: _Path,
    *,
    voxel_size: Optional[float] = None,
    scale: Optional[float] = None,
    aspect: float = 1.7777777910232544,
    camera: Optional[_Camera] = None,
) -> Scenario: ...
def render(
    source: _Path | Scenario,
    time: Optional[float] = None,
    *,
    size: tuple[int, int] = (1280, 720),
    camera: Optional[_Camera] = None,
    march: _March = "full",
    samples: Optional[int] = None,
    linear: bool = False,
    device: str = "",
) -> NDArray[Any]: ...
def save_png(path: _Path, picture: NDArray[np.uint8]) -> None: ...
def read_grids(path: _Path, *, names: Optional[Iterable[str]] = None) -> list[Grid]: ...
def write_grids(path: _Path, grids: Grid | Iterable[Grid]) -> None: ...
def convert(input: _Path, output: _Path, *, names: Optional[Iterable[str]] = None) -> None: ...
