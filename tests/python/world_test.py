"""Levels and worlds: what holds for all of them."""

import threading
import unittest

import brume
import numpy as np
from places import DEMO, SOURCE, event_calls, lines_through, shoot_holes, smoky_world, two_rooms, work_folder


class LevelTest(unittest.TestCase):
    def test_array_comes_back(self):
        solid = np.random.default_rng(0).random((7, 17, 33)) < 0.3
        level = brume.Level.from_array(solid, 0.5, (1, 2, 3))
        np.testing.assert_array_equal(level.solid, solid)
        self.assertEqual(level.size, (7, 17, 33))
        self.assertEqual((level.voxel_size, level.origin), (0.5, (1, 2, 3)))

    def test_array_in_any_order(self):
        solid = np.random.default_rng(0).random((9, 8, 7)) < 0.3
        for same in (np.asfortranarray(solid), np.repeat(solid, 2, axis=0)[::2], solid[::-1, ::-1][::-1, ::-1]):
            np.testing.assert_array_equal(brume.Level.from_array(same).solid, solid)

    def test_triangle_touches_its_voxels(self):
        triangle = [[[0.1, 0.3, 0.1], [1.9, 0.3, 0.1], [0.1, 0.3, 1.9]]]
        level = brume.Level.from_triangles(triangle, 0.5, size=(4, 2, 4), origin=(0, 0, 0))
        x, _, z = np.indices((4, 2, 4))
        expected = (x + z < 4) & (np.indices((4, 2, 4))[1] == 0)
        np.testing.assert_array_equal(level.solid, expected)
        around = brume.Level.from_triangles(triangle, 0.5, margin=1)
        self.assertEqual(around.solid.sum(), expected.sum())
        self.assertEqual(around.size, (6, 3, 6))

    def test_roles(self):
        def pane(z):
            return [[[-2, -2, z], [2, -2, z], [2, 2, z]], [[-2, -2, z], [2, 2, z], [-2, 2, z]]]

        place = {"size": (8, 8, 16), "origin": (-2, -2, -4)}
        triangles = pane(-2.25) + pane(-0.25) + pane(0.75) + pane(1.75)
        level = brume.Level.from_triangles(triangles, 0.5, roles=[1, 1, 2, 2, 3, 3, 0, 0], **place)
        expected = np.full((8, 8, 16), 3, np.uint8)
        expected[:, :, 3], expected[:, :, 7], expected[:, :, 11] = 1, 2, 0
        np.testing.assert_array_equal(level.roles, expected)
        np.testing.assert_array_equal(level.solid, expected < 2)
        with work_folder() as folder:
            level.save(folder + "/panes.vxl")
            np.testing.assert_array_equal(brume.Level.load(folder + "/panes.vxl").roles, expected)
        walls = brume.Level.from_triangles(triangles, 0.5, **place)
        np.testing.assert_array_equal(walls.roles, np.where(walls.solid, 0, 3))
        eye, before, behind = (0.1, 0.1, -3.7), (0.1, 0.1, 1), (0.1, 0.1, 3)
        self.assertTrue(brume.World(level).visible(eye, before))
        self.assertFalse(brume.World(level).visible(eye, behind))
        self.assertFalse(brume.World(walls).visible(eye, before))
        for bad in ([0], [0] * 9, [4] * 8, [0.5] * 8, [-1] * 8, [[0] * 8], [float("nan")] * 8):
            with self.assertRaises(ValueError):
                brume.Level.from_triangles(triangles, 0.5, roles=bad, **place)

    def test_level_of_a_scene_and_of_its_voxels_is_the_same(self):
        level = brume.Level.load(SOURCE / "scenes" / "demo.glb", 0.5)
        with work_folder() as folder:
            level.save(folder + "/demo.vxl")
            with self.assertRaises(ValueError):
                level.save(folder + "/demo.toml")
            again = brume.Level.load(folder + "/demo.vxl")
        np.testing.assert_array_equal(again.solid, level.solid)
        self.assertEqual(again.origin, level.origin)
        self.assertGreater(level.solid.sum(), 1000)
        depths = []
        for one in (level, again):
            world = brume.World(one)
            world.throw_smoke((-2.6, 1, -3), (-2.6, 1, -3))
            world.advance_to(2)
            depths.append(world.optical_depth(*lines_through(world, 500)))
        np.testing.assert_array_equal(*depths)


