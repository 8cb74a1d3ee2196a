"""Pictures of volumes, by Brume, beside analytic projections and Blender's own; voxel smoke in Blender."""

import math
import os
import subprocess

import addon_case
import bpy
import level_parts
import numpy as np
from addon_case import box
from mathutils import Matrix
from volume_case import CENTRE, RADIUS, SLACK, VOXEL, VolumeCase, outline, stage, transmittance, volume_material


class Picture(VolumeCase):
    SIZE = (160, 120)

    def setUp(self):
        super().setUp()
        bpy.data.objects.remove(self.floor)
        self.scene.render.filepath = os.path.join(self.folder, "out_")

    def place(self, cloud):
        parent = level_parts.add("parent", None, rotation=(0.2, 0.3, 0), scale=(1.2, 1, 0.9))
        cloud.parent, cloud.location, cloud.rotation_euler = parent, (0.4, -0.3, 0.2), (0.5, 0.8, -0.4)
        cloud.scale = (1.6, 0.7, 1.1)
        bpy.context.view_layer.update()

    def render(self):
        self.scene.frame_end = self.scene.frame_start
        bpy.ops.brume.film()
        return transmittance(self.scene.render.frame_path(frame=self.scene.frame_start))

    def render_with_cycles(self, samples):
        self.scene.render.engine = "CYCLES"
        self.scene.cycles.samples, self.scene.cycles.use_denoising = samples, False
        self.scene.render.filepath = os.path.join(self.folder, "cycles.png")
        bpy.ops.render.render(write_still=True)
        return transmittance(self.scene.render.filepath)

    def test_a_ball_is_where_its_projection_is(self):
        """Of any affine transform, through the exported camera."""
        for metres in (1.0, 0.1):
            self.scene.unit_settings.scale_length = metres
            cloud = self.volume(material=volume_material(Color=(0.0, 0.0, 0.0), Density=1e5))
            self.place(cloud)
            camera = stage(self.scene, (6, -9, 4), (1.2, 0, 0.6), self.SIZE, 60)
            dark = self.render() < 0.5
            rows, columns = np.flatnonzero(dark.any(axis=1)), np.flatnonzero(dark.any(axis=0))
            low = np.array([columns[0], rows[0]])
            high = np.array([columns[-1], rows[-1]]) + 1
            # Between the projections of a smaller and a larger ball; an edge is at most a pixel off.
            inner = outline(cloud.matrix_world, CENTRE, RADIUS - SLACK, camera, self.SIZE)
            outer = outline(cloud.matrix_world, CENTRE, RADIUS + SLACK, camera, self.SIZE)
            self.assertTrue((inner[0] > 2).all() and (inner[1] < np.array(self.SIZE) - 2).all(), inner)
            self.assertTrue((outer[0] - 1 <= low).all() and (low <= inner[0] + 1).all(), (outer, low, inner))
            self.assertTrue((inner[1] - 1 <= high).all() and (high <= outer[1] + 1).all(), (outer, high, inner))
            bpy.data.objects.remove(cloud)

    def test_cycles_shows_the_same(self):
        """Place and extinction, of a thin volume without scattering."""
        cloud = self.volume(material=volume_material(Color=(0.0, 0.0, 0.0), Density=0.5))
        self.place(cloud)
        stage(self.scene, (6, -9, 4), (1.2, 0, 0.6), self.SIZE, 60)
        found = self.render()
        # Cycles takes an index for the low corner of a voxel, OpenVDB and Brume for its centre.
        cloud.matrix_basis = cloud.matrix_basis @ Matrix.Translation([-VOXEL / 2] * 3)
        expected = self.render_with_cycles(64)
        inside = np.minimum(found, expected) < 0.9
        places = np.argwhere(inside)
        depths = [-np.log(picture[inside]) for picture in (found, expected)]
        middles = [depth @ places / depth.sum() for depth in depths]
        # A voxel is four pixels.
        self.assertLess(np.abs(middles[0] - middles[1]).max(), 0.2)
        # A step of 8 bits is 0.01 of the background; the mean depth is 0.6.
        self.assertGreater(depths[0].mean(), 0.5)
        self.assertLess(abs(depths[0].sum() / depths[1].sum() - 1), 0.02)
        self.assertLess(np.abs(found - expected).mean(), 0.01)

    def test_brume_shows_the_file_that_blender_shows(self):
        """Frame by frame: in Blender the name of the loaded file, in Brume's picture the column of the ball."""
        cloud = self.sequence(material=volume_material(Color=(0.0, 0.0, 0.0), Density=100.0))
        stage(self.scene, (0, -12, 0), (math.pi / 2, 0, 0), (64, 32), 80)
        self.scene.render.filepath = os.path.join(self.folder, "out", "f_")
        for mode in ("CLIP", "REPEAT", "PING_PONG"):
            cloud.data.sequence_mode = mode
            self.scene.frame_start, self.scene.frame_end = 8, 16
            bpy.ops.brume.film()
            for frame in range(8, 17):
                self.scene.frame_set(frame)
                shown = cloud.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.grids
                shown.load()
                name = os.path.basename(shown.frame_filepath) if shown.frame != -1 else ""
                dark = transmittance(os.path.join(self.folder, "out", f"f_{frame:04d}.png"))[16] < 0.5
                if not name.endswith(".vdb") or not shown.is_loaded:
                    self.assertFalse(dark.any(), (mode, frame))
                    continue
                number = int(name[-7:-4])
                # 64 px are 12 m * 36 mm / 80 mm = 5.4 m wide at the ball.
                expected = 32 + 0.8 * (number - 6) * 64 / 5.4
                self.assertLess(abs(np.flatnonzero(dark).mean() + 0.5 - expected), 1, (mode, frame, name))


