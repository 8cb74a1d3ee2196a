"""Events: frames and markers, sizes and paths in the 3D view, checks, presets, import."""

import json
import os
import subprocess
import tomllib

import addon_case
import bpy
import level_parts
from addon_case import AddonCase, box
from brume_blender import checks, gizmos, markers, messages, presets
from mathutils import Vector


class Frames(AddonCase):
    def test_new_events_are_at_the_current_frame_and_named(self):
        self.scene.frame_set(30)
        for kind, name in (("SMOKE", "Brume smoke"), ("SHOT", "Brume shot"), ("WORD", "Brume word")):
            bpy.ops.brume.add_event(type=kind)
            self.assertEqual((bpy.context.object.name, bpy.context.object.brume_event.frame), (name, 30))

    def test_set_to_current_frame(self):
        event = self.event("BLAST", frame=5)
        bpy.context.view_layer.objects.active = event
        self.scene.frame_set(25)
        bpy.ops.brume.event_to_frame()
        self.assertEqual((event.brume_event.frame, event.brume_event.time), (25, 1))

    def test_events_stay_at_their_frames_when_the_first_frame_moves(self):
        event = self.event("BLAST", frame=49)
        self.assertEqual(self.export()["event"][0]["time"], 2)
        self.scene.frame_start = 25
        self.assertEqual(event.brume_event.frame, 49)
        self.assertEqual(self.export()["event"][0]["time"], 1)

    def test_second_0_is_the_earliest_event_if_it_is_before_the_first_frame(self):
        self.event("BLAST", frame=-23)
        self.event("BLAST", frame=25)
        self.assertEqual([event["time"] for event in self.export()["event"]], [0, 2])
        self.assertEqual(self.export()["duration"], round((250 + 1 + 23) / 24, 6))

    def test_seconds_of_older_files(self):
        event = self.event("NONE").brume_event
        for key in list(event.keys()):
            del event[key]
        event.type = "BLAST"
        self.assertEqual(event.time, 1)
        event["time"] = 2.5
        self.assertEqual(event.frame, 61)


class Markers(AddonCase):
    def frames(self):
        return {marker.name: marker.frame for marker in self.scene.timeline_markers}

    def test_markers_follow_events(self):
        self.scene.timeline_markers.new("mine", frame=3)
        event = self.event("WORD", frame=12, text="HI")
        markers.synchronize(self.scene)
        self.assertEqual(self.frames(), {"mine": 3, 'Brume: WORD "HI"': 12})
        event.brume_event.frame = 20
        bpy.context.view_layer.update()
        self.assertEqual(self.frames()['Brume: WORD "HI"'], 20)
        bpy.data.objects.remove(event)
        markers.synchronize(self.scene)
        self.assertEqual(self.frames(), {"mine": 3})

    def test_events_follow_their_markers(self):
        event = self.event("BLAST", frame=12)
        markers.synchronize(self.scene)
        self.scene.timeline_markers["Brume: BLAST"].frame = 36
        self.assertEqual(self.export()["event"][0]["time"], round(35 / 24, 6))
        self.assertEqual(event.brume_event.frame, 36)

    def test_markers_can_be_switched_off(self):
        self.event("BLAST")
        self.scene.brume.markers = False
        markers.synchronize(self.scene)
        self.assertEqual(self.frames(), {})


