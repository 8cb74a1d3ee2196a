"""Arguments that make no sense raise Python's exceptions, in one line, and change nothing."""

import copy
import inspect
import os
import shutil
import unittest
from pathlib import Path

import brume
import numpy as np
from places import DEMO, SOURCE, event_calls, smoky_world, two_rooms, work_folder

NAN, INF = float("nan"), float("inf")
BAD_POINTS = [(NAN, 0, 0), (0, INF, 0), (1, 2), (1, 2, 3, 4), 5, [], [[1, 2, 3]], (1e30, 0, 0), (20000, 0, 0)]
BAD_TYPES = ["abc", None, object(), ("a", "b", "c"), [[1], [2, 3]], (1j, 2, 3), (True, False, True), b"123", {}]


class Hostile(unittest.TestCase):
    def refuse(self, call, *arguments, kinds=(ValueError, TypeError), **named):
        with self.subTest(arguments=repr(arguments)[:80], **{k: repr(v)[:80] for k, v in named.items()}):
            with self.assertRaises(kinds) as caught:
                call(*arguments, **named)
            self.assertTrue(str(caught.exception))


class UnmadeTest(Hostile):
    def test_objects_without_init(self):
        world, scenario = smoky_world(), brume.load(SOURCE / "scenes/single.toml")
        kinds = (brume.Level, brume.Smoke, brume.World, brume.Scenario, brume.Sender, brume.Receiver, brume.Renderer)
        bare = {kind: kind.__new__(kind) for kind in kinds}
        derived = type("Derived", (brume.World,), {"__init__": lambda self: None})
        calls = [lambda: brume.World(bare[brume.Level]), lambda: bare[brume.Level].save("/tmp/none.vxl"),
                 lambda: brume.Renderer(bare[brume.Scenario]), lambda: bare[brume.Renderer].draw(0),
                 lambda: brume.Sender().push(bare[brume.World]), lambda: bare[brume.Sender].push(scenario),
                 lambda: brume.Receiver().restore(bare[brume.World]), lambda: bare[brume.Receiver].receive(b""),
                 lambda: bare[brume.World].step(), lambda: bare[brume.World].density(), derived,
                 lambda: derived.__new__(derived).save(), lambda: copy.copy(world)]
        for kind, one in bare.items():
            names = [name for name in dir(kind) if isinstance(inspect.getattr_static(kind, name), property)]
            calls += [lambda one=one, name=name: getattr(one, name) for name in names]
            if "__repr__" in vars(kind):
                calls.append(lambda one=one: repr(one))
        self.assertGreater(len(calls), 30)
        for call in calls:
            self.refuse(call, kinds=TypeError)


class QueryTest(Hostile):
    @classmethod
    def setUpClass(cls):
        cls.world = smoky_world()

    def test_ends_of_lines(self):
        fine = np.zeros((4, 3), np.float32)
        for call in (self.world.optical_depth, self.world.visible, self.world.sense):
            for bad in (np.zeros((4, 2)), np.zeros(3).reshape(3, 1), np.zeros(()), np.zeros((5, 3)),
                        np.zeros((1, 4, 3)), np.full((4, 3), NAN), np.full((4, 3), 1e30),
                        np.zeros((4, 3), complex), np.zeros((4, 3), bool),
                        np.zeros((4, 3), "M8[s]"), np.array([["a"] * 3] * 4), np.zeros((4, 3), object), *BAD_TYPES,
                        np.zeros((0, 3)), np.full((4, 3), 16385.0)):
                self.refuse(call, bad, fine)
                is_long = isinstance(bad, np.ndarray) and bad.dtype == float and bad.size and bad.max() > 1
                if call != self.world.sense or not is_long:  # A direction may be long.
                    self.refuse(call, fine, bad)
            self.refuse(call, fine)
            self.refuse(call)
        late = np.zeros((200_000, 3))
        late[-1, 1] = NAN
        self.refuse(self.world.optical_depth, late, late)

    def test_numbers(self):
        points = np.zeros((4, 3))
        for threshold in (NAN, -1, "much", None):
            self.refuse(self.world.visible, points, points, threshold)
        for distance in (NAN, 0, -1, INF, 1e9, "far"):
            self.refuse(self.world.sense, points, points + 1, distance)
        self.refuse(self.world.sense, points, points)

    def test_boxes(self):
        for low, high in (((0, 0, 0), (0, 5, 5)), ((5, 5, 5), (4, 9, 9)), ((-1, 0, 0), (4, 4, 4)),
                          ((0, 0, 0), (99, 4, 4)), ((0.5, 0, 0), (4, 4, 4)), ((NAN, 0, 0), None),
                          (None, (2**40, 1, 1)), ("abc", None), ((1, 2), None)):
            self.refuse(self.world.density, low, high)
        for dtype in ("int32", "float64", "nonsense", object, complex):
            self.refuse(self.world.density, dtype=dtype)