class EventTest(unittest.TestCase):
    EVENTS = [
        lambda w: w.throw_smoke((1, 2, 1), (5, 0, 5), time=0.25),
        lambda w: w.throw_smoke((1, 2, 1), (12, 0, 5), tick=40, voxels=600, bloom=0.5),
        lambda w: w.set_solid((9.9, 0, 3.9), (10.6, 2.6, 6.1), tick=90),
        lambda w: w.move_body(3, (2, 0, 2), tick=95),
        lambda w: w.shoot((1, 1, 5), (15, 1, 5), time=1.6, roll=30, shape="box"),
        lambda w: w.blast((4, 1, 4), tick=120, radius=3),
        lambda w: w.set_solid((9.9, 0, 3.9), (10.6, 2.6, 6.1), False, tick=130),
    ] + [lambda w, call=call, tick=tick: call(w, tick=tick) for tick, call in enumerate(event_calls(), 140)]

    def test_late_events_change_the_past(self):
        straight = brume.World(two_rooms())
        for event in self.EVENTS:
            event(straight)
        straight.advance_to(tick=200)
        late = brume.World(two_rooms())
        late.advance_to(tick=150)
        for event in reversed(self.EVENTS):
            event(late)
        late.advance_to(tick=30)
        late.advance_to(tick=200)
        self.assertEqual(late.state_hash, straight.state_hash)
        lines = lines_through(straight, 2000)
        np.testing.assert_array_equal(late.optical_depth(*lines), straight.optical_depth(*lines))
        np.testing.assert_array_equal(late.solid, straight.solid)
        empty = brume.World(two_rooms())
        empty.advance_to(tick=200)
        self.assertNotEqual(empty.state_hash, straight.state_hash)

    def test_late_doors_change_the_surfaces(self):
        """Among the surfaces of triangles, whose planes end the smoke."""
        level = brume.Level.load(SOURCE / "scenes" / "demo.glb", 0.25)
        straight, late, restored = brume.World(level), brume.World(level), brume.World(level)
        inside, box = (-2.6, 0.5, -3), ((-4, 0, -6), (-3, 2, -1))
        for world in (straight, late):
            world.throw_smoke(inside, inside, voxels=4000)
        straight.set_solid(*box, time=0.5)
        straight.set_solid((-3.5, 0.5, -5), (-3, 3, 0), False, time=1.2)
        straight.advance_to(2)
        late.advance_to(2)
        late.optical_depth(*lines_through(straight, 10))
        late.set_solid((-3.5, 0.5, -5), (-3, 3, 0), False, time=1.2)
        late.optical_depth(*lines_through(straight, 10))
        late.set_solid(*box, time=0.5)
        restored.restore(straight.save())
        lines = lines_through(straight, 3000)
        depths = straight.optical_depth(*lines)
        np.testing.assert_array_equal(late.optical_depth(*lines), depths)
        np.testing.assert_array_equal(restored.optical_depth(*lines), depths)
        self.assertEqual((late.state_hash, restored.state_hash), (straight.state_hash,) * 2)
        late.advance_to(0.25)
        late.optical_depth(*lines)
        late.advance_to(2)
        np.testing.assert_array_equal(late.optical_depth(*lines), depths)

    def test_time_is_the_tick_at_or_before(self):
        for time, tick in ((0, 0), (0.999, 63), (1, 64), (1.01, 64)):
            world = brume.World(two_rooms())
            world.advance_to(time)
            self.assertEqual(world.tick, tick)
        self.assertEqual(world.time, 1)
        slow = brume.World(two_rooms(), ticks_per_second=10)
        slow.advance_to(1.55)
        self.assertEqual((slow.tick, slow.ticks_per_second), (15, 10))
        slow.step()
        slow.step(3)
        self.assertEqual(slow.tick, 19)

    def test_grenade_flies_and_smoke_ends(self):
        world = brume.World(two_rooms())
        world.throw_smoke((1, 2, 1), (8, 0.2, 8), bloom=0.5, hold=1, dissolve=0.5)
        self.assertEqual((world.flights, world.clouds), (1, 0))
        world.advance_to(1)
        self.assertEqual((world.flights, world.clouds), (0, 1))
        world.advance_to(4)
        self.assertEqual((world.flights, world.clouds), (0, 0))

    def test_door_stops_the_smoke(self):
        world = brume.World(two_rooms())
        world.set_solid((10, 0, 4), (10.5, 2.5, 6))
        self.assertTrue(world.solid[20].all())
        self.assertFalse(world.level.solid[20].all())
        world.throw_smoke((5, 1, 5), (5, 1, 5), voxels=4000)
        world.advance_to(2)
        self.assertEqual(world.density().values[20:].max(), 0)
        self.assertEqual(world.density().values[:20].max(), 1)
        self.assertEqual(world.optical_depth((11, 1, 5), (19, 1, 5)), 0)
        world.set_solid((10, 0, 4), (10.5, 2.5, 6), False)
        world.advance_to(6)
        self.assertGreater(world.density().values[21:].max(), 0)

    def test_mask_cuts_its_shape(self):
        image = np.zeros((32, 32), np.uint8)
        image[:, :16] = 255
        world = brume.World(two_rooms(), masks=[image])
        world.throw_smoke((5, 2.5, 5), (5, 2.5, 5))
        world.advance_to(1.5)
        world.shoot((1, 2.5, 5), (9, 2.5, 5), mask=0, radius=1)
        world.step(30)
        sides = world.optical_depth([[2, 2.5, 4.5], [2, 2.5, 5.5]], [[8, 2.5, 4.5], [8, 2.5, 5.5]])
        self.assertEqual(sides.min(), 0)
        self.assertGreater(sides.max(), 5)
        with self.assertRaises(ValueError):
            world.shoot((1, 2.5, 5), (9, 2.5, 5), mask=1)