class Gizmos(AddonCase):
    """What the 3D view draws for an event."""

    def radius(self, thing):
        here = thing.matrix_world.translation
        return max((point - here).length for point in gizmos.lines(self.scene, thing))

    def test_balls_have_the_real_radius(self):
        smoke, blast = self.event("SMOKE"), self.event("BLAST", blast_radius=5)
        self.assertAlmostEqual(self.radius(smoke), self.scene.brume.smoke_radius, 4)
        self.assertAlmostEqual(self.radius(blast), 5, 4)
        self.scene.unit_settings.scale_length = 0.01
        self.assertAlmostEqual(self.radius(blast), 500, 2)
        self.assertEqual(gizmos.label(self.scene, blast), "BLAST: radius 5 m")

    def test_lines_lead_to_aims_throwers_and_doors(self):
        target = level_parts.add("target", None, location=(3, 0, 1))
        shot, smoke = self.event("SHOT", aim=target), self.event("SMOKE", thrown_from=target)
        door = self.event("DOOR", door=target)
        self.assertEqual(gizmos.lines(self.scene, shot)[:2], [Vector((0, 0, 1)), Vector((3, 0, 1))])
        self.assertIn(Vector((3, 0, 1)), gizmos.lines(self.scene, smoke))
        self.assertEqual(gizmos.lines(self.scene, door), [Vector((0, 0, 1)), Vector((3, 0, 1))])

    def test_sections_have_the_size_of_holes_and_words(self):
        along = Vector((1, 0, 0))
        target = level_parts.add("target", None, location=(3, 0, 1))
        shot = self.event("SHOT", aim=target, shape="BOX", radius=0.4)
        points = gizmos._section(shot.brume_event, Vector((0, 0, 0)), along, 1.0)
        self.assertAlmostEqual(max(point.z for point in points), 0.4, 6)
        word = self.event("WORD", aim=target, text="HI", size=0.7)
        points = gizmos._section(word.brume_event, Vector((0, 0, 0)), along, 1.0)
        self.assertAlmostEqual(max(point.z for point in points), 0.35, 6)
        self.assertAlmostEqual(max(point.y for point in points), 0.735, 6)

    def test_a_shot_ends_where_the_check_found_its_wall(self):
        box("crate", (3, -1, 0), (4, 1, 2))
        shot = self.event("SHOT", aim=level_parts.add("aim", None, location=(8, 0, 1)))
        bpy.ops.brume.check()
        self.assertLess((gizmos.lines(self.scene, shot)[1] - Vector((3, 0, 1))).length, 1e-4)
        shot.location.y += 1
        bpy.context.view_layer.update()
        self.assertEqual(gizmos.lines(self.scene, shot)[1], Vector((8, 0, 1)))


