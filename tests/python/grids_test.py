"""Volume files: what is written comes back, in every format."""

import os
import signal
import subprocess
import sys
import threading
import unittest
from pathlib import Path
from unittest import mock

import brume
import numpy as np
from places import SOURCE, run_brume, smoky_world, work_folder


def assert_same(test, a, b):
    np.testing.assert_array_equal(a.values, b.values)
    test.assertEqual(a.values.dtype, b.values.dtype)
    np.testing.assert_array_equal(a.active, b.active)
    np.testing.assert_array_equal(a.matrix, b.matrix)
    np.testing.assert_array_equal(a.background, b.background)
    test.assertEqual((a.name, a.grid_class, tuple(a.low), a.is_mask, a.half),
                     (b.name, b.grid_class, tuple(b.low), b.is_mask, b.half))


def tight(values, seed=4):
    """A grid of the values that no smaller array holds: its corners are active."""
    active = np.random.default_rng(seed).random(values.shape[:3]) < 0.2
    active[0, 0, 0] = active[-1, -1, -1] = True
    matrix = np.array([[0.5, 0.1, 0, 3], [0, 0.25, 0, -2], [0, 0, 2, 7], [0, 0, 0, 1]])
    return brume.Grid(values, "some", (-5, 9, 100), matrix, active)


