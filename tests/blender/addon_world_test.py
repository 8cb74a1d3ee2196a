"""The world as the sky of the timeline."""

import os

import bpy
import numpy as np
from addon_case import AddonCase


class World(AddonCase):
    def world(self, color=(0.3, 0.3, 0.3), strength=1.0):
        made = bpy.data.worlds.new("world")
        made.use_nodes = True
        self.background = made.node_tree.nodes["Background"]
        self.background.inputs["Color"].default_value = (*color, 1)
        self.background.inputs["Strength"].default_value = strength
        self.scene.world = made
        return made

    def assertSky(self, *color):
        sky = self.export()["sky"]
        for key, factor in (("zenith", 1), ("horizon", 1), ("ambient", 4 / 3)):
            for found, expected in zip(sky[key], color):
                self.assertAlmostEqual(found, factor * expected, 5, key)

    def test_a_plain_colour_is_the_sky(self):
        self.world((0.1, 0.2, 0.3), 2)
        self.assertSky(0.2, 0.4, 0.6)
        self.assertFalse(any("world" in text for text in self.said()))

    def test_ambient_light_is_that_of_the_world_on_average(self):
        """From a direction of height y comes 0.75 + 0.375 y of `ambient` (docs/guides/timelines.md)."""
        self.world((0.5, 0.5, 0.5))
        heights = np.linspace(-1, 1, 1001)
        mean = np.mean(0.75 + 0.375 * heights) * self.export()["sky"]["ambient"][0]
        self.assertAlmostEqual(mean, 0.5, 5)

    def test_worlds_without_nodes_and_no_world(self):
        world = self.world()
        world.use_nodes, world.color = False, (0.05, 0.06, 0.07)
        self.assertSky(0.05, 0.06, 0.07)
        self.scene.world = None
        self.assertSky(0, 0, 0)

    def test_an_explicit_choice_stays(self):
        self.world()
        self.scene.brume.sky = "BRUME"
        self.assertNotIn("sky", self.export())
        self.scene.brume.sky = "WORLD"
        self.assertSky(0.3, 0.3, 0.3)

    def test_a_sky_texture_is_daylight_with_a_message(self):
        world = self.world()
        sky = world.node_tree.nodes.new("ShaderNodeTexSky")
        world.node_tree.links.new(self.background.inputs["Color"], sky.outputs[0])
        self.assertNotIn("sky", self.export())
        text = "the world is no plain colour but Sky Texture, which is not exported: the sky is Brume's daylight"
        self.assertSaid(text, "WARNING")

    def test_an_environment_is_its_mean_over_all_directions(self):
        world = self.world(strength=2)
        image = bpy.data.images.new("around", 8, 36, float_buffer=True)
        # Bright within 30 degrees of the zenith: 1 - cos(30 degrees) of the upper half of the sphere.
        pixels = np.zeros((36, 8, 4), dtype=np.float32)
        rows = (np.arange(36) + 0.5) * 5 - 90
        pixels[rows > 60, :, :3] = 1
        pixels[..., 3] = 1
        image.pixels.foreach_set(pixels.ravel())
        image.filepath_raw, image.file_format = os.path.join(self.folder, "around.exr"), "OPEN_EXR"
        image.save()
        node = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
        node.image = image
        world.node_tree.links.new(self.background.inputs["Color"], node.outputs[0])
        sky = self.export()["sky"]["zenith"][0]
        self.assertAlmostEqual(sky, 2 * (1 - np.cos(np.radians(30))) / 2, 3)
        self.assertSaid("the Environment Texture of the world is not exported: the sky has its mean colour", "WARNING")

    def test_the_volume_of_a_world(self):
        world = self.world()
        volume = world.node_tree.nodes.new("ShaderNodeVolumeScatter")
        end = world.node_tree.nodes["World Output"]
        world.node_tree.links.new(end.inputs["Volume"], volume.outputs[0])
        self.assertSky(0.3, 0.3, 0.3)
        self.assertSaid("the volume of the world is not exported", "WARNING")
