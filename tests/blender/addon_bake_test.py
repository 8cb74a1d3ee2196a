"""Slice atlases of the selection: what fills them, their files, and what the user sees. With the program itself."""

import json
import os
import shlex

import addon_case
import bmesh
import bpy
import level_parts
import numpy as np
from addon_case import AddonCase, box

# [m]: of a point within 8 m of the origin after eight roundings to float32: of its coordinates in the mesh, of
# rotation, scale and position of the node, and of the products of the three.
_POINT = 8 * 8 * 2.0**-24


def volume_and_area(thing):
    """Of the evaluated mesh in the world, by Blender [units^3, units^2]."""
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    shape = bmesh.new()
    shape.from_mesh(evaluated.to_mesh())
    shape.transform(thing.matrix_world)
    result = abs(shape.calc_volume(signed=True)), sum(face.calc_area() for face in shape.faces)
    shape.free()
    evaluated.to_mesh_clear()
    return result


def torus(name="torus", **more):
    bpy.ops.mesh.primitive_torus_add(major_radius=1.1, minor_radius=0.35, major_segments=24, minor_segments=10)
    made = bpy.context.object
    made.name = made.data.name = name
    for key, value in more.items():
        setattr(made, key, value)
    return made


class BakeCase(AddonCase):
    def setUp(self):
        super().setUp()
        self.path = os.path.join(self.folder, "baked.exr")

    def select(self, *things):
        for other in self.scene.objects:
            other.select_set(other in things)
        bpy.context.view_layer.objects.active = things[0] if things else None
        bpy.context.view_layer.update()

    def described(self, path=None):
        with open(os.path.splitext(path or self.path)[0] + ".json", encoding="utf-8") as file:
            return json.load(file)

    def texels(self, path=None):
        """Rows from the top, RGBA."""
        image = bpy.data.images[os.path.basename(path or self.path)]
        return np.array(image.pixels[:]).reshape(image.size[1], image.size[0], 4)[::-1]

    def slices(self, **settings):
        """Bakes; returns the description and the sums of the channels [m^3]."""
        known = {"filepath": self.path, "depth": "EXR32", "tile": (20, 24), "tiles": 16}
        self.assertEqual(bpy.ops.brume.bake_slices(**(known | settings)), {"FINISHED"})
        described = self.described()
        extent = np.subtract(described["box"]["high"], described["box"]["low"])
        voxel = float(np.prod(extent / described["size"]))
        return described, self.texels().sum(axis=(0, 1)) * voxel

    def assertFills(self, found, *things, metres=1.0):
        """A point that is off by d changes a volume by at most d times the area."""
        volume, area = np.sum([volume_and_area(thing) for thing in things], axis=0)
        # Sums of float32: relative to the whole.
        slack = area * metres**2 * _POINT + volume * metres**3 * 1e-6
        self.assertLess(abs(found - volume * metres**3), slack, (found, volume, slack))

    def recorded(self):
        """A program that records its arguments and runs the real one."""
        program, log = os.path.join(self.folder, "record"), os.path.join(self.folder, "arguments")
        with open(program, "w", encoding="ascii") as script:
            words = "printf '%s\\n' \"$@\" >", shlex.quote(log) + ";", "exec", shlex.quote(addon_case.BRUME), '"$@"'
            script.write("#!/bin/sh\n" + " ".join(words) + "\n")
        os.chmod(program, 0o700)
        self.preferences.program = program

        def read(option):
            with open(log, encoding="utf-8") as file:
                lines = file.read().splitlines()
            return lines[lines.index(option) + 1] if option in lines else None

        return read


