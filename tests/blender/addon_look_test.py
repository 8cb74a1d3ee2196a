"""What materials and lights become in glTF and Scene.txt, and the messages about what is lost."""

import os
import subprocess

import addon_case
import bpy
import level_parts
from addon_case import AddonCase, box

GLASS = "KHR_materials_transmission"


class LookCase(AddonCase):
    def material(self, name="look"):
        """A material without nodes but its output, on the floor; `link` builds its tree."""
        made = bpy.data.materials.new(name)
        made.use_nodes = True
        made.node_tree.nodes.clear()
        made.node_tree.nodes.new("ShaderNodeOutputMaterial")
        self.floor.data.materials.clear()
        self.floor.data.materials.append(made)
        return made

    def node(self, owner, kind, _outputs=None, **inputs):
        """A node; inputs are constants, or outputs of other nodes, by their names or numbers as `_1`."""
        tree = owner if isinstance(owner, bpy.types.NodeTree) else owner.node_tree
        made = tree.nodes.new("ShaderNode" + kind)
        for name, value in inputs.items():
            key = int(name[1:]) if name[0] == "_" else name.replace("_", " ")
            if isinstance(value, bpy.types.NodeSocket):
                tree.links.new(made.inputs[key], value)
            else:
                made.inputs[key].default_value = value
        return made

    def surface(self, owner, output, name="Surface"):
        end = next(node for node in owner.node_tree.nodes if node.type.startswith("OUTPUT_"))
        owner.node_tree.links.new(end.inputs[name], output)

    def shaded(self, kind, **inputs):
        """A material of one shader."""
        made = self.material()
        self.surface(made, self.node(made, kind, **inputs).outputs[0])
        return made

    def exported(self):
        """The material of the floor in glTF."""
        document = self.document()
        found = document["materials"][document["meshes"][0]["primitives"][0]["material"]]
        self.assertEqual(found["name"], self.floor.data.materials[0].name)
        return found

    def color(self, found):
        return found["pbrMetallicRoughness"].get("baseColorFactor", [1, 1, 1, 1])

    def assertColor(self, found, *expected):
        for a, b in zip(self.color(found), expected):
            self.assertAlmostEqual(a, b, 4, self.color(found))

    def roles(self):
        info = [addon_case.BRUME, "info", "level.glb"]
        return subprocess.check_output(info, cwd=self.folder, text=True, stderr=subprocess.DEVNULL)


