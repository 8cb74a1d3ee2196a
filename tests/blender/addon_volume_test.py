"""Volume objects in timelines: where they are, their files, their sequences."""

import json
import os
import subprocess

import addon_case
import bpy
import level_parts
import numpy as np
from addon_case import box
from volume_case import BRUME, VolumeCase, write_ball


class Place(VolumeCase):
    def world_from_file(self, table):
        matrix = np.identity(4)
        for column, key in enumerate(("x_axis", "y_axis", "z_axis", "position")):
            matrix[:3, column] = table[key]
        return matrix

    def assertPlaced(self, table, matrix, metres=1.0):
        expected = np.identity(4)
        expected[:3] = metres * BRUME @ np.array(matrix)[:3]
        self.assertNear(self.world_from_file(table), expected)

    def test_scaled_rotated_and_moved(self):
        cloud = self.volume()
        cloud.location, cloud.rotation_euler, cloud.scale = (1, 2, 3), (0.3, -0.7, 1.9), (0.5, 2, -1.5)
        bpy.context.view_layer.update()
        self.assertPlaced(self.table(), cloud.matrix_world)

    def test_sheared_by_a_parent_in_centimetres(self):
        self.scene.unit_settings.scale_length = 0.01
        parent = level_parts.add("parent", None, rotation=(0.4, 0, 0.2), scale=(1, 3, 1))
        cloud = self.volume()
        cloud.parent, cloud.rotation_euler, cloud.location = parent, (0, 0.6, 0.5), (20, 30, 40)
        bpy.context.view_layer.update()
        self.assertPlaced(self.table(), cloud.matrix_world, 0.01)

    def test_instances_of_a_collection(self):
        library = bpy.data.collections.new("library")
        self.volume(collection=library).location = (0, 0, 1)
        for x in (-2, 3):
            empty = level_parts.add("copy", None, location=(x, 0, 0), scale=(2, 2, 2))
            empty.instance_type, empty.instance_collection = "COLLECTION", library
        positions = sorted(table["position"] for table in self.tables())
        self.assertNear(positions, [(-2, 2, 0), (3, 2, 0)])

    def test_a_scaled_to_nothing_one_is_not_exported(self):
        self.volume().scale = (1, 0, 1)
        self.assertSkipped("scaled to nothing")

    def test_what_blender_does_not_render_is_not_exported(self):
        self.volume(name="hidden").hide_render = True
        self.volume(name="role").brume.role = "LEFT_OUT"
        self.volume(name="by_h").hide_set(True)
        shown = self.volume(name="by_screen")
        shown.hide_viewport, shown.location = True, (7, 0, 0)
        self.assertNear(sorted(table["position"][0] for table in self.tables()), [0, 7])

    def test_one_that_moves_gives_a_warning(self):
        cloud = self.volume()
        for frame, x in ((1, 0.0), (20, 5.0)):
            cloud.location.x = x
            cloud.keyframe_insert("location", frame=frame)
        self.scene.frame_set(20)
        self.assertNear(self.table()["position"], (5, 0, 0))
        self.assertSaid('the volume "cloud": it moves', "WARNING")

    def test_a_scene_of_volumes_alone(self):
        bpy.data.objects.remove(self.floor)
        self.volume()
        for name in ("level.glb", "level.txt"):
            self.assertEqual(len(self.export(name)["volume"]), 1)
            self.assertLoads()


