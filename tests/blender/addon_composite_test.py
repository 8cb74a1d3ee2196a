"""OpenEXR frames in Blender's compositor: layers by name, and *Alpha Over* (docs/reference/command-line.md)."""

import math
import os
import subprocess

import addon_case
import bpy
import level_parts
import numpy as np
from addon_case import AddonCase, box

SIZE = (48, 32)
RED = (1.0, 0.0, 0.0)


class Composite(AddonCase):
    def setUp(self):
        super().setUp()
        box("crate", (-3, 1, 0), (-1, 3, 2))
        self.event("SMOKE", (1, 1, 0.5))
        data = bpy.data.cameras.new("camera")
        self.scene.camera = level_parts.add("camera", data, location=(0, -9, 2), rotation=(math.radians(90), 0, 0))
        self.scene.world = bpy.data.worlds.new("world")
        self.scene.world.color = (0.1, 0.3, 0.9)
        self.export("level.glb")

    def render(self, name, background, sky=None):
        """Renders a frame; `sky` is what the camera sees in the place of the world."""
        with open(os.path.join(self.folder, "level.toml"), encoding="utf-8") as file:
            lines = file.read().splitlines()
        if sky:
            seen = ("zenith", "horizon")
            lines = [f"{line.split()[0]} = {list(sky)}" if line.startswith(seen) else line for line in lines]
        with open(os.path.join(self.folder, name + ".toml"), "w", encoding="utf-8") as file:
            file.write("\n".join(lines))
        command = [addon_case.BRUME, "render", name + ".toml", "-o", name + ".exr", "--background", background]
        command += ["--time", "3", "--size", "%dx%d" % SIZE]
        subprocess.run(command, cwd=self.folder, check=True, capture_output=True)
        return os.path.join(self.folder, name + ".exr")

    def composited(self, path, over):
        """The picture over a colour, by the compositor, and the names of the layers."""
        scene = self.scene
        scene.use_nodes = True
        tree = scene.node_tree
        tree.nodes.clear()
        image, color = tree.nodes.new("CompositorNodeImage"), tree.nodes.new("CompositorNodeRGB")
        mix, end = tree.nodes.new("CompositorNodeAlphaOver"), tree.nodes.new("CompositorNodeComposite")
        image.image, color.outputs[0].default_value = bpy.data.images.load(path), (*over, 1)
        tree.links.new(mix.inputs[1], color.outputs[0])
        tree.links.new(mix.inputs[2], image.outputs[0])
        tree.links.new(end.inputs[0], mix.outputs[0])
        render = scene.render
        render.resolution_x, render.resolution_y, render.resolution_percentage = *SIZE, 100
        render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
        render.filepath = path[:-4] + "_over.exr"
        bpy.ops.render.render(write_still=True)
        found = bpy.data.images.load(render.filepath)
        pixels = np.array(found.pixels[:]).reshape(SIZE[1], SIZE[0], 4)[..., :3]
        return pixels, {output.name for output in image.outputs if output.enabled}

    def test_alpha_over_red_is_brumes_picture_before_a_red_sky(self):
        expected, _ = self.composited(self.render("red", "in", RED), (0, 1, 0))
        for background in ("layer", "none"):
            over, layers = self.composited(self.render(background, background), RED)
            # Half floats of up to 2: a rounding of R, one of A, and one of the sum.
            self.assertLess(np.abs(over - expected).max(), 3 * 2**-11)
            self.assertLessEqual({"Combined", "Alpha", "Depth", "transmittance", "depth_in", "albedo", "media"}, layers)
            self.assertEqual("background" in layers, background == "layer")
        # Nothing of the sky, and something in between.
        self.assertTrue((over == RED).all(axis=2).any())
        self.assertTrue(((over[..., 0] > 0.3) & (over[..., 0] < 0.9)).any())