class Glass(LookCase):
    def test_shaders_that_are_seen_through(self):
        blue = (0.2, 0.4, 0.9, 1)
        for kind, inputs in (
            ("BsdfGlass", {"Color": blue}),
            ("BsdfRefraction", {"Color": blue}),
            ("BsdfTransparent", {"Color": blue}),
            ("BsdfPrincipled", {"Base_Color": blue, "Transmission": 0.9}),
        ):
            with self.subTest(kind):
                self.shaded(kind, **inputs)
                found = self.exported()
                self.assertGreaterEqual(found["extensions"][GLASS]["transmissionFactor"], 0.899)
                self.assertColor(found, *blue)
                self.assertIn("glass", self.roles())
                self.assertFalse(any("material" in text for text in self.said()))

    def test_glass_that_lets_shadow_rays_pass(self):
        made = self.material()
        path = self.node(made, "LightPath")
        glass = self.node(made, "BsdfGlass", Color=(0.5, 1, 0.5, 1))
        clear = self.node(made, "BsdfTransparent")
        mix = self.node(made, "MixShader", _0=path.outputs["Is Shadow Ray"], _1=glass.outputs[0], _2=clear.outputs[0])
        self.surface(made, mix.outputs[0])
        found = self.exported()
        self.assertEqual(found["extensions"][GLASS]["transmissionFactor"], 1)
        self.assertColor(found, 0.5, 1, 0.5)

    def test_half_clear_and_half_glass_is_one_tint(self):
        made = self.material()
        glass = self.node(made, "BsdfGlass", Color=(0.2, 0.2, 1, 1))
        clear = self.node(made, "BsdfTransparent")
        mix = self.node(made, "MixShader", _0=0.5, _1=glass.outputs[0], _2=clear.outputs[0])
        self.surface(made, mix.outputs[0])
        self.assertColor(self.exported(), 0.6, 0.6, 1)

    def test_a_veil_blends(self):
        made = self.material()
        matte = self.node(made, "BsdfDiffuse", Color=(1, 0, 0, 1))
        clear = self.node(made, "BsdfTransparent")
        mix = self.node(made, "MixShader", _0=0.3, _1=clear.outputs[0], _2=matte.outputs[0])
        self.surface(made, mix.outputs[0])
        found = self.exported()
        self.assertEqual(found["alphaMode"], "BLEND")
        self.assertColor(found, 1, 0, 0, 0.3)
        mix.inputs[0].default_value = 0.7
        self.exported()
        self.assertSaid('the material "look": an alpha from 0.5 on is drawn opaque', "WARNING")

    def test_alpha_counts_whatever_the_viewport_blends(self):
        self.shaded("BsdfPrincipled", Alpha=0.25)
        self.assertEqual(self.exported()["alphaMode"], "BLEND")

    def test_an_image_cuts_out(self):
        made = self.material()
        image = self.node(made, "TexImage")
        image.image = bpy.data.images.new("leaf", 4, 4, alpha=True)
        matte = self.node(made, "BsdfDiffuse", Color=image.outputs["Color"])
        clear = self.node(made, "BsdfTransparent")
        mix = self.node(made, "MixShader", _0=image.outputs["Alpha"], _1=clear.outputs[0], _2=matte.outputs[0])
        self.surface(made, mix.outputs[0])
        found = self.exported()
        self.assertEqual(found["alphaMode"], "BLEND")
        self.assertIn("baseColorTexture", found["pbrMetallicRoughness"])
        self.assertFalse(any("material" in text for text in self.said()))

    def test_a_shader_in_a_group(self):
        group = bpy.data.node_groups.new("panes", "ShaderNodeTree")
        group.outputs.new("NodeSocketShader", "out")
        group.inputs.new("NodeSocketColor", "tint")
        inside = group.nodes.new("NodeGroupInput")
        glass = self.node(group, "BsdfGlass", Color=inside.outputs["tint"])
        group.links.new(group.nodes.new("NodeGroupOutput").inputs["out"], glass.outputs[0])
        made = self.material()
        node = self.node(made, "Group")
        node.node_tree = group
        node.inputs["tint"].default_value = (1, 0.5, 0.25, 1)
        self.surface(made, node.outputs[0])
        found = self.exported()
        self.assertEqual(found["extensions"][GLASS]["transmissionFactor"], 1)
        self.assertColor(found, 1, 0.5, 0.25)

    def test_in_scene_txt_it_is_glass_by_its_name(self):
        self.shaded("BsdfGlass")
        self.assertEqual(self.names(), ["GLASS_floor"])
        self.floor.brume.role = "WALL"
        self.assertEqual(self.names(), ["floor"])

    def test_nothing_of_it_stays_in_the_file(self):
        self.shaded("BsdfGlass")
        before = [block.name for kind in ("materials", "images", "meshes") for block in getattr(bpy.data, kind)]
        self.exported()
        after = [block.name for kind in ("materials", "images", "meshes") for block in getattr(bpy.data, kind)]
        self.assertEqual(before, after)