class Slices(BakeCase):
    def test_coverage_adds_up_to_the_volume(self):
        cube, ring = box("cube", (-1, -1, -1), (1, 1, 1), location=(3, 0, 0.2)), torus()
        self.select(cube, ring)
        described, sums = self.slices()
        self.assertFills(sums[0], cube, ring)
        self.assertEqual([channel["name"] for channel in described["channels"]], ["density"])
        self.assertEqual((described["tile"], described["tiles"]), ([20, 24], 16))

    def test_an_8_bit_image_is_as_near_as_its_steps(self):
        cube = box("cube", (-1, -1, -1), (1, 1, 1), rotation=(0.3, 0.5, 0.7))
        self.select(cube)
        self.path = os.path.join(self.folder, "baked.png")
        described, sums = self.slices(depth="PNG8")
        values = self.texels()[..., 0]
        self.assertEqual((values.min(), values.max()), (0, 1))
        extent = np.subtract(described["box"]["high"], described["box"]["low"])
        # Values are rounded to the nearest of 256, by at most half a step.
        slack = values.size * float(np.prod(extent / described["size"])) * 0.5 / 255
        self.assertLess(abs(sums[0] - 8), slack)

    def test_two_objects_fill_two_channels_in_the_order_of_their_names(self):
        ring, cube = torus("b ring"), box("a cube", (-1, -1, -1), (1, 1, 1), location=(0, 0, 2))
        self.select(ring, cube)
        described, sums = self.slices(channels="EACH")
        self.assertEqual([channel["name"] for channel in described["channels"]], ["a_cube", "b_ring"])
        self.assertFills(sums[0], cube)
        self.assertFills(sums[1], ring)

    def test_unapplied_transforms_and_units_count(self):
        self.scene.unit_settings.scale_length = 0.5
        parent = level_parts.add("parent", None, rotation=(0.2, 0.4, 0.6), scale=(1.5, 0.7, 1))
        ring = torus(scale=(1.4, -0.6, 2), rotation_euler=(0.5, 1, 0.3), location=(0.4, 0.2, -0.1))
        ring.parent = parent  # Sheared by it, and mirrored.
        self.select(ring)
        self.assertFills(self.slices()[1][0], ring, metres=0.5)

    def test_modifiers_are_applied_as_rendered(self):
        cube = box("cube", (-1, -1, -1), (1, 1, 1))
        rows = cube.modifiers.new("rows", "ARRAY")
        rows.count, rows.use_relative_offset, rows.use_constant_offset = 3, False, True
        rows.constant_offset_displace = (0, 2.5, 0)
        rows.show_viewport = False
        only_shown = cube.modifiers.new("shown", "ARRAY")
        only_shown.count, only_shown.show_render = 2, False
        self.select(cube)
        self.assertAlmostEqual(self.slices()[1][0], 3 * 8, delta=3 * 24 * _POINT + 24e-6)
        self.assertTrue(only_shown.show_viewport and not rows.show_viewport)

    def test_only_the_selection_counts_whatever_blender_renders(self):
        cube = box("cube", (-1, -1, -1), (1, 1, 1))
        cube.hide_render, cube.brume.role = True, "LEFT_OUT"
        grenade = box("Grenade", (2, 0, 0), (3, 1, 1))
        door = box("IGNORE_door", (4, 0, 0), (5, 1, 1))
        door.brume.role = "DOOR"
        self.select(grenade, cube, door)
        described, sums = self.slices(channels="EACH")
        self.assertEqual([channel["name"] for channel in described["channels"]], ["Grenade_2", "IGNORE_door", "cube"])
        for found, thing in zip(sums, (grenade, door, cube)):
            self.assertFills(found, thing)
        self.assertEqual(set(bpy.context.selected_objects), {grenade, cube, door})
        self.assertEqual(bpy.context.object, grenade)
        self.assertTrue(cube.hide_render)

    def test_instances_count_for_the_object_that_makes_them(self):
        pieces = bpy.data.collections.new("pieces")
        pieces.objects.link(box("piece", (0, 0, 0), (1, 1, 1)))
        self.scene.collection.objects.unlink(bpy.data.objects["piece"])
        placed = level_parts.add("placed", None, scale=(1, 2, 3))
        placed.instance_type, placed.instance_collection = "COLLECTION", pieces
        self.select(placed)
        described, sums = self.slices(channels="EACH")
        self.assertEqual([channel["name"] for channel in described["channels"]], ["placed"])
        self.assertAlmostEqual(sums[0], 6, delta=22 * _POINT + 6e-6)

    def test_a_mesh_in_edit_mode(self):
        ring = torus()
        self.select(ring)
        bpy.ops.object.mode_set(mode="EDIT")
        _, sums = self.slices()
        self.assertEqual(bpy.context.mode, "EDIT_MESH")
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertFills(sums[0], ring)

    def test_voxels_of_a_size_are_cubes(self):
        self.scene.unit_settings.scale_length = 0.5
        self.select(box("cube", (-1, -2, -1.5), (1, 2, 1.5), rotation=(0, 0, 0.4)))
        described, sums = self.slices(size_by="VOXEL", voxel=0.25)
        edges = np.subtract(described["box"]["high"], described["box"]["low"]) / described["size"]
        self.assertLess(np.abs(edges - 0.125).max(), 1e-8)  # Corners have nine digits.
        self.assertAlmostEqual(sums[0], 24 / 8, delta=52 / 4 * _POINT + 3e-6)
        self.assertIn("choose a larger voxel", self.error_of(self.slices, size_by="VOXEL", voxel=1e-4))

    def test_axes_of_engines(self):
        axes = {"NONE": "+x -y +z", "unreal": "+x +z +y", "unity": "-x -y +z", "godot": "+x +y +z"}
        self.select(torus())
        for preset, expected in (axes | {"houdini": "+x -y +z"}).items():
            described, _ = self.slices(preset=preset)
            self.assertEqual(described["axes"], expected)
            self.assertEqual((described["tile"], described["tiles"]), ([20, 24], 16), preset)
            self.assertEqual(os.path.exists(self.path + ".import"), preset == "godot")
            os.remove(self.path)
            if preset == "godot":
                os.remove(self.path + ".import")

    def test_blender_axes(self):
        """A small box to the right, at the back and high up of a large one."""
        large, small = box("large", (-2, -2, -2), (2, 2, 2)), box("small", (1, 1, 1), (2, 2, 2))
        self.select(large, small)
        described, _ = self.slices(channels="EACH", tile=(6, 6), tiles=6, layout_of_tiles="strip")
        found = self.texels()[..., 1]
        # The box has a voxel around; slices are seen from the front, the first one is the farthest.
        self.assertEqual(described["size"], [6, 6, 6])
        rows, columns = np.nonzero(found)
        self.assertEqual((set(rows), set(columns)), ({1}, {6 + 4}))

    def test_layout_and_padding(self):
        self.select(torus())
        described, _ = self.slices(layout_of_tiles="COLUMNS", columns=5, padding=2)
        self.assertEqual((described["columns"], described["padding"]), (5, 2))
        self.assertEqual(described["image_size"], [5 * 24, 4 * 28])