class RoundTripTest(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(3)

    def check(self, grid, suffixes=(".brv", ".vdb", ".nvdb")):
        with work_folder() as folder:
            for suffix in suffixes:
                path = Path(folder) / ("grid" + suffix)
                brume.write_grids(path, grid)
                (again,) = brume.read_grids(path)
                with self.subTest(suffix):
                    assert_same(self, again, grid)
                    for key, value in grid.metadata.items():
                        np.testing.assert_array_equal(again.metadata[key], value)

    def test_numbers(self):
        for dtype in ("float32", "float64", "int32", "int64"):
            grid = tight((100 * self.random.normal(size=(11, 8, 17))).astype(dtype))
            grid.background = np.dtype(dtype).type(7)
            self.check(grid, (".brv", ".vdb", ".nvdb") if dtype != "float64" else (".brv", ".vdb"))

    def test_vectors(self):
        for dtype in ("float32", "float64", "int32"):
            grid = tight((100 * self.random.normal(size=(9, 5, 3, 3))).astype(dtype))
            grid.background = np.array([1, 2, 3], dtype)
            self.check(grid, (".brv", ".vdb"))

    def test_truths_and_masks(self):
        grid = tight(self.random.random((4, 9, 30)) < 0.5)
        grid.background = np.bool_(False)
        self.check(grid, (".brv", ".vdb"))
        mask = tight(self.random.random((4, 9, 30)) < 0.5)
        mask.values, mask.is_mask, mask.background = mask.active, True, np.bool_(False)
        self.check(mask, (".brv", ".vdb"))

    def test_smoke_with_its_metadata(self):
        whole = smoky_world().density()
        filled = np.argwhere(whole.values > 0)
        low, high = filled.min(axis=0), filled.max(axis=0) + 1
        grid = smoky_world().density(low, high)
        grid.active = grid.values > 0
        grid.metadata["creator"] = "a test"
        grid.metadata["corner"] = np.array([1, 2, 3], np.int32)
        self.check(grid, (".brv", ".vdb"))
        self.assertEqual(grid.metadata["tick"], 128)
        self.assertEqual(grid.metadata["time"], 2)

    def test_several_grids_and_names(self):
        a, b = tight(np.ones((2, 3, 4), np.float32)), tight(np.ones((5, 6, 7), np.int32))
        a.name, b.name = "a", "b"
        with work_folder() as folder:
            path = folder + "/two.vdb"
            brume.write_grids(path, [a, b])
            self.assertEqual({grid.name for grid in brume.read_grids(path)}, {"a", "b"})
            (only,) = brume.read_grids(path, names=["b"])
            assert_same(self, only, brume.Grid(b.values, "b", b.low, b.matrix, b.active))
            with self.assertRaisesRegex(ValueError, "no grid c; it has"):
                brume.read_grids(path, names=["c"])
            brume.convert(path, folder + "/one.brv", names=["a"])
            (only,) = brume.read_grids(folder + "/one.brv")
            assert_same(self, only, brume.Grid(a.values, "a", a.low, a.matrix, a.active))

    def test_conversion_equals_that_of_the_program(self):
        with work_folder() as folder:
            run_brume("sim", SOURCE / "scenes/single.toml", "--ticks", 100, "--volumes", folder + "/smoke.vdb")
            brume.convert(folder + "/smoke.vdb", folder + "/python.brv")
            run_brume("convert", folder + "/smoke.vdb", folder + "/program.brv")
            self.assertEqual(Path(folder, "python.brv").read_bytes(), Path(folder, "program.brv").read_bytes())
            scenario = brume.load(SOURCE / "scenes/single.toml")
            scenario.advance_to(99 / 64)
            (grid,) = brume.read_grids(folder + "/smoke.vdb")
            high = np.array(grid.low) + grid.values.shape
            same = scenario.density(grid.low, high)
            # Beside walls, whose voxels have no smoke, the file has more.
            inner = same.values > 0
            for axis in range(3):
                inner = np.logical_and.reduce([np.roll(inner, step, axis) for step in range(-2, 3)])
            self.assertGreater(inner.sum(), 500)
            np.testing.assert_array_equal(same.values[inner], grid.values[inner])
            self.assertGreater(grid.values.sum(), same.values.sum())
            np.testing.assert_allclose(same.origin, grid.origin)
            self.assertEqual(grid.metadata["tick"], same.metadata["tick"])

    def test_nothing_is_a_grid_too(self):
        with work_folder() as folder:
            brume.write_grids(folder + "/none.brv", brume.Grid(np.zeros((3, 3, 3), np.float32)))
            (grid,) = brume.read_grids(folder + "/none.brv")
            self.assertEqual(grid.values.shape, (0, 0, 0))
            brume.write_grids(folder + "/none.brv", grid)
            brume.write_grids(folder + "/none.brv", [])
            self.assertEqual(brume.read_grids(folder + "/none.brv"), [])

    def test_level_sets_hold_their_inside(self):
        values = np.full((24, 24, 24), 3, np.float32)
        values[4:20, 4:20, 4:20] = -3
        grid = brume.Grid(values, "ball", background=3.0, grid_class="level set", active=np.abs(values) < 3)
        with work_folder() as folder:
            brume.write_grids(folder + "/ball.vdb", grid)
            (again,) = brume.read_grids(folder + "/ball.vdb")
        self.assertEqual(again.values.shape, (16, 16, 16))
        self.assertEqual(tuple(again.low), (4, 4, 4))
        self.assertEqual(again.values.max(), -3)


class PlaceTest(unittest.TestCase):
    def test_origin_and_voxel_size(self):
        grid = tight(np.ones((2, 3, 4), np.float32))
        np.testing.assert_allclose(grid.origin, grid.matrix[:3] @ (-5.5, 8.5, 99.5, 1))
        np.testing.assert_allclose(grid.voxel_size, [0.5, np.hypot(0.1, 0.25), 2])


class ProgramTest(unittest.TestCase):
    def test_missing_converter_is_a_runtime_error(self):
        with work_folder() as folder:
            brume.write_grids(folder + "/a.brv", brume.Grid(np.ones((2, 2, 2), np.float32)))
            code = f"import brume; brume.convert({folder + '/a.brv'!r}, {folder + '/a.vdb'!r})"
            done = subprocess.run([sys.executable, "-B", "-c", code],
                                  env={**os.environ, "BRUME_VDB": "/nowhere/brume-vdb"}, capture_output=True,
                                  text=True, check=False)
            self.assertRegex(done.stderr, "RuntimeError: .*requires the program brume-vdb")


    def test_ctrl_c_ends_a_program_that_hangs(self):
        with work_folder() as folder:
            slow, started = Path(folder) / "slow", Path(folder) / "started"
            slow.write_text(f"#!/bin/sh\n: > '{started}'\nexec sleep 600\n")
            slow.chmod(0o755)
            Path(folder, "a.vdb").write_bytes(b"anything")
            is_over = threading.Event()

            def request():
                while not started.exists() and not is_over.wait(0.01):
                    pass
                if started.exists():
                    signal.raise_signal(signal.SIGINT)

            sender = threading.Thread(target=request)
            with mock.patch.dict(os.environ, BRUME_VDB=str(slow)):
                sender.start()
                try:
                    with self.assertRaises(KeyboardInterrupt):
                        brume.read_grids(folder + "/a.vdb")
                finally:
                    is_over.set()
                    sender.join()


if __name__ == "__main__":
    unittest.main()
