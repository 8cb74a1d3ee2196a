"""Pictures and timelines are those of the program."""

import re
import unittest
from pathlib import Path

import brume
import numpy as np
from pictures import read_exr, read_png
from places import DEMO, SOURCE, run_brume, work_folder


class RenderTest(unittest.TestCase):
    def test_picture_is_that_of_the_program(self):
        with work_folder() as folder:
            png = folder + "/demo.png"
            run_brume("render", DEMO, "-o", png, "--time", 2.5, "--size", "160x90")
            expected = read_png(png)
        picture = brume.render(DEMO, 2.5, size=(160, 90))
        self.assertEqual((picture.shape, picture.dtype), ((90, 160, 3), np.uint8))
        np.testing.assert_array_equal(picture, expected)
        self.assertGreater(picture.std(), 5)

    def test_radiance_is_that_of_the_program(self):
        with work_folder() as folder:
            exr = folder + "/demo.exr"
            run_brume("render", DEMO, "-o", exr, "--time", 2.5, "--size", "80x45", "--background", "in")
            channels = read_exr(exr)
        picture = brume.render(str(DEMO), 2.5, size=(80, 45), linear=True)
        self.assertEqual((picture.shape, picture.dtype), ((45, 80, 3), np.float32))
        np.testing.assert_array_equal(picture, np.dstack([channels[name] for name in "RGB"]))

    def test_options_are_those_of_the_program(self):
        """A scene without a timeline, whose exposure is measured; another camera; reduced resolution; samples."""
        scene = SOURCE / "scenes" / "demo.glb"
        with work_folder() as folder:
            png = folder + "/room.png"
            run_brume("render", scene, "-o", png, "--size", "64x64", "--camera", "0,1.7,8 0,1.5,0 50", "--march",
                      "half", "--samples", 2, "--time", 1)
            expected = read_png(png)
        picture = brume.render(scene, 1, size=(64, 64), camera=((0, 1.7, 8), (0, 1.5, 0), 50), march="half", samples=2)
        np.testing.assert_array_equal(picture, expected)

    def test_volume_is_that_of_the_program(self):
        distance = np.sqrt(((np.indices((24, 24, 24)) - 11.5) ** 2).sum(axis=0))
        ball = brume.Grid(np.clip(10 - distance, 0, 1).astype(np.float32), matrix=np.diag([0.1, 0.1, 0.1, 1]))
        with work_folder() as folder:
            brume.write_grids(folder + "/ball.brv", ball)
            run_brume("render", folder + "/ball.brv", "-o", folder + "/ball.png", "--size", "48x32")
            picture = brume.render(folder + "/ball.brv", size=(48, 32))
            np.testing.assert_array_equal(picture, read_png(folder + "/ball.png"))
        self.assertGreater(picture[16, 24].min(), 60)

    def test_renderer_draws_any_time(self):
        scenario = brume.load(DEMO)
        renderer = brume.Renderer(scenario, size=(64, 36), march="quarter")
        first = renderer.draw(2.5)
        other = renderer.draw(3.5, camera=((-5, 1.5, 9), (0, 1.5, 0)))
        self.assertTrue((first != other).any())
        np.testing.assert_array_equal(renderer.draw(2.5), first)
        self.assertTrue(renderer.device)
        scenario.advance_to(1)  # Independent of what it draws.
        np.testing.assert_array_equal(renderer.draw(2.5), first)
        del scenario
        np.testing.assert_array_equal(renderer.draw(2.5), first)


class PictureFileTest(unittest.TestCase):
    def test_picture_comes_back(self):
        picture = np.random.default_rng(0).integers(0, 256, (7, 5, 3), dtype=np.uint8)
        with work_folder() as folder:
            brume.save_png(folder + "/a.png", picture[::-1])
            np.testing.assert_array_equal(read_png(folder + "/a.png"), picture[::-1])
            with self.assertRaises(ValueError):
                brume.save_png(folder + "/a.toml", picture)


class ScenarioTest(unittest.TestCase):
    def test_hashes_are_those_of_the_program(self):
        lines = run_brume("sim", DEMO, "--hash", "--ticks", 300).splitlines()
        scenario = brume.load(DEMO)
        for tick in (0, 64, 160, 224, 299):
            scenario.advance_to(tick / 64)
            self.assertEqual(lines[tick], f"{tick} {scenario.state_hash:016x}")

    def test_sight_is_that_of_the_program(self):
        eye, head = (-5.2, 1.35, 10.8), (-1.75, 1.65, -3)
        text = run_brume("query", DEMO, "--from", ",".join(map(str, eye)), "--to", ",".join(map(str, head)), "--time",
                         3.2)
        scenario = brume.load(DEMO)
        scenario.advance_to(3.2)
        depth = float(re.search(r"optical depth +([0-9.]+)", text).group(1))
        self.assertAlmostEqual(scenario.optical_depth(eye, head), depth, delta=0.0005)
        self.assertEqual(scenario.visible(eye, head), "visible         yes" in text)

    def test_drawn_sight_is_that_of_the_program(self):
        eye, head = (-5.2, 1.35, 10.8), (-1.75, 1.65, -3)
        text = run_brume("query", DEMO, "--from", ",".join(map(str, eye)), "--to", ",".join(map(str, head)), "--time",
                         3.2, "--drawn")
        scenario = brume.load(DEMO)
        scenario.advance_to(3.2)
        depth = float(re.search(r"optical depth +([0-9.]+)", text).group(1))
        self.assertAlmostEqual(scenario.optical_depth(eye, head, drawn=True), depth, delta=0.0005)
        self.assertNotAlmostEqual(scenario.optical_depth(eye, head), depth, delta=0.0005)

    def test_level_and_density(self):
        scenario = brume.load(DEMO)
        scenario.advance_to(2)
        self.assertEqual(scenario.level.size, (114, 38, 114))
        self.assertEqual(scenario.density().values.shape, (114, 38, 114))
        self.assertGreater(scenario.density().values.max(), 0.5)
        self.assertEqual(scenario.solid.shape, (114, 38, 114))
        level = brume.load(DEMO, voxel_size=0.5).level
        self.assertEqual(level.voxel_size, 0.5)

    def test_doors_open(self):
        with work_folder() as folder:
            path = folder + "/edit.toml"
            text = DEMO.read_text().replace('"demo.glb"', f'"{SOURCE}/scenes/demo.glb"')
            text += '\n[[event]]\ntype = "edit"\ntime = 1.0\nlow = [-3, 0, -4]\nhigh = [-2, 1, -3]\nsolid = true\n'
            Path(path).write_text(text)
            scenario = brume.load(path)
        before = scenario.solid
        scenario.advance_to(1.5)
        self.assertGreater(scenario.solid.sum(), before.sum())
        scenario.advance_to(0)
        np.testing.assert_array_equal(scenario.solid, before)


if __name__ == "__main__":
    unittest.main()
