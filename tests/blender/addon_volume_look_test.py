"""Materials of volumes in timelines."""

import math
import os

import bpy
import level_parts
from volume_case import VolumeCase, volume_material, write_ball


class Material(VolumeCase):
    def look(self, **inputs):
        return self.replaced(material=volume_material(**inputs))

    def replaced(self, **arguments):
        """The table of a volume in place of those before."""
        for cloud in [thing for thing in bpy.data.objects if thing.type == "VOLUME"]:
            bpy.data.objects.remove(cloud)
        self.volume(**arguments)
        return self.table()

    def test_density_and_colour(self):
        table = self.look(Density=3.0, Color=(0.9, 0.6, 0.3), Anisotropy=-0.4)
        self.assertNear(table["extinction"], 3)
        self.assertNear(table["albedo"], (0.9, 0.6, 0.3))
        self.assertNear(table["anisotropy"], -0.4)
        self.assertEqual((table["density"], table["emission"]), ("density", 0))
        self.assertNotIn("heat", table)
        self.assertEqual(len(self.said("WARNING")), 1, "the camera alone")

    def test_absorption(self):
        # What the colour leaves of 1 is absorbed but for the root of the absorption colour: 0.2 + 0.8 (1 - 0.5).
        table = self.look(Density=10.0, Color=(0.2, 0.2, 0.2), Absorption_Color=(0.25, 0.25, 0.25))
        self.assertNear(table["extinction"], 6)
        self.assertNear(table["albedo"], [1 / 3] * 3)
        self.look(Color=(0.1, 0.5, 0.5), Absorption_Color=(0.5, 0.5, 0.5))
        self.assertSaid("light of each colour goes through it by another length", "WARNING")

    def test_the_default_material_is_blenders(self):
        self.volume()
        table = self.table()
        self.assertNear((table["extinction"], *table["albedo"], table["anisotropy"]), (1, 0.5, 0.5, 0.5, 0))

    def test_density_is_per_unit_of_the_object_or_of_the_world(self):
        self.scene.unit_settings.scale_length = 0.1
        cloud = self.volume(material=volume_material(Density=6.0))
        cloud.scale = (1, 2, 4)
        cloud.rotation_euler = (0.5, 0.6, 0.7)
        # A unit along the diagonal of the object is sqrt((1 + 4 + 16) / 3) units long, of 0.1 m.
        self.assertNear(self.table()["extinction"], 6 / math.sqrt(7) / 0.1)
        cloud.data.render.space = "WORLD"
        self.assertNear(self.table()["extinction"], 6 / 0.1)

    def test_what_glows(self):
        self.scene.unit_settings.scale_length = 0.1
        table = self.look(Density=4.0, Blackbody_Intensity=0.5, Temperature=1500.0, Temperature_Attribute="density")
        self.assertEqual((table["heat"], table["kelvin"]), ("density", 1500))
        # Cycles emits intensity * 5.670373e-14 / pi * T^4 per unit, Brume extinction * emission * (T / 1900)^4 per
        # metre.
        per_metre = 0.5 * 5.670373e-14 / math.pi * 1900**4 / 0.1
        self.assertNear(table["extinction"] * table["emission"], per_metre, 1e-5)
        # Without any density.
        table = self.look(Density=0.0, Blackbody_Intensity=0.5, Temperature_Attribute="density")
        self.assertNear(table["extinction"] * table["emission"], per_metre, 1e-5)
        self.assertLess(table["extinction"], 1e-5)
        self.assertEqual(self.look(Blackbody_Intensity=1.0)["emission"], 0)
        self.assertSaid('its file has no grid "temperature", so that it does not glow', "WARNING")

    def test_grids_by_other_names(self):
        path = write_ball(os.path.join(self.folder, "files", "fog.vdb"), grid="fog")
        self.volume(path, material=volume_material(Density_Attribute="fog"))
        self.assertEqual(self.table()["density"], "fog")

    def test_colors(self):
        self.assertNotIn("color", self.look())
        self.assertEqual(self.look(Color_Attribute="density")["color"], "density")
        self.assertNotIn("color", self.look(Color_Attribute="Cd"))
        self.assertSaid('its file has no grid "Cd", the Color Attribute of its material', "WARNING")
        material = volume_material()
        tree = material.node_tree
        attribute = tree.nodes.new("ShaderNodeAttribute")
        attribute.attribute_name = "density"
        tree.links.new(tree.nodes["Principled Volume"].inputs["Color"], attribute.outputs["Color"])
        table = self.replaced(material=material)
        self.assertEqual(table["color"], "density")
        self.assertNear(table["albedo"], (1, 1, 1))
        # What Brume would take for colours.
        path = write_ball(os.path.join(self.folder, "files", "painted.vdb"), grid="colour")
        table = self.replaced(path=path, material=volume_material(Density_Attribute="colour"))
        self.assertEqual(table["color"], "none")

    def test_values_of_linked_nodes(self):
        material = volume_material(Density=7.0)
        tree = material.node_tree
        kinds = ("ShaderNodeValue", "NodeReroute", "ShaderNodeTexNoise")
        value, reroute, noise = (tree.nodes.new(kind) for kind in kinds)
        value.outputs[0].default_value = 2.5
        shader = tree.nodes["Principled Volume"]
        tree.links.new(reroute.inputs[0], value.outputs[0])
        tree.links.new(shader.inputs["Density"], reroute.outputs[0])
        self.volume(material=material)
        self.assertNear(self.table()["extinction"], 2.5)
        tree.links.new(shader.inputs["Density"], noise.outputs["Fac"])
        self.assertNear(self.table()["extinction"], 7)
        self.assertSaid("its Density is linked to the node Noise Texture", "WARNING")

    def test_a_shader_in_a_group_beside_another(self):
        group = bpy.data.node_groups.new("group", "ShaderNodeTree")
        group.outputs.new("NodeSocketShader", "Volume")
        inner = group.nodes.new("ShaderNodeVolumePrincipled")
        inner.inputs["Density"].default_value = 9
        group.links.new(group.nodes.new("NodeGroupOutput").inputs[0], inner.outputs[0])
        material = volume_material()
        tree = material.node_tree
        node, added, glow = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("Group", "AddShader", "Emission"))
        node.node_tree = group
        tree.links.new(added.inputs[0], glow.outputs[0])
        tree.links.new(added.inputs[1], node.outputs[0])
        tree.links.new(tree.nodes["Material Output"].inputs["Volume"], added.outputs[0])
        self.volume(material=material)
        self.assertNear(self.table()["extinction"], 9)
        self.assertSaid("of its shaders only the Principled Volume is exported", "WARNING")

    def test_other_shaders_and_none(self):
        material = volume_material()
        tree = material.node_tree
        scatter = tree.nodes.new("ShaderNodeVolumeScatter")
        tree.links.new(tree.nodes["Material Output"].inputs["Volume"], scatter.outputs[0])
        cloud = self.volume(material=material)
        self.assertNear(self.table()["extinction"], 1)
        self.assertSaid("its shader is no Principled Volume but Volume Scatter", "WARNING")
        cloud.data.materials[0] = level_parts.material("surface", (1, 1, 1))
        self.assertSkipped("no volume shader")

    def test_what_brume_lacks(self):
        self.look(Anisotropy=1.0, Emission_Strength=2.0, Blackbody_Intensity=1.0,
                  Blackbody_Tint=(1.0, 0.5, 0.5), Temperature_Attribute="density")
        for part in ("Anisotropy 1.00 becomes 0.99", "Emission is", "Blackbody Tint is"):
            self.assertSaid(part + " not" * part.endswith("is"), "WARNING")