class Checks(AddonCase):
    def checked(self):
        """The warnings of events."""
        bpy.ops.brume.check()
        return [message.text for message in messages.last() if message.kind == "WARNING" and message.thing]

    def test_a_grenade_inside_a_thing(self):
        box("crate", (3, -1, 0), (5, 1, 2))
        self.event("SMOKE", (4, 0, 1))
        self.assertEqual(self.checked(), ['"SMOKE" is inside "crate": move it out'])

    def test_a_grenade_on_the_floor_is_not_inside_of_it(self):
        self.event("SMOKE", (0, 0, 0))
        self.assertEqual(self.checked(), [])

    def test_a_grenade_beside_a_surface_is_not_in_it(self):
        # Voxels of 25 cm: both surfaces of the floor are in the voxels around 0.
        box("wall", (2, -3, 0), (2.2, 3, 3))
        for place in ((0, 0, 0.1), (0, 0, 0.24), (1.9, 0, 1), (2.3, 0, 1), (1.95, 0, 0.05), (0, 0, -0.3)):
            event = self.event("SMOKE", place)
            self.assertEqual(self.checked(), [], place)
            bpy.data.objects.remove(event)

    def test_a_grenade_inside_the_floor(self):
        self.event("SMOKE", (0, 0, -0.1))
        self.assertEqual(self.checked(), ['"SMOKE" is inside "floor": move it out'])

    def test_a_grenade_between_sheets(self):
        for number in range(10):
            box(f"sheet{number}", (1, -3, 0.05 + number / 10), (3, 3, 0.06 + number / 10))
        self.event("SMOKE", (2, 0, 0.53))
        self.assertEqual(self.checked(), ['"SMOKE" lies in something solid: move it out'])

    def test_a_grenade_in_a_room_of_one_mesh(self):
        box("room", (-20, -20, -0.5), (20, 20, 8))
        self.event("SMOKE", (3, 0, 2))
        self.assertEqual(self.checked(), [])

    def test_brume_applies_the_same_test(self):
        box("crate", (3, -1, 0), (5, 1, 2))
        box("room", (-20, -20, -0.5), (20, 20, 8))
        for number in range(10):
            box(f"sheet{number}", (-3, -3, 0.05 + number / 10), (-1, 3, 0.06 + number / 10))
        places = [(0, 0, 0.1), (2.95, 0, 0.5), (4, 0, 1), (-2, 0, 0.53), (0, 0, -0.1), (8, 8, 4), (40, 0, 1)]
        places += [(0, 0, 900), (0, 0, 1900)]
        events = [self.event("SMOKE", place) for place in places]
        self.checked()
        found = {message.thing for message in messages.last() if message.kind == "WARNING"}
        self.export("same.glb")
        path = os.path.join(self.folder, "same.toml")
        out = subprocess.check_output([addon_case.BRUME, "info", path, "--json", "-"], stderr=subprocess.DEVNULL)
        smokes = json.loads(out)["smokes"]
        self.assertEqual(len(smokes), len(places))
        for event, smoke in zip(sorted(events, key=lambda event: event.name), smokes):
            self.assertEqual(event.name in found, smoke["fault"] != "none", (event.location, smoke))

    def test_a_grenade_outside_the_level(self):
        self.event("SMOKE", (0, 0, 500))
        self.assertEqual(self.checked(), [])
        self.event("SMOKE", (0, 0, 1500))
        self.assertEqual(self.checked(), ['"SMOKE.001" is 1500.0 m outside the level: no smoke there'])

    def test_a_throw_that_hits_a_wall(self):
        box("wall", (1, -3, 0), (1.2, 3, 3))
        self.event("SMOKE", (4, 0, 1), thrown_from=level_parts.add("hand", None, location=(-3, 0, 1)))
        self.assertEqual(self.checked(), ['"SMOKE" hits "wall" after 4.0 m and goes off there, not at its empty'])

    def test_a_shot_into_a_crate(self):
        box("crate", (3, -1, 0), (4, 1, 2))
        self.event("SMOKE", (1, 0, 1), frame=1)
        self.event("SHOT", (-3.1, 0, 1), frame=48, aim=level_parts.add("aim", None, location=(8, 0, 1)))
        self.assertEqual(self.checked(), [])
        self.assertSaid('"SHOT" hits "crate" at 6.1 m', "INFO")

    def test_a_shot_that_reaches_no_smoke(self):
        box("wall", (-2, -3, 0), (-1.8, 3, 3))
        self.scene.brume.smoke_radius = 1
        self.event("SMOKE", (4, 0, 1), frame=24)
        shot = self.event("SHOT", (-3, 0, 1), frame=48, aim=level_parts.add("aim", None, location=(8, 0, 1)))
        self.assertEqual(self.checked(), ['"SHOT" hits "wall" at 1.0 m, 4.5 m from the nearest smoke'])
        shot.brume_event.frame = 12
        self.assertEqual(self.checked(), ['"SHOT" hits "wall" at 1.0 m; no smoke is out at that time'])

    def test_hidden_and_passable_things_are_as_in_the_level(self):
        box("hidden_wall", (1, -3, 0), (1.2, 3, 3)).hide_set(True)
        box("bush", (-1, -3, 0), (-0.8, 3, 3)).brume.role = "PASSABLE"
        box("fence", (-0.6, -3, 0), (-0.4, 3, 3)).brume.role = "GRILLE"
        self.event("SMOKE", (-2, 0, 1))
        self.event("SHOT", (-3, 0, 1), frame=48, aim=level_parts.add("aim", None, location=(8, 0, 1)))
        self.checked()
        self.assertSaid('"SHOT" hits "hidden_wall" at 4.0 m', "INFO")

    def test_an_open_door_lets_shots_through(self):
        door = box("door", (1, -3, 0), (1.2, 3, 3))
        door.brume.role = "DOOR"
        self.event("SMOKE", (-2, 0, 1))
        self.event("DOOR", frame=30, door=door)
        aim = level_parts.add("aim", None, location=(8, 0, 1))
        early = self.event("SHOT", (-3, 0, 1), frame=24, aim=aim)
        late = self.event("SHOT", (-3, 0, 1), frame=48, aim=aim)
        self.checked()
        self.assertSaid(f'"{early.name}" hits "door" at 4.0 m')
        self.assertSaid(f'"{late.name}" leaves the level')

    def test_a_door_opens_before_a_shot_of_the_same_frame(self):
        door = box("door", (1, -3, 0), (1.2, 3, 3))
        door.brume.role = "DOOR"
        self.event("SMOKE", (-2, 0, 1))
        self.event("SHOT", (-3, 0, 1), frame=48, aim=level_parts.add("aim", None, location=(8, 0, 1))).name = "A"
        self.event("DOOR", frame=48, door=door)
        self.checked()
        self.assertSaid('"A" leaves the level')

    def test_a_blast_that_reaches_no_smoke(self):
        self.event("SMOKE", (-4, 0, 1), frame=1)
        self.scene.brume.smoke_radius = 1
        self.event("BLAST", (4, 0, 1), frame=48, blast_radius=2)
        self.assertEqual(self.checked(), ['"BLAST" is 5.0 m short of the nearest smoke'])

    def test_a_moving_thrower_counts_at_the_time_of_the_event(self):
        hand = level_parts.add("hand", None, location=(-3, 0, 1))
        hand.keyframe_insert("location", frame=1)
        hand.location = (-3, 0, 9)
        hand.keyframe_insert("location", frame=40)
        box("wall", (1, -3, 0), (1.2, 3, 3))
        self.event("SMOKE", (4, 0, 1), frame=1, thrown_from=hand)
        self.scene.frame_set(40)
        self.assertEqual(self.checked(), ['"SMOKE" hits "wall" after 4.0 m and goes off there, not at its empty'])
        self.assertEqual(self.scene.frame_current, 40)


