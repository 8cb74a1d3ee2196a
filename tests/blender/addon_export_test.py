"""What the add-on exports: visible objects, units, warnings, formats."""

import os
import types

import bpy
import level_parts
from addon_case import AddonCase, box
from brume_blender import conversion
from brume_blender.export_level import BRUME_OT_export_level


class Visibility(AddonCase):
    """The camera icon counts, as in Blender's own renders; eyes do not."""

    def test_objects_hidden_only_in_the_viewport_are_exported(self):
        box("by_h", (1, 1, 0), (2, 2, 1)).hide_set(True)
        box("by_screen", (1, 1, 0), (2, 2, 9)).hide_viewport = True
        for name in ("eye", "screen"):
            collection = bpy.data.collections.new(name)
            self.scene.collection.children.link(collection)
            box("in_" + name, (1, 1, 0), (2, 2, len(name)), collection=collection)
        bpy.data.collections["screen"].hide_viewport = True
        bpy.context.view_layer.layer_collection.children["eye"].hide_viewport = True
        self.assertEqual(self.names(), ["by_h", "by_screen", "floor", "in_eye", "in_screen"])

    def test_objects_without_camera_icon_are_not_exported(self):
        box("own", (1, 1, 0), (2, 2, 1)).hide_render = True
        collection = bpy.data.collections.new("collection")
        self.scene.collection.children.link(collection)
        box("inside", (1, 1, 0), (2, 2, 1), collection=collection)
        collection.hide_render = True
        excluded = bpy.data.collections.new("excluded")
        self.scene.collection.children.link(excluded)
        box("unticked", (1, 1, 0), (2, 2, 1), collection=excluded)
        bpy.context.view_layer.layer_collection.children["excluded"].exclude = True
        self.assertEqual(self.names(), ["floor"])

    def test_instanced_collections_follow_their_camera_icons(self):
        library = bpy.data.collections.new("library")
        box("shown", (1, 1, 0), (2, 2, 1), collection=library).hide_viewport = True
        box("not_shown", (1, 1, 0), (2, 2, 2), collection=library).hide_render = True
        instance = level_parts.add("instance", None)
        instance.instance_type, instance.instance_collection = "COLLECTION", library
        self.assertEqual(self.names(), ["floor", "shown"])

    def test_events_follow_the_same_rule(self):
        self.event("BLAST", blast_radius=1).hide_set(True)
        self.event("BLAST", blast_radius=2).hide_viewport = True
        self.event("BLAST", blast_radius=3).hide_render = True
        self.assertEqual([event["radius"] for event in self.export()["event"]], [1, 2])

    def test_lights_follow_the_same_rule(self):
        for name, setting in (("seen", "hide_viewport"), ("dark", "hide_render")):
            light = level_parts.add(name, bpy.data.lights.new(name, "POINT"))
            setattr(light, setting, True)
        self.assertEqual(self.names().count("LIGHT_SOURCE"), 1)

    def test_modifiers_are_those_of_the_render(self):
        for name, viewport, render in (("only_viewport", True, False), ("only_render", False, True)):
            array = self.floor.modifiers.new(name, "ARRAY")
            array.count = 2 if name == "only_render" else 5
            array.show_viewport, array.show_render = viewport, render
        subdivision = self.floor.modifiers.new("smooth", "SUBSURF")
        subdivision.levels, subdivision.render_levels = 0, 1
        self.export()
        with open(os.path.join(self.folder, "Meshes", "floor.obj"), encoding="ascii") as file:
            triangles = sum(line.startswith("f ") for line in file)
        self.assertEqual(triangles, 2 * 6 * 4 * 2)

    def test_linked_objects_follow_the_same_rule(self):
        library = bpy.data.collections.new("library")
        box("linked", (1, 1, 0), (2, 2, 1), collection=library).hide_viewport = True
        path = os.path.join(self.folder, "library.blend")
        bpy.data.libraries.write(path, {library})
        for thing in list(library.objects):
            bpy.data.objects.remove(thing)
        bpy.data.collections.remove(library)
        with bpy.data.libraries.load(path, link=True) as (_, wanted):
            wanted.collections = ["library"]
        instance = level_parts.add("instance", None)
        instance.instance_type, instance.instance_collection = "COLLECTION", wanted.collections[0]
        self.assertEqual(self.names(), ["floor", "linked"])
        self.assertTrue(bpy.data.objects["linked"].hide_viewport)

    def test_the_scene_is_restored(self):
        hidden, other = box("hidden", (1, 1, 0), (2, 2, 1)), box("other", (1, 1, 0), (2, 2, 1))
        other.hide_render = True
        other.select_set(True)
        bpy.context.view_layer.objects.active = other
        hidden.hide_set(True)
        self.export()
        self.assertTrue(hidden.hide_get())
        self.assertEqual([thing.hide_viewport for thing in bpy.data.objects], [False] * 3)
        self.assertEqual((bpy.context.selected_objects, bpy.context.view_layer.objects.active), ([other], other))