class Files(BakeCase):
    def test_the_image_is_loaded_as_numbers_once(self):
        self.select(torus())
        for tiles in (4, 8):
            self.slices(tiles=tiles, layout_of_tiles="strip")
        images = [image for image in bpy.data.images if image.name.startswith("baked")]
        self.assertEqual(len(images), 1)
        self.assertEqual(tuple(images[0].size), (8 * 20, 24))
        self.assertEqual(images[0].colorspace_settings.name, "Non-Color")
        self.assertEqual(os.path.realpath(bpy.path.abspath(images[0].filepath)), os.path.realpath(self.path))

    def test_files_are_written_beside_the_blend_file(self):
        self.select(torus("ring.1"))
        self.assertIn("save the .blend file first", self.error_of(bpy.ops.brume.bake_slices))
        bpy.ops.wm.save_as_mainfile(filepath=os.path.join(self.folder, "scene.blend"))
        bpy.ops.brume.bake_slices(tile=(4, 4), tiles=4)
        bpy.ops.brume.bake_occlusion(voxels=(4, 4, 4), rays=4, depth="EXR16")
        for name in ("ring.1_slices.png", "ring.1_slices.json", "ring.1_ao.exr", "ring.1_ao.json"):
            self.assertTrue(os.path.isfile(os.path.join(self.folder, name)), name)

    def test_a_typed_extension_chooses_the_format(self):
        self.select(torus())
        for name, depth, written, expected in (
            ("a.exr", "PNG8", "a.exr", "half"),
            ("b.png", "PNG16", "b.png", "unorm16"),
            ("c.1", "EXR32", "c.1.exr", "float32"),
        ):
            path = os.path.join(self.folder, name)
            bpy.ops.brume.bake_slices(filepath=path, depth=depth, tile=(4, 4), tiles=2)
            path = os.path.join(self.folder, written)
            self.assertTrue(os.path.isfile(path))
            self.assertEqual(self.described(path)["depth"], expected)

    def test_errors_of_the_program_are_one_line(self):
        self.select(torus())
        path = os.path.join(self.folder, "nowhere", "a.png")
        message = self.error_of(bpy.ops.brume.bake_slices, filepath=path)
        self.assertEqual(len(message.splitlines()), 1)
        self.assertIn("nowhere", message)
        self.assertEqual(len(self.said("ERROR")), 1)

    def test_an_open_mesh_gives_a_warning(self):
        ring = torus()
        shape = bmesh.new()
        shape.from_mesh(ring.data)
        bmesh.ops.delete(shape, geom=list(shape.faces)[:1], context="FACES")
        shape.to_mesh(ring.data)
        shape.free()
        self.select(ring)
        self.slices(tile=(6, 6), tiles=4)
        self.assertSaid("has 4 open edges", "WARNING")


