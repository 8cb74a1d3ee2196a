"""Where the tests find things, and a level that several of them use."""

import ast
import os
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

import brume
import numpy as np

SOURCE = Path(os.environ["BRUME_SOURCE_DIR"])
BUILD = Path(os.environ["BRUME_BUILD_DIR"])
PROGRAM = os.environ["BRUME_PROGRAM"]
DEMO = SOURCE / "scenes" / "demo.toml"
STUBS = ast.parse(Path(brume.__file__).with_name("__init__.pyi").read_text())


class EventCall(NamedTuple):
    """A function of World that adds an event."""
    name: str
    arguments: list  # Such as it takes: places and numbers of the first room of two_rooms.
    places: list  # Indices of those that are points.
    numbers: list  # Names of the numbers that have defaults.

    def __call__(self, world, *arguments, **named):
        getattr(world, self.name)(*arguments or self.arguments, **named)


def event_calls():
    """All of them, by the type stubs."""
    world = next(node for node in STUBS.body if isinstance(node, ast.ClassDef) and node.name == "World")
    for function in (node for node in world.body if isinstance(node, ast.FunctionDef)):
        named = {argument.arg: ast.unparse(argument.annotation) for argument in function.args.kwonlyargs}
        if not {"time", "tick"} <= set(named):
            continue
        required = function.args.args[1:len(function.args.args) - len(function.args.defaults)]
        places = [i for i, argument in enumerate(required) if ast.unparse(argument.annotation) == "_Point"]
        corners = iter([(1, 1, 5), (9, 2, 6)])
        arguments = [next(corners) if i in places else 1 for i in range(len(required))]
        yield EventCall(function.name, arguments, places, [name for name, kind in named.items() if kind == "float"])


def run_brume(*arguments):
    """Runs the program; returns its standard output."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def work_folder():
    """A folder that is removed: a context of its path."""
    return tempfile.TemporaryDirectory(prefix="brume_python_")


def two_rooms(voxel_size=0.5):
    """Two rooms of 10 x 5 x 10 m with a wall between them, at x = 10 to 10.5 m, and a door in it."""
    solid = np.zeros((41, 10, 20), bool)
    solid[20] = True
    solid[20, :5, 8:12] = False
    return brume.Level.from_array(solid, voxel_size)


def smoky_world(seconds=2.0):
    """A smoke of 1,800 voxels in the first room, and through the door."""
    world = brume.World(two_rooms())
    world.throw_smoke((5, 1, 5), (5, 1, 5))
    world.advance_to(seconds)
    return world


def lines_through(world, count, seed=1, metres=10):
    """Ends of lines whose middles lie in the smoke, float32 of the shape (count, 3)."""
    random = np.random.default_rng(seed)
    density = world.density()
    voxels = np.argwhere(density.values > 0)
    middles = (density.matrix[:3, :3] @ voxels.T).T + density.matrix[:3, 3]
    middles = middles[random.integers(len(middles), size=count)]
    directions = random.normal(size=(count, 3))
    half = metres / 2 * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    return (middles - half).astype(np.float32), (middles + half).astype(np.float32)


def shoot_holes(world, count, seed=2):
    """Shoots between points of the smoke until so many holes are open, and waits until they are wide open."""
    random = np.random.default_rng(seed)
    density = world.density()
    voxels = np.argwhere(density.values > 0)
    places = (density.matrix[:3, :3] @ voxels.T).T + density.matrix[:3, 3]
    while world.holes < count:
        a, b = places[random.integers(len(places), size=2)]
        if (a != b).any():
            world.shoot(a, b)
    world.step(25)