class LevelTest(Hostile):
    def test_arrays(self):
        fine = np.zeros((4, 4, 4), bool)
        for bad in (np.zeros((4, 4, 4)), np.zeros((4, 4, 4), np.uint8), np.zeros((4, 4), bool),
                    np.zeros((0, 4, 4), bool), np.zeros((1, 1, 1, 1), bool), *BAD_TYPES):
            self.refuse(brume.Level.from_array, bad)
        for size in (0, -1, NAN, INF, "small"):
            self.refuse(brume.Level.from_array, fine, size)
        for origin in (*BAD_POINTS[:7], *BAD_TYPES):
            self.refuse(brume.Level.from_array, fine, 0.5, origin)
        self.refuse(brume.Level.from_array, np.zeros((5000, 1, 1), bool), kinds=MemoryError)

    def test_triangles(self):
        fine = np.random.default_rng(0).random((5, 3, 3))
        for bad in (np.zeros((5, 3)), np.zeros((5, 3, 2)), np.zeros((0, 3, 3)), fine * NAN, fine * INF,
                    np.zeros((5, 3, 3), bool), *BAD_TYPES):
            self.refuse(brume.Level.from_triangles, bad)
        for size in (0, -1, NAN, INF):
            self.refuse(brume.Level.from_triangles, fine, size)
        self.refuse(brume.Level.from_triangles, fine, 0.5, margin=-1)
        self.refuse(brume.Level.from_triangles, fine, 0.5, margin=2**31)
        self.refuse(brume.Level.from_triangles, fine, 0.5, size=(4, 4, 4))
        self.refuse(brume.Level.from_triangles, fine, 0.5, origin=(0, 0, 0))
        for size in ((0, 4, 4), (-4, 4, 4), (1.5, 4, 4), (4, 4), (2**40, 4, 4)):
            self.refuse(brume.Level.from_triangles, fine, 0.5, size=size, origin=(0, 0, 0))
        self.refuse(brume.Level.from_triangles, 1e6 * fine, 0.02, kinds=MemoryError)
        self.refuse(brume.Level.from_triangles, fine, 0.5, size=(5000, 4, 4), origin=(0, 0, 0), kinds=MemoryError)

    def test_huge_levels_have_no_array(self):
        level = brume.Level.from_triangles([[[0, 0, 0]] * 3], 0.02, size=(4096, 4096, 4096), origin=(-1, -1, -1))
        with self.assertRaises(MemoryError):
            print(level.solid)
        world = brume.World(level)
        self.refuse(world.density, kinds=MemoryError)
        self.refuse(world.set_solid, (-1, -1, -1), (100, 100, 100), kinds=MemoryError)
        world.throw_smoke((5, 5, 5), (5, 5, 5), voxels=500)
        world.advance_to(1)
        self.assertGreater(world.density((256, 256, 256), (356, 356, 356)).values.sum(), 100)

    def test_levels_of_bad_grids_make_no_world(self):
        level = brume.Level.from_array(np.zeros((4, 4, 4), bool), 100)
        self.refuse(brume.World, level)
        self.refuse(brume.World, brume.Level.from_array(np.zeros((4, 4, 4), bool), 1e-3))
        self.refuse(brume.World, brume.Level.from_array(np.zeros((4, 4, 4), bool), 1, (1e9, 0, 0)))