class Messages(AddonCase):
    def test_a_mask_without_image(self):
        self.event("SHOT", shape="MASK")
        text = self.error_of(bpy.ops.brume.export_level, filepath=os.path.join(self.folder, "level.glb"))
        self.assertEqual(text, 'Error: the shape of "SHOT" is Mask, but it names no image; choose one')

    def test_every_message_of_an_event_is_at_its_event(self):
        self.event("SMOKE", (0, 0, 1500))
        bpy.ops.brume.check()
        about = {message.thing for message in messages.last() if message.text.startswith('"')}
        self.assertEqual(about, {"SMOKE"})


class Presets(AddonCase):
    def test_presets_are_within_the_ranges(self):
        for kind, found in presets.PRESETS.items():
            event = self.event(kind).brume_event
            for name, settings in found.items():
                presets.apply(self.scene, event, name)
                for setting, value in settings.items():
                    group = self.scene.brume if kind == "SMOKE" else event
                    stored = getattr(group, "smoke_radius" if kind == "SMOKE" and setting == "radius" else setting)
                    same = self.assertEqual if isinstance(value, str) else lambda a, b: self.assertAlmostEqual(a, b, 2)
                    same(stored, value)

    def test_the_operator_uses_the_event_that_is_active(self):
        bpy.context.view_layer.objects.active = self.event("SHOT")
        bpy.ops.brume.preset(name="Shotgun")
        self.assertAlmostEqual(bpy.context.object.brume_event.radius, 0.6, 6)


class ImportTimeline(AddonCase):
    def test_exported_events_come_back(self):
        self.scene.unit_settings.scale_length = 0.5
        hand = level_parts.add("hand", None, location=(-3, 0.5, 1))
        door = box("gate", (4, -1, 0), (4.2, 1, 2))
        door.brume.role = "DOOR"
        star = os.path.join(self.folder, "star.png")
        level_parts.save(level_parts.star_image(), star, "PNG")
        self.event("SMOKE", (1, 2, 0.3), 3, thrown_from=hand)
        self.event("SMOKE", (2, 2, 0.3), 5)
        self.event("SHOT", (-3, 1, 1), 30, aim=hand, shape="MASK", mask=star, roll=0.5, radius=0.4, stay=2)
        self.event("WORD", (-3, 2, 1), 31, text='a "b"', size=0.8, interval=0.1, spacing=0.25)
        self.event("BLAST", (1, 1, 1), 40, blast_radius=3, remaining=0.5, blast_flash=7)
        self.event("DOOR", (4, 0, 1), 45, door=door, open=False)
        self.scene.brume.smoke_voxels, self.scene.brume.voxel = 700, 0.5
        before = self.export("first.txt")
        for thing in [thing for thing in self.scene.objects if thing.type == "EMPTY"]:
            bpy.data.objects.remove(thing)
        self.scene.brume.smoke_voxels, self.scene.brume.voxel = 50, 0.1
        bpy.ops.brume.import_timeline(filepath=os.path.join(self.folder, "first.toml"))
        after = self.export("second.txt")
        for timeline in (before, after):
            for event in timeline["event"]:
                for key, value in event.items():
                    if isinstance(value, list):
                        event[key] = [round(part, 4) for part in value]
                    elif isinstance(value, float):
                        event[key] = round(value, 4)
        self.assertEqual(before["event"], after["event"])
        self.assertEqual((before["smoke"], before["grid"]), (after["smoke"], after["grid"]))

    def test_wrong_files_are_one_line_and_leave_nothing(self):
        path = os.path.join(self.folder, "wrong.toml")
        for text, said in (
            ("version = 1\n[[event]\n", "wrong.toml"),
            ("version = 2\n", "expected a timeline with version = 1"),
            ('version = 1\n[[event]]\ntype = "blast"\ntime = 1\n', "an event is incomplete or wrong: 'at'"),
        ):
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            self.assertIn(said, self.error_of(bpy.ops.brume.import_timeline, filepath=path))
            self.assertEqual((list(self.scene.objects), list(bpy.data.collections)), ([self.floor], []))