class VoxelSmoke(VolumeCase):
    def test_the_smoke_of_brume_sim_lies_on_the_floor_of_the_level(self):
        """--volumes --up z, opened in Blender beside the level that was exported."""
        options, voxel = self.scene.brume, 0.125
        options.voxel, options.smoke_voxels, self.scene.frame_end = voxel, 2000, 50
        self.event("SMOKE", location=(1, 2, 0.3))
        self.export()
        sim = [addon_case.BRUME, "sim", "level.toml", "--volumes", "smoke_%04d.vdb", "--up", "z", "--frames", "48-48"]
        subprocess.run([*sim, "--quiet"], cwd=self.folder, check=True)
        smoke = self.volume(os.path.join(self.folder, "smoke_0048.vdb"), name="smoke")
        surface = box("surface", (0, 0, 0), (1, 1, 1))
        modifier = surface.modifiers.new("smoke", "VOLUME_TO_MESH")
        modifier.object, modifier.resolution_mode, modifier.voxel_size = smoke, "VOXEL_SIZE", voxel
        modifier.threshold = 0.5
        evaluated = surface.evaluated_get(bpy.context.evaluated_depsgraph_get())
        points = np.array([vertex.co for vertex in evaluated.data.vertices])
        low, high = points.min(axis=0), points.max(axis=0)
        # The floor fills the voxel above it, too, which it touches; the smoke begins at the next centre.
        self.assertGreater(low[2], 0)
        self.assertLess(low[2], 2 * voxel)
        # The smoke of a ball of that volume whose lower part is pushed up and aside by the floor: larger than the ball
        # cut off, smaller than a half ball of the same volume on the floor.
        radius = (2000 * 0.75 / math.pi) ** (1 / 3) * voxel
        self.assertLess(np.abs((low + high)[:2] / 2 - (1, 2)).max(), 2 * voxel)
        for axis in (0, 1):
            self.assertGreater(high[axis] - low[axis], 2 * radius - 2 * voxel)
            self.assertLess(high[axis] - low[axis], 2 * radius * 2 ** (1 / 3) + 2 * voxel)