class Again(AddonCase):
    """An export writes the whole timeline."""

    def test_tables_that_were_added_by_hand_are_replaced(self):
        first = self.export()
        path = os.path.join(self.folder, "level.toml")
        with open(path, "a", encoding="utf-8") as file:
            file.write('\n[[tank]]\nfile = "reef.toml"\nposition = [0.0, 1.0, 0.0]\n')
        self.assertEqual(self.export(), first)


class Lens(AddonCase):
    """Depth of field of the camera."""

    def camera(self):
        data = bpy.data.cameras.new("camera")
        self.scene.camera = level_parts.add("camera", data)
        data.lens = 40
        return data

    def test_a_camera_without_depth_of_field_is_a_pinhole(self):
        self.camera()
        self.assertFalse({"aperture", "focus", "blades"} & set(self.export()["camera"][0]))

    def test_f_number_focus_and_blades(self):
        dof = self.camera().dof
        dof.use_dof, dof.aperture_fstop, dof.focus_distance, dof.aperture_blades = True, 2, 3.5, 6
        key = self.export()["camera"][0]
        self.assertAlmostEqual(key["aperture"], 0.01)
        self.assertAlmostEqual(key["focus"], 3.5)
        self.assertEqual(key["blades"], 6)

    def test_motion_blur_is_a_shutter(self):
        self.camera()
        render = self.scene.render
        render.fps, render.fps_base, render.motion_blur_shutter = 25, 1.0, 0.5
        self.assertNotIn("shutter", self.export()["camera"][0])
        render.use_motion_blur = True
        self.assertAlmostEqual(self.export()["camera"][0]["shutter"], 0.02)

    def test_an_object_in_focus(self):
        dof = self.camera().dof
        aim = level_parts.add("aim", None)
        # The camera looks down: only the distance along its view counts.
        aim.location = (3, 4, -5)
        dof.use_dof, dof.focus_object = True, aim
        self.assertAlmostEqual(self.export()["camera"][0]["focus"], 5, places=5)


class Suffix(AddonCase):
    def test_a_typed_suffix_chooses_the_format(self):
        self.export("Scene.txt")
        self.assertEqual(sorted(os.listdir(self.folder)), ["Meshes", "Scene.toml", "Scene.txt", "Textures"])
        self.export("level.v2.glb")
        self.assertTrue(os.path.exists(os.path.join(self.folder, "level.v2.glb")))

    def test_format_and_suffix_stay_in_line(self):
        def checked(path, kind, before):
            form = types.SimpleNamespace(filepath=path, format=kind, checked_format=before)
            BRUME_OT_export_level.check(form, None)
            return form.filepath, form.format

        self.assertEqual(checked("a.txt", "GLTF", "GLTF"), ("a.txt", "TXT"))  # Typed.
        self.assertEqual(checked("a.glb", "TXT", "GLTF"), ("a.txt", "TXT"))  # Chosen.
        self.assertEqual(checked("a", "TXT", "TXT"), ("a.txt", "TXT"))
        self.assertEqual(checked("a.v2", "GLTF", "GLTF"), ("a.v2.glb", "GLTF"))