class File(VolumeCase):
    def test_inside_of_the_folder_by_a_relative_path(self):
        self.volume()
        self.assertEqual(self.table()["file"], "files/ball.vdb")
        self.assertEqual(len(self.said("WARNING")), 1, "the camera alone")

    def test_elsewhere_by_its_whole_path(self):
        self.volume(write_ball(os.path.join(self.folder, "..", "elsewhere.vdb")))
        found = self.table()["file"]
        self.assertTrue(os.path.isabs(found))
        self.assertTrue(os.path.samefile(found, os.path.join(self.folder, "..", "elsewhere.vdb")))

    def test_relative_to_the_blend_file(self):
        bpy.ops.wm.save_as_mainfile(filepath=os.path.join(self.folder, "files", "scene.blend"))
        self.volume("//ball.vdb")
        self.assertEqual(self.table()["file"], "files/ball.vdb")

    def test_packed(self):
        cloud = self.volume()
        bpy.ops.file.pack_all()
        self.assertTrue(cloud.data.packed_file)
        os.remove(self.ball)
        self.assertEqual(self.table()["file"], "Volumes/cloud.vdb")
        self.assertLoads()

    def test_with_modifiers(self):
        """A file of what they make: here the inside of a box of a mesh."""
        source = box("source", (-1, -1, -1), (1, 1, 1))
        source.hide_render = True
        modifier = self.volume("").modifiers.new("from mesh", "MESH_TO_VOLUME")
        modifier.object, modifier.resolution_mode, modifier.voxel_size = source, "VOXEL_SIZE", 0.1
        self.assertEqual(self.table()["file"], "Volumes/cloud.vdb")
        info = [addon_case.BRUME, "info", "Volumes/cloud.vdb", "--json", "-"]
        out = subprocess.run(info, cwd=self.folder, check=True, capture_output=True)
        self.assertEqual([grid["name"] for grid in json.loads(out.stdout)["grids"]], ["density"])

    def test_what_cannot_be_read_is_a_warning_and_no_failure(self):
        cloud = self.volume(os.path.join(self.folder, "none.vdb"))
        self.assertSkipped("none.vdb does not exist; choose another file")
        cloud.data.filepath = ""
        self.assertSkipped("names no file")
        cloud.data.filepath = os.path.join(self.folder, "bad.vdb")
        with open(cloud.data.filepath, "w", encoding="ascii") as file:
            file.write("not a volume")
        self.assertSkipped("bad.vdb cannot be read")
        cloud.data.filepath = write_ball(os.path.join(self.folder, "files", "ball%d.vdb"))
        self.assertSkipped('has a "%d"')
        cloud.data.filepath = write_ball(os.path.join(self.folder, "files", "other.vdb"), grid="fog")
        self.assertSkipped('has no grid "density"')

    def test_more_than_brume_shows(self):
        for _ in range(34):
            self.volume()
        self.assertEqual(len(self.tables()), 32)
        self.assertSaid("Brume shows 32 volumes", "WARNING")


class Sequence(VolumeCase):
    def test_frames_and_rate(self):
        self.scene.frame_start, self.scene.render.fps, self.scene.render.fps_base = 3, 24, 1.001
        self.sequence()
        table = self.table()
        self.assertEqual((table["file"], table["first"], table["last"]), ("files/smoke_%03d.vdb", 5, 7))
        self.assertNear(table["frame_rate"], 24 / 1.001)
        self.assertNear(table["start"], 7 * 1.001 / 24, 1e-5)

    def test_what_is_before_and_after(self):
        cloud = self.sequence()
        for mode, key in (("CLIP", "clip"), ("EXTEND", None), ("REPEAT", "loop"), ("PING_PONG", "ping_pong")):
            cloud.data.sequence_mode = mode
            table = self.table()
            self.assertEqual([name for name in ("clip", "loop", "ping_pong") if table.get(name)], [key] if key else [])

    def test_an_event_before_the_first_frame_shifts_the_start(self):
        self.sequence()
        self.event("BLAST", frame=-13)
        self.assertNear(self.table()["start"], 23 / 24, 1e-5)

    def test_without_any_file_in_range(self):
        cloud = self.sequence(frame_offset=20)
        self.assertSkipped("smoke_021.vdb to smoke_023.vdb exists")
        cloud.data.frame_duration = 0
        self.assertSkipped("its sequence has no frames")