class Opaque(LookCase):
    def test_shaders_that_are_not_principled(self):
        for kind, metal in (("BsdfDiffuse", 0), ("BsdfGlossy", 1)):
            with self.subTest(kind):
                self.shaded(kind, Color=(0.1, 0.2, 0.3, 1))
                found = self.exported()
                self.assertColor(found, 0.1, 0.2, 0.3)
                self.assertEqual(found["pbrMetallicRoughness"].get("metallicFactor", 1), metal)
                self.assertFalse(any("material" in text for text in self.said()))

    def test_emission_alone_and_with_others(self):
        self.shaded("Emission", Color=(0, 1, 0, 1), Strength=3.0)
        self.assertEqual(self.exported()["emissiveFactor"], [0, 1, 0])
        made = self.material()
        glow = self.node(made, "Emission", Color=(0, 1, 0, 1), Strength=4.0)
        matte = self.node(made, "BsdfDiffuse", Color=(1, 0, 0, 1))
        add = self.node(made, "AddShader", _0=glow.outputs[0], _1=matte.outputs[0])
        self.surface(made, add.outputs[0])
        found = self.exported()
        self.assertColor(found, 1, 0, 0)
        self.assertEqual(found["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"], 4)

    def test_mixed_shaders_become_their_mean(self):
        made = self.material()
        red = self.node(made, "BsdfDiffuse", Color=(1, 0, 0, 1))
        blue = self.node(made, "BsdfDiffuse", Color=(0, 0, 1, 1))
        mix = self.node(made, "MixShader", _0=0.25, _1=red.outputs[0], _2=blue.outputs[0])
        self.surface(made, mix.outputs[0])
        self.assertColor(self.exported(), 0.75, 0, 0.25)
        self.assertSaid('the material "look": mixed shaders become one', "WARNING")

    def test_principled_materials_stay_as_they_are(self):
        made = level_parts.material("plain", (0.1, 0.2, 0.3), 0.4)
        self.floor.data.materials.append(made)
        found = self.exported()
        self.assertColor(found, 0.1, 0.2, 0.3)
        self.assertEqual(self.said("WARNING"), ["the scene has no camera; Brume uses one with everything in view"])


class Procedural(LookCase):
    def checker(self, made):
        return self.node(made, "TexChecker", Color1=(1, 0, 0, 1), Color2=(0, 0, 0.5, 1)).outputs["Color"]

    def test_a_checker_becomes_its_mean(self):
        made = self.material("tiles")
        shader = self.node(made, "BsdfPrincipled", Base_Color=self.checker(made))
        self.surface(made, shader.outputs[0])
        found = self.exported()
        self.assertColor(found, 0.5, 0, 0.25)
        self.assertSaid('the material "tiles": Base Color (Checker Texture) becomes its mean colour', "WARNING")
        self.export()
        self.assertSaid('the material "tiles": Base Color (Checker Texture) becomes its mean colour', "WARNING")

    def test_one_message_for_all_of_a_material(self):
        made = self.material("tiles")
        noise = self.node(made, "TexNoise").outputs["Fac"]
        voronoi = self.node(made, "TexVoronoi").outputs["Color"]
        shader = self.node(made, "BsdfPrincipled", Base_Color=voronoi, Roughness=noise, Metallic=noise)
        self.surface(made, shader.outputs[0])
        found = self.exported()["pbrMetallicRoughness"]
        self.assertEqual((found["roughnessFactor"], found["metallicFactor"]), (0.5, 0.5))
        self.assertNotIn("baseColorFactor", found)
        said = [text for text in self.said("WARNING") if "tiles" in text]
        self.assertEqual(
            said,
            [
                'the material "tiles": Base Color (Voronoi Texture) becomes white; '
                "Roughness (Noise Texture) becomes 0.5; Metallic (Noise Texture) becomes 0.5"
            ],
        )

    def test_what_glows(self):
        made = self.material("sign")
        shader = self.node(made, "BsdfPrincipled", Emission=self.checker(made))
        self.surface(made, shader.outputs[0])
        factor = self.exported()["emissiveFactor"]
        self.assertEqual(factor, [0.5, 0, 0.25])
        self.assertSaid('the material "sign": Emission (Checker Texture) becomes its mean colour')

    def test_images_are_no_loss(self):
        made = self.material()
        image = self.node(made, "TexImage")
        image.image = bpy.data.images.new("wood", 4, 4)
        shader = self.node(made, "BsdfPrincipled", Base_Color=image.outputs["Color"])
        self.surface(made, shader.outputs[0])
        self.assertIn("baseColorTexture", self.exported()["pbrMetallicRoughness"])
        self.assertFalse(any("material" in text for text in self.said()))
        hue = self.node(made, "HueSaturation", Color=image.outputs["Color"])
        made.node_tree.links.new(shader.inputs["Base Color"], hue.outputs[0])
        self.exported()
        self.assertSaid("Base Color (Image Texture, Hue Saturation Value) becomes its image alone")