class StateTest(unittest.TestCase):
    def test_saved_state_goes_on_the_same(self):
        world = smoky_world(1.0)
        world.set_solid((10, 0, 4), (10.5, 2.5, 6))
        shoot_holes(world, 3)
        other = brume.World(two_rooms())
        other.restore(world.save())
        with self.assertRaises(ValueError):
            other.shoot((1, 1, 5), (9, 1, 5), tick=other.tick)  # A restored tick is complete.
        next_tick = world.tick + 1
        world.shoot((1, 1, 5), (9, 1, 5), tick=next_tick)
        other.shoot((1, 1, 5), (9, 1, 5))
        for one in (world, other):
            one.step(10)
        self.assertEqual(other.state_hash, world.state_hash)
        lines = lines_through(world, 500)
        np.testing.assert_array_equal(other.optical_depth(*lines), world.optical_depth(*lines))
        with self.assertRaises(ValueError):
            other.advance_to(tick=3)
        self.assertEqual(other.earliest_tick, world.tick - 10)

    def test_receiver_follows_the_sender(self):
        world, sender, receiver = smoky_world(0.5), brume.Sender(), brume.Receiver()
        self.assertIsNone(receiver.state_hash)
        for i in range(20):
            world.step()
            packet = sender.push(world)
            if i not in (5, 6):  # lost
                receiver.receive(packet)
            if receiver.behind:
                self.assertEqual(receiver.receive(sender.answer(receiver.request())), "applied")
        self.assertEqual((receiver.tick, receiver.state_hash), (world.tick, world.state_hash))
        self.assertEqual(sender.answer(receiver.request()), b"")
        other = brume.World(two_rooms())
        receiver.restore(other)
        self.assertEqual(other.state_hash, world.state_hash)

    def test_receiver_holds_early_packets(self):
        world, sender, receiver = smoky_world(0.5), brume.Sender(), brume.Receiver(hold_ticks=1)
        packets = []
        for _ in range(3):
            world.step()
            packets.append(sender.push(world))
        self.assertEqual([receiver.receive(packets[i]) for i in (0, 2, 2, 1)], ["applied", "held", "old", "applied"])
        self.assertEqual((receiver.state_hash, receiver.behind), (world.state_hash, False))
        with self.assertRaises(ValueError):
            brume.Receiver(hold_ticks=65)

    def test_another_level_is_refused(self):
        level, world = two_rooms(), smoky_world(0.5)
        self.assertEqual(level.hash, two_rooms().hash)
        solid = level.solid
        solid[0, 0, 0] = not solid[0, 0, 0]
        other = brume.Level.from_array(solid, level.voxel_size, level.origin)
        self.assertNotEqual(other.hash, level.hash)
        self.assertNotEqual(brume.World(other).state_hash, brume.World(level).state_hash)
        with self.assertRaisesRegex(ValueError, "another level"):
            brume.World(other).restore(world.save())
        packet = brume.Sender().push(world)
        with self.assertRaisesRegex(ValueError, "another level"):
            brume.Receiver(level=other).receive(packet)
        self.assertEqual(brume.Receiver(level=two_rooms()).receive(packet), "applied")

    def test_dropped_history_is_gone(self):
        world, other = smoky_world(), smoky_world()
        for one in (world, other):
            for _ in range(40):
                one.shoot((1, 1, 5), (9, 1, 5))
                one.step(20)
        world.forget_before(tick=world.tick)
        self.assertGreater(world.earliest_tick, 0)
        with self.assertRaises(ValueError):
            world.throw_smoke((5, 1, 5), (5, 1, 5), tick=0)
        with self.assertRaises(ValueError):
            world.advance_to(0)
        self.assertEqual(world.state_hash, other.state_hash)
        for one in (world, other):
            one.blast((5, 1, 5))
            one.step(5)
        self.assertEqual(world.state_hash, other.state_hash)

    def test_scenario_moves_both_ways(self):
        scenario = brume.load(DEMO)
        scenario.advance_to(2)
        there = scenario.state_hash
        scenario.advance_to(3)
        self.assertNotEqual(scenario.state_hash, there)
        scenario.advance_to(2)
        self.assertEqual(scenario.state_hash, there)
        self.assertEqual(scenario.duration, 6)

    def test_threads_share_a_world(self):
        world = smoky_world()
        lines = lines_through(world, 3000)
        errors = []

        def query():
            for _ in range(20):
                try:
                    world.optical_depth(*lines)
                    world.density()
                except RuntimeError:  # It moved during the query.
                    pass
                except Exception as error:  # pylint: disable=broad-except
                    errors.append(error)

        threads = [threading.Thread(target=query) for _ in range(2)]
        for thread in threads:
            thread.start()
        while any(thread.is_alive() for thread in threads):
            world.step()
        for thread in threads:
            thread.join()
        self.assertEqual(errors, [])


if __name__ == "__main__":
    unittest.main()