class EventTest(Hostile):
    def test_worlds(self):
        level = two_rooms()
        for extinction in (NAN, -1, INF, 1e7):
            self.refuse(brume.World, level, extinction=extinction)
        for rate in (0, -1, 1001, 2**40, 1.5):
            self.refuse(brume.World, level, ticks_per_second=rate)
        for masks in ([np.zeros((4, 4))], [np.zeros(4, np.uint8)], [np.zeros((0, 4), np.uint8)], 5, ["abc"]):
            self.refuse(brume.World, level, masks=masks)
        self.refuse(brume.World, level, masks=[np.zeros((1, 5000), np.uint8)], kinds=(ValueError, MemoryError))
        self.refuse(brume.World, None)
        self.refuse(brume.World)

    def test_events_change_nothing(self):
        world = smoky_world()
        before = world.state_hash
        a, b = (1, 1, 5), (9, 1, 5)
        calls = list(event_calls())
        self.assertGreater(len(calls), 4)
        for call in calls:
            for place in call.places:
                for bad in (*BAD_POINTS, *BAD_TYPES):
                    if call.name == "set_solid" and bad in BAD_POINTS[-2:]:
                        continue  # A box may reach beyond the level.
                    self.refuse(call, world, *call.arguments[:place], bad, *call.arguments[place + 1:])
            for time in (NAN, INF, -1, 1e9, "now"):
                self.refuse(call, world, time=time)
            for tick in (-1, 2**29 + 1, 2**40, 2**70, 1.5, "now"):
                self.refuse(call, world, tick=tick)
            self.refuse(call, world, time=1, tick=1)
            for key in call.numbers:
                for bad in (NAN, INF) if key == "roll" else (NAN, INF, -1, 1e300):
                    self.refuse(call, world, **{key: bad})
        for bad in (0, -1, 2**27 + 1, 2**40, 1.5):
            self.refuse(world.throw_smoke, a, b, voxels=bad)
        self.refuse(world.shoot, a, a)
        for named in ({"shape": "star"}, {"shape": None}, {"mask": 0}, {"mask": -1}):
            self.refuse(world.shoot, a, b, **named)
        for key, bad in (("radius", 1e6), ("speed", 1e6), ("remaining", 1.1), ("refill_rim", 1e6)):
            self.refuse(world.blast, a, **{key: bad})
        for bad in (-1, 2**32, 1.5):
            self.refuse(world.move_body, bad, a)
        self.refuse(world.set_solid, (100, 0, 0), (200, 1, 1))
        self.refuse(world.set_solid, (5, 0, 0), (1, 9, 9))
        self.assertEqual(world.state_hash, before)

    def test_times(self):
        world = smoky_world()
        for bad in (NAN, INF, -1, 1e12, "soon"):
            self.refuse(world.advance_to, bad)
        for bad in (-1, 2**29 + 1, 2**70):
            self.refuse(world.advance_to, tick=bad)
        for bad in (-1, 2**32, 2**29, 1.5):
            self.refuse(world.step, bad)
        self.refuse(world.advance_to, 1, tick=1)
        world.advance_to(tick=2**29)
        self.assertEqual((world.tick, world.clouds), (2**29, 0))

    def test_states_and_packets(self):
        world = smoky_world()
        state = world.save()
        sender, receiver = brume.Sender(), brume.Receiver()
        before = world.state_hash
        random = np.random.default_rng(0)
        for bad in (b"", b"\0", state[: len(state) // 2], state[:20], os.urandom(500), sender.push(world)[:3]):
            self.refuse(world.restore, bad)
            self.refuse(receiver.receive, bad)
            self.refuse(sender.answer, bad)
        for _ in range(300):
            damaged = bytearray(state)
            damaged[random.integers(len(state))] ^= 1 << random.integers(8)
            try:
                world.restore(bytes(damaged))
            except ValueError:
                pass
            self.assertEqual(world.state_hash, before)  # Some bits at the end decode to the same state.
        for bad in ("text", None, bytearray(state), 5):
            self.refuse(world.restore, bad)
        self.assertEqual(world.state_hash, before)
        self.refuse(brume.World(two_rooms(0.25)).restore, state)
        self.refuse(brume.World(two_rooms(), ticks_per_second=32).restore, state)
        self.refuse(sender.push, world)
        self.refuse(brume.Sender().answer, receiver.request())
        self.refuse(brume.Sender, history=0)
        self.refuse(receiver.restore, world)


class FileTest(Hostile):
    def test_missing_files(self):
        for call in (brume.load, brume.Level.load, brume.read_grids):
            for suffix in (".toml", ".glb", ".vxl", ".brv", ".vdb", ".nvdb", ".txt"):
                if (call is brume.read_grids) == (suffix in (".brv", ".vdb", ".nvdb")):
                    self.refuse(call, "/nowhere/file" + suffix, kinds=FileNotFoundError)
        self.refuse(brume.render, "/nowhere/file.toml", size=(8, 8), kinds=FileNotFoundError)
        self.refuse(brume.convert, "/nowhere/file.vdb", "/tmp/out.brv", kinds=FileNotFoundError)

    def test_paths(self):
        for call in (brume.load, brume.Level.load, brume.read_grids):
            for bad in (None, 5, "", "a\0b", "/", object(), "file.unknown", os.devnull):
                self.refuse(call, bad, kinds=(ValueError, TypeError, OSError))
            with work_folder() as folder:
                self.refuse(call, folder, kinds=(ValueError, OSError))
        with work_folder() as folder:
            for suffix in (".brv", ".vdb", ".glb", ".toml", ".vxl", ".nvdb"):
                path = folder + "/damaged" + suffix
                with open(path, "wb") as file:
                    file.write(os.urandom(1000))
                for call in (brume.load, brume.Level.load, brume.read_grids):
                    self.refuse(call, path)

    def test_places_to_write(self):
        grid = brume.Grid(np.ones((2, 2, 2), np.float32))
        for path in ("/nowhere/a.brv", "/nowhere/a.vdb", "/proc/a.brv"):
            self.refuse(brume.write_grids, path, grid, kinds=OSError)
        self.refuse(two_rooms().save, "/nowhere/a.vxl", kinds=FileNotFoundError)
        with work_folder() as folder:
            two_rooms().save(folder + "/A.VXL")
            self.assertEqual(brume.Level.load(folder + "/A.VXL").size, two_rooms().size)
        with work_folder() as folder:
            os.mkdir(folder + "/a.brv")
            self.refuse(brume.write_grids, folder + "/a.brv", grid, kinds=IsADirectoryError)
            self.refuse(brume.write_grids, folder + "/a.txt", grid)

    def test_conversions_never_replace_their_input(self):
        with work_folder() as folder:
            path = Path(folder)
            brume.write_grids(path / "a.brv", brume.Grid(np.ones((2, 2, 2), np.float32)))
            brume.convert(path / "a.brv", path / "b.json")
            shutil.copy(path / "b.json", path / "c.json")  # Of b.raw, too.
            os.link(path / "a.brv", path / "hard.brv")
            os.symlink("a.brv", path / "soft.brv")
            before = {file.name: file.read_bytes() for file in path.iterdir()}
            for source, target in (("a.brv", "a.brv"), ("a.brv", "hard.brv"), ("a.brv", "soft.brv"),
                                   ("soft.brv", "a.brv"), ("b.json", "b.json"), ("c.json", "b.json"),
                                   ("a.brv", "../" + path.name + "/a.brv")):
                with self.assertRaisesRegex(ValueError, "is the input"):
                    brume.convert(path / source, path / target)
            self.assertEqual({file.name: file.read_bytes() for file in path.iterdir()}, before)

    def test_messages_are_those_of_the_program(self):
        with work_folder() as folder:
            path = folder + "/bad.toml"
            with open(path, "w", encoding="utf-8") as file:
                file.write("version = 1\nscene = 5\n")
            with self.assertRaisesRegex(ValueError, r"bad\.toml:2:\d+: ") as caught:
                brume.load(path)
            self.assertNotIn("\n", str(caught.exception))

    def test_warnings(self):
        with work_folder() as folder:
            path = folder + "/scene.obj"
            with open(path, "w", encoding="utf-8") as file:
                file.write("mtllib missing.mtl\nv 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n")
            with self.assertWarnsRegex(UserWarning, "missing.mtl"):
                brume.Level.load(path)


class GridTest(Hostile):
    def write(self, **named):
        grid = brume.Grid(**{"values": np.ones((2, 2, 2), np.float32), **named})
        with work_folder() as folder:
            brume.write_grids(folder + "/a.brv", grid)

    def test_grids(self):
        for values in (np.ones(3), np.ones((2, 2, 2), np.uint8), np.ones((2, 2, 2), complex), np.ones((2, 2, 2, 2)),
                       np.ones((2, 2, 2, 3), np.int64), None, "abc", np.ones((2, 2, 2), object)):
            self.refuse(self.write, values=values)
        for low in ((1, 2), (0.5, 0, 0), (2**40, 0, 0), (NAN, 0, 0), "abc", None, (2**30, 0, 0)):
            self.refuse(self.write, low=low)
        for matrix in (np.eye(3), np.zeros((4, 4)), np.full((4, 4), NAN), "abc", None, np.eye(4)[::-1],
                       np.ones((4, 4))):
            self.refuse(self.write, matrix=matrix)
        for active in (np.ones((2, 2, 2)), np.ones((2, 2), bool), "abc"):
            self.refuse(self.write, active=active)
        for background in ("abc", (1, 2), None, object()):
            self.refuse(self.write, background=background)
        for metadata in ({"a": object()}, {5: "a"}, {"a": 2**70}, {"a": [1, 2]}, {"a": np.ones(4)}):
            self.refuse(self.write, metadata=metadata)
        self.refuse(self.write, grid_class="cloud")
        self.refuse(self.write, name=5)
        self.refuse(self.write, is_mask=True)
        for grids in (None, 5, [5], "abc"):
            self.refuse(brume.write_grids, "/tmp/a.brv", grids)
        grid = brume.Grid(np.ones((2, 2, 2), np.float32), matrix=np.eye(4))
        with work_folder() as folder:  # Two corners far apart: no array holds what lies between them.
            brume.write_grids(folder + "/a.brv", [grid])
            far = brume.Grid(grid.values, low=(2**20, 2**20, 2**20))
            brume.write_grids(folder + "/b.brv", [grid, far])
            self.assertEqual(len(brume.read_grids(folder + "/b.brv")), 2)


class RenderTest(Hostile):
    def test_arguments(self):
        scenario = brume.load(DEMO)
        for size in ((0, 10), (-1, 10), (10, 20000), (10,), (1, 2, 3), "ab", None, (NAN, 10), (1.5, 2), (2**70, 1)):
            self.refuse(brume.render, scenario, size=size)
            self.refuse(brume.render, DEMO, size=size)
        for march in ("third", "", None, 5):
            self.refuse(brume.render, scenario, march=march, size=(8, 8))
        self.refuse(brume.Renderer, None)
        self.refuse(brume.Renderer, brume.World(two_rooms()))
        self.refuse(brume.Renderer, scenario, device="no such device", kinds=RuntimeError)
        for aspect in (0, -1, NAN, INF):
            self.refuse(brume.load, DEMO, aspect=aspect)
        for number in (0, -1, NAN, INF, 1e9):
            self.refuse(brume.load, DEMO, voxel_size=number)
            self.refuse(brume.load, DEMO, scale=number)
        for time in (NAN, INF, -1, 3601):
            self.refuse(scenario.advance_to, time)

    def test_pictures(self):
        with work_folder() as folder:
            for bad in (np.zeros((4, 4), np.uint8), np.zeros((4, 4, 2), np.uint8), np.zeros((4, 4, 3)), "abc", None,
                        np.zeros((0, 4, 3), np.uint8), np.zeros((1, 20000, 3), np.uint8)):
                self.refuse(brume.save_png, folder + "/a.png", bad)
            self.assertEqual(os.listdir(folder), [])
            fine = np.zeros((4, 4, 3), np.uint8)
            self.refuse(brume.save_png, folder, fine)
            os.mkdir(folder + "/b.png")
            self.refuse(brume.save_png, folder + "/b.png", fine, kinds=IsADirectoryError)
            self.refuse(brume.save_png, folder + "/none/a.png", fine, kinds=FileNotFoundError)

    def test_draws(self):
        renderer = brume.Renderer(brume.load(SOURCE / "scenes/single.toml"), size=(8, 8))
        for time in (NAN, INF, -1, 3601, "now"):
            self.refuse(renderer.draw, time)
        a, b = (0, 1, 5), (0, 1, 0)
        for camera in ((a,), (a, a), (a, b, 0), (a, b, 180), (a, b, NAN), (a, b, "wide"), 5, "ab", (a, b, 60, 1),
                       ((1e9, 0, 0), b), ((NAN, 0, 0), b), (a, None)):
            self.refuse(renderer.draw, 1, camera=camera, kinds=(ValueError, TypeError, RuntimeError))
        for samples in (0, -1, 2**25, 1.5, "many"):
            self.refuse(renderer.draw, 1, samples=samples)
        self.assertEqual(renderer.draw(1).shape, (8, 8, 3))


if __name__ == "__main__":
    unittest.main()