class Kinds(LookCase):
    def test_each_kind_is_named_once(self):
        self.floor.data.materials.clear()
        for name in ("rock", "sand", "clay"):
            made = bpy.data.materials.new(name)
            made.use_nodes = True
            shader = made.node_tree.nodes["Principled BSDF"]
            shader.inputs["Subsurface"].default_value = 0.1
            self.surface(made, self.node(made, "Displacement").outputs[0], "Displacement")
            self.surface(made, self.node(made, "VolumePrincipled").outputs[0], "Volume")
            bump = self.node(made, "Bump", Height=self.node(made, "TexNoise").outputs["Fac"])
            made.node_tree.links.new(shader.inputs["Normal"], bump.outputs[0])
            self.floor.data.materials.append(made)
        self.export("level.glb")
        names = 'the materials "rock", "sand" and 1 more: '
        for text in (
            "subsurface scattering is not exported",
            "displacement is not exported",
            "the volume inside of meshes is not exported",
            "bumps are not exported, only images of normals",
        ):
            self.assertEqual(self.said("WARNING").count(names + text), 1, self.said())

    def test_a_volume_alone_is_no_surface(self):
        made = self.material("fog")
        self.surface(made, self.node(made, "VolumePrincipled").outputs[0], "Volume")
        box("crate", (1, 1, 0), (2, 2, 1))
        self.assertEqual(self.names(), ["crate"])
        self.assertSaid('the object "floor": not exported, because the material is a volume alone', "WARNING")

    def test_hair(self):
        self.floor.modifiers.new("fur", "PARTICLE_SYSTEM")
        self.floor.particle_systems[0].settings.type = "HAIR"
        self.export()
        self.assertSaid('the hair of the object "floor" is not exported', "WARNING")

    def test_area_lights_are_named_once(self):
        for name in ("left", "right", "top"):
            level_parts.add(name, bpy.data.lights.new(name, "AREA"), location=(0, 0, 2))
        self.export("level.glb")
        self.assertSaid('the area lights "left", "right" and 1 more cast hard shadows', "INFO")

    def test_nodes_of_lights(self):
        light = bpy.data.lights.new("lamp", "POINT")
        light.energy, light.use_nodes = 100, True
        level_parts.add("lamp", light, location=(0, 0, 2))
        emission = light.node_tree.nodes["Emission"]
        emission.inputs["Color"].default_value, emission.inputs["Strength"].default_value = (0.5, 1, 1, 1), 2
        found = self.document()["extensions"]["KHR_lights_punctual"]["lights"][0]
        self.assertAlmostEqual(found["intensity"], 2 * 100 / 12.566371 * 683, 1)
        self.assertEqual(found["color"], [0.5, 1, 1])
        profile = self.node(light, "TexIES")
        light.node_tree.links.new(emission.inputs["Strength"], profile.outputs[0])
        self.export("level.glb")
        self.assertSaid('the light "lamp": the node IES Texture is not exported', "WARNING")

    def test_the_check_says_what_the_export_says(self):
        made = self.material("tiles")
        checker = self.node(made, "TexChecker").outputs["Color"]
        self.surface(made, self.node(made, "BsdfPrincipled", Base_Color=checker).outputs[0])
        level_parts.add("panel", bpy.data.lights.new("panel", "AREA"), location=(0, 0, 2))
        level_parts.add("lamp", bpy.data.lights.new("lamp", "SUN"))
        self.event("SMOKE", (0, 0, 1500))
        for kind, name in (("GLTF", "level.glb"), ("TXT", "level.txt")):
            self.scene.brume.format = kind
            self.export(name)
            exported = self.said()
            before = sorted(os.listdir(self.folder))
            bpy.ops.brume.check()
            self.assertEqual(self.said(), exported)
            self.assertEqual(sorted(os.listdir(self.folder)), before)
        self.assertSaid('the sun "lamp" is not exported')