class Units(AddonCase):
    def test_every_field_has_a_unit_and_none_takes_keyframes(self):
        for group in (self.scene.brume, self.floor.brume_event, self.floor.brume):
            for name, field in group.bl_rna.properties.items():
                if field.type not in {"FLOAT", "INT", "ENUM", "BOOLEAN", "STRING"} or name in {"rna_type", "name"}:
                    continue
                self.assertFalse(field.is_animatable, name)
                self.assertNotIn("[", field.description, name)
        event = self.floor.brume_event.bl_rna.properties
        for name in ("time", "reach", "expand", "stay", "fade", "interval", "refill_rim", "refill_middle"):
            self.assertEqual(event[name].unit, "TIME_ABSOLUTE", name)
        for name in ("shown_radius", "shown_size", "shown_blast_radius"):
            self.assertEqual(event[name].unit, "LENGTH", name)
        self.assertEqual(event["shown_speed"].unit, "VELOCITY")
        self.assertEqual(self.scene.brume.bl_rna.properties["smoke_radius"].unit, "LENGTH")

    def test_shown_lengths_are_in_units_of_the_scene(self):
        self.scene.unit_settings.scale_length = 0.01
        event = self.event("BLAST").brume_event
        event.shown_blast_radius = 300  # Blender shows "3 m".
        self.assertAlmostEqual(event.blast_radius, 3, 5)
        event.shown_blast_radius = 1e9
        self.assertEqual(event.blast_radius, 100)
        self.scene.brume.smoke_radius = 200
        self.assertAlmostEqual(conversion.radius_of_voxels(self.scene.brume.smoke_voxels, 0.25), 2, 2)
        self.assertAlmostEqual(self.scene.brume.smoke_radius, 200, 0)

    def test_the_smoke_radius_is_that_of_its_volume(self):
        self.scene.brume.smoke_voxels, self.scene.brume.voxel = 1800, 0.25
        volume = 1800 * 0.25**3
        self.assertAlmostEqual(4 / 3 * 3.14159265 * self.scene.brume.smoke_radius**3, volume, 3)


class Warned(AddonCase):
    """Warnings with names, in the sidebar."""

    def test_all_warnings_are_in_the_sidebar_with_names(self):
        shared = bpy.data.lights.new("spot", "SPOT")
        for name in ("left lamp", "right lamp", "third lamp"):
            level_parts.add(name, shared)
        self.export("level.txt")
        for name in ("left lamp", "right lamp", "third lamp"):
            self.assertSaid(f'"{name}" becomes a point light', "WARNING")

    def test_errors_are_in_the_sidebar(self):
        self.floor.hide_render = True
        self.error_of(bpy.ops.brume.export_level, filepath=os.path.join(self.folder, "level.glb"))
        self.assertSaid("no visible mesh", "ERROR")

    def test_glowing_materials_and_area_lights_are_noted(self):
        glow = level_parts.material("neon", (1, 1, 1))
        glow.node_tree.nodes["Principled BSDF"].inputs["Emission"].default_value = (1, 0, 0, 1)
        self.floor.data.materials.append(glow)
        self.floor.data.materials.append(level_parts.material("plain", (1, 1, 1)))
        level_parts.add("panel", bpy.data.lights.new("panel", "AREA"), location=(0, 0, 2))
        self.export("level.glb")
        self.assertSaid('the material "neon" glows, but it lights nothing', "INFO")
        self.assertSaid('the area light "panel" casts hard shadows', "INFO")
        self.assertFalse(any("plain" in text for text in self.said()))

    def test_a_tiny_level_is_a_wrong_unit_scale(self):
        self.scene.unit_settings.scale_length = 0.01
        self.export()
        self.assertSaid("the level is only 0.1 m wide; check the unit scale", "WARNING")
        self.scene.unit_settings.scale_length = 1
        self.export()
        self.assertFalse(any("unit scale" in text for text in self.said()))


class Tone(AddonCase):
    def test_programs_with_tones_get_the_tone(self):
        self.scene.view_settings.view_transform = "Standard"
        self.stub("--tone neutral|standard:{neutral,standard}  Tone curve")
        self.assertEqual(self.export()["tone"], "standard")
        self.assertFalse(any("tone" in text for text in self.said()))
        self.scene.brume.tone = "neutral"
        self.assertEqual(self.export()["tone"], "neutral")

    def test_programs_without_tones_get_none(self):
        self.stub("--march full|half|quarter")
        self.assertNotIn("tone", self.export())
        self.assertSaid("this brume has no tone Standard", "INFO")

    def test_other_view_transforms_are_noted(self):
        self.stub("--tone")
        self.scene.view_settings.view_transform = "Filmic"
        self.export()
        self.assertSaid('Blender shows "Filmic"', "INFO")
