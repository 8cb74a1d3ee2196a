"""Queries in arrays: their shapes, their agreement with each other, and their speed."""

import time
import unittest

import brume
import numpy as np
from places import lines_through, shoot_holes, smoky_world, two_rooms


class QueryTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.world = smoky_world()
        shoot_holes(cls.world, 8)
        cls.a, cls.b = lines_through(cls.world, 2000)

    def test_many_equal_one(self):
        depths = self.world.optical_depth(self.a, self.b)
        self.assertEqual((depths.shape, depths.dtype), ((2000,), np.float32))
        visible = self.world.visible(self.a, self.b, 1.5)
        self.assertEqual((visible.shape, visible.dtype), ((2000,), np.bool_))
        self.assertTrue(0 < visible.sum() < 2000)
        for i in range(0, 2000, 97):
            self.assertEqual(self.world.optical_depth(self.a[i], self.b[i]), depths[i])
            self.assertEqual(self.world.visible(tuple(self.a[i]), list(self.b[i]), 1.5), visible[i])
        self.assertIsInstance(self.world.optical_depth(self.a[0], self.b[0]), float)
        self.assertIsInstance(self.world.visible(self.a[0], self.b[0]), bool)

    def test_more_lines_than_a_chunk(self):
        count = 150_000
        a, b = np.resize(self.a, (count, 3)), np.resize(self.b, (count, 3))
        depths = self.world.optical_depth(self.a, self.b)
        np.testing.assert_array_equal(self.world.optical_depth(a, b), np.resize(depths, count))

    def test_shapes(self):
        depths = self.world.optical_depth(self.a, self.b)
        image = self.world.optical_depth(self.a.reshape(40, 50, 3), self.b.reshape(40, 50, 3))
        np.testing.assert_array_equal(image, depths.reshape(40, 50))
        from_one = self.world.optical_depth(self.a[0], self.b)
        np.testing.assert_array_equal(from_one, self.world.optical_depth(np.tile(self.a[0], (2000, 1)), self.b))
        np.testing.assert_array_equal(self.world.optical_depth(self.a, self.b[7]),
                                      self.world.optical_depth(self.a, np.tile(self.b[7], (2000, 1))))
        self.assertEqual(self.world.optical_depth(np.empty((0, 3)), np.empty((0, 3))).shape, (0,))
        self.assertEqual(self.world.visible(np.empty((4, 0, 3)), self.a[0]).shape, (4, 0))
        self.assertEqual(self.world.optical_depth(self.a[:1], self.b[:1]).shape, (1,))

    def test_any_array_of_numbers(self):
        a, b = np.round(self.a * 4) / 4, np.round(self.b)
        depths = self.world.optical_depth(a, b)
        for same in (a.astype(float), a.astype(np.float16), a.astype(">f4"), np.asfortranarray(a),
                     np.repeat(a, 2, axis=0)[::2], a.tolist()):
            np.testing.assert_array_equal(self.world.optical_depth(same, b), depths)
        np.testing.assert_array_equal(self.world.optical_depth(a, b.astype(np.int16)), depths)
        unaligned = np.frombuffer(b"?" + a.tobytes(), np.uint8)[1:].view("<f4").reshape(a.shape)
        np.testing.assert_array_equal(self.world.optical_depth(unaligned, b), depths)

    def test_inputs_stay(self):
        a, b = self.a.copy(), self.b.copy()
        a.flags.writeable = b.flags.writeable = False
        self.world.optical_depth(a, b)
        self.world.visible(a, b)
        np.testing.assert_array_equal(a, self.a)

    def test_depth_adds_up(self):
        middle = (self.a + self.b) / 2
        whole = self.world.optical_depth(self.a, self.b)
        parts = self.world.optical_depth(self.a, middle) + self.world.optical_depth(middle, self.b)
        # Quadrature along holes has an error of 0.3 %; the middle is rounded to float32.
        np.testing.assert_allclose(parts, whole, rtol=0.006, atol=1e-3)

    def test_air_is_clear(self):
        world = brume.World(two_rooms())
        self.assertEqual(world.density().values.max(), 0)
        self.assertEqual(world.optical_depth(self.a, self.b).max(), 0)
        self.assertEqual(self.world.optical_depth((100, 1, 1), (200, 1, 1)), 0)
        self.assertTrue(world.visible((1, 1, 1), (9, 1, 9)))
        self.assertFalse(world.visible((5, 1, 1), (15, 1, 1)), "a wall")

    def test_visible_is_clear_of_walls_and_smoke(self):
        a, b = lines_through(self.world, 1000, metres=3)
        walls_only = self.world.visible(a, b, np.inf)
        depths = self.world.optical_depth(a, b)
        np.testing.assert_array_equal(self.world.visible(a, b, 2), walls_only & (depths <= 2))

    def test_sensor_ends_at_walls(self):
        world = smoky_world()
        directions = [[1, 0, 0], [2, 0, 0], [-1, 0, 0]]
        distance, depth = world.sense((5, 1, 1), directions)
        np.testing.assert_allclose(distance, [5, 5, np.inf], rtol=1e-6)
        self.assertAlmostEqual(depth[0], world.optical_depth((5, 1, 1), (10, 1, 1)), delta=0.01)
        self.assertEqual(world.sense((5, 1, 1), (1, 0, 0), 4)[0], np.inf)