class Selection(BakeCase):
    def assertRefused(self, part):
        for operator in (bpy.ops.brume.bake_slices, bpy.ops.brume.bake_occlusion):
            message = self.error_of(operator, filepath=self.path)
            self.assertIn(part, message)
            self.assertEqual(len(self.said()), 1)
        self.assertFalse(os.path.exists(self.path))

    def test_nothing_selected(self):
        self.select()
        self.assertRefused("nothing is selected; select the meshes to bake")

    def test_a_selection_without_meshes(self):
        light = level_parts.add("light", bpy.data.lights.new("light", "POINT"))
        empty = level_parts.add("empty", None)
        wire = level_parts.add("wire", bpy.data.meshes.new("wire"))
        self.select(light, empty, wire)
        self.assertRefused('the selection has no faces ("empty", "light", "wire"); select the meshes to bake')

    def test_what_has_no_faces_is_skipped_with_a_warning(self):
        light = level_parts.add("light", bpy.data.lights.new("light", "POINT"))
        ring = torus()
        self.select(light, ring)
        _, sums = self.slices()
        self.assertFills(sums[0], ring)
        self.assertSaid('"light": without faces; not baked', "WARNING")

    def test_more_objects_than_channels(self):
        self.select(*(box(f"box {i}", (2 * i, 0, 0), (2 * i + 1, 1, 1)) for i in range(5)))
        message = self.error_of(bpy.ops.brume.bake_slices, filepath=self.path, channels="EACH")
        self.assertIn("5 objects for 4 channels", message)


class Occlusion(BakeCase):
    def bake(self, **settings):
        known = {"filepath": self.path, "depth": "EXR32", "voxels": (6, 5, 8), "rays": 16}
        self.assertEqual(bpy.ops.brume.bake_occlusion(**(known | settings)), {"FINISHED"})
        return self.described()

    def test_what_is_below_is_hidden_from_above(self):
        self.select(box("slab", (-2, -2, 0), (2, 2, 0.5), location=(5, 1, 2)))
        described = self.bake(layout_of_tiles="strip", margin=0.75)
        self.assertEqual(described["size"], [6, 8, 5])
        self.assertEqual((described["axes"], described["tiles"]), ("+x +z +y", 8))
        low, high = np.array(described["box"]["low"]), np.array(described["box"]["high"])
        self.assertLess(np.abs((low + high) / 2 - (5, 2.25, -1)).max(), _POINT)
        self.assertLess(np.abs(high - low - (4 + 6, 0.5 + 6, 4 + 6)).max(), _POINT)
        tiles = self.texels().reshape(5, 8, 6, 4).swapaxes(0, 1)
        # Up is green, down is blue. Where no ray can hit, nothing is occluded.
        below, above = tiles[:4], tiles[4:]
        self.assertEqual((below[..., 2].max(), above[..., 1].max()), (0, 0))
        self.assertGreater(min(below[3, 2, 2:4, 1].min(), above[0, 2, 2:4, 2].min()), 0)

    def test_separate_images(self):
        self.select(torus())
        self.bake(separate=True)
        names = [f"baked{part}.exr" for part in ("", "_up", "_down")]
        found = [image.name for image in bpy.data.images if image.name.startswith("baked")]
        self.assertEqual(sorted(found), sorted(names))
        for name in names:
            self.assertEqual(len(self.described(os.path.join(self.folder, name))["channels"]), 1)

    def test_settings_reach_the_program(self):
        option = self.recorded()
        self.select(torus())
        self.bake(margin=0.5, rays=8, gamma=0.7, correction=0.25, falloff=2, preset="godot", padding=1)
        expected = {"--margin": "0.5", "--rays": "8", "--gamma": "0.7", "--correction": "0.25", "--falloff": "2.0"}
        expected |= {"--preset": "godot", "--padding": "1", "--bits": "32", "--size": "6x8x5", "--layout": None}
        self.assertEqual({name: option(name) for name in expected}, expected)

    def test_defaults_are_those_of_the_program(self):
        option = self.recorded()
        self.select(box("cube", (-1, -1, -1), (1, 1, 1)))
        bpy.ops.brume.bake_occlusion(filepath=self.path, rays=1)
        names = ("--size", "--margin", "--gamma", "--correction", "--falloff", "--preset", "--padding", "--layout")
        found = [option(name) for name in names]
        self.assertEqual(found, ["64x64x64", "1.5", "1.0", "1.0", "1.0", None, None, None])