class DensityTest(unittest.TestCase):
    def test_steps_and_fractions_are_the_same(self):
        world = smoky_world(1.2)
        fractions, steps = world.density(), world.density(dtype=np.uint8)
        self.assertEqual((fractions.values.dtype, steps.values.dtype), (np.float32, np.uint8))
        np.testing.assert_array_equal(np.round(fractions.values * 255).astype(np.uint8), steps.values)
        self.assertEqual(fractions.values.shape, world.level.size)
        self.assertEqual(fractions.values[world.solid].max(), 0)

    def test_a_box_is_a_part(self):
        world = smoky_world()
        whole, part = world.density(), world.density((3, 0, 5), (14, 9, 17))
        np.testing.assert_array_equal(part.values, whole.values[3:14, 0:9, 5:17])
        np.testing.assert_allclose(part.origin, [1.5, 0, 2.5])
        np.testing.assert_allclose(part.voxel_size, 0.5)

    def test_smoke_fills_at_most_its_voxels(self):
        world = brume.World(brume.Level.from_array(np.zeros((40, 40, 40), bool), 0.5))
        world.throw_smoke((10, 10, 10), (10, 10, 10), voxels=1000)
        world.advance_to(3)
        filled = (world.density().values > 0).sum()  # Those at its rim round to 0.
        self.assertTrue(600 < filled <= 1000, filled)


class DrawnTest(unittest.TestCase):
    def test_noise_erodes_what_is_drawn(self):
        world = brume.World(brume.Level.from_array(np.zeros((64, 64, 64), bool), 0.5))
        world.throw_smoke((16, 16, 16), (16, 16, 16))
        world.advance_to(1.6)
        a, b = lines_through(world, 500)
        smooth, drawn = world.optical_depth(a, b), world.optical_depth(a, b, drawn=True)
        self.assertFalse(np.array_equal(smooth, drawn))
        # Erosion multiplies what is there: less at rims, more inside.
        self.assertTrue((drawn[smooth == 0] == 0).all())
        self.assertTrue((drawn < smooth).any() and (drawn > smooth).any())
        self.assertTrue(np.array_equal(world.visible(a, b, 1, drawn=True), drawn <= 1))
        self.assertEqual(world.optical_depth(a[3], b[3], drawn=True), drawn[3])
        world.advance_to(2)
        self.assertFalse(np.array_equal(world.optical_depth(a, b, drawn=True), drawn))


class SpeedTest(unittest.TestCase):
    # Half its speed tells a loop over lines in Python apart, which takes a hundred times as long, and leaves room for
    # what else the machine does, as that costs processor time, too. The figure itself is printed, not judged.
    def test_a_million_lines_cost_what_they_cost_in_cpp(self):
        world = brume.World(brume.Level.from_array(np.zeros((64, 64, 64), bool), 0.5))
        world.throw_smoke((16, 16, 16), (16, 16, 16))
        world.advance_to(1.6)
        shoot_holes(world, 32)
        a, b = lines_through(world, 1_000_000)
        self.assertEqual(world.holes, 32)
        cpp, python = [], []
        for _ in range(3):  # in turns: other programs disturb both
            cpp.append(world._time_optical_depth(a, b))
            start = time.process_time()
            world.optical_depth(a, b)
            python.append(time.process_time() - start)
        ratio = min(cpp) / min(python)
        print(f"1,000,000 lines of 10 m, 32 holes: {min(python):.3f} s of processor time, in C++ {min(cpp):.3f} s: "
              f"{100 * ratio:.1f} % of its speed")
        self.assertGreater(ratio, 0.5)


if __name__ == "__main__":
    unittest.main()
