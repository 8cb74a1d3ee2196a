"""How the add-on runs brume: stills, films, samples, stopping."""

import os
import signal

import bpy
import numpy as np
from addon_case import AddonCase
from brume_blender import program, render, samples


_HANG = 120  # [s]: only ends tests that hang.


class Still(AddonCase):
    def test_any_frame_renders(self):
        folder = self.stub()
        self.event("BLAST", frame=10)
        for frame, time in ((0, "0.000000"), (25, "1.000000"), (-47, "0.000000")):
            self.scene.frame_set(frame)
            bpy.ops.brume.render()
            self.assertEqual(self.option(folder, "--time"), time)

    def test_samples_are_averaged(self):
        self.scene.render.resolution_x, self.scene.render.resolution_y = 5, 4
        self.scene.render.resolution_percentage = 100
        self.scene.brume.samples = "2"
        folder = self.stub(width=10, height=8)
        bpy.ops.brume.render()
        self.assertEqual(self.option(folder, "--size"), "10x8")
        self.assertEqual(tuple(bpy.data.images[render.IMAGE_NAME].size), (5, 4))

    def test_the_mean_of_blocks(self):
        pixels = np.zeros((6, 9, 4), dtype=np.float32)
        pixels[..., 3] = 1
        pixels[:3, :3, 0] = np.arange(9).reshape(3, 3) / 10  # The lower left block.
        pixels[3:, 6:, 1] = 1
        image = bpy.data.images.new("large", 9, 6)
        image.pixels.foreach_set(pixels.ravel())
        image.filepath_raw, image.file_format = os.path.join(self.folder, "large.png"), "PNG"
        image.save()
        samples.reduce(image.filepath_raw, 3)
        small = bpy.data.images.load(image.filepath_raw)
        found = np.array(small.pixels[:]).reshape(2, 3, 4)
        self.assertAlmostEqual(found[0, 0, 0], 0.4, 2)
        self.assertEqual([*found[1, 2, :3], found[1, 1, 1]], [0, 1, 0, 0])

    def test_the_previous_image_stays_for_comparison(self):
        self.stub(width=8, height=6)
        bpy.ops.brume.render()
        self.stub(width=10, height=6)
        bpy.ops.brume.render()
        self.stub(width=12, height=6)
        bpy.ops.brume.render()
        images = {image.name: image.size[0] for image in bpy.data.images if image.name.startswith("Brume")}
        self.assertEqual(images, {render.IMAGE_NAME: 12, render.PREVIOUS_NAME: 10})


class Film(AddonCase):
    def setUp(self):
        super().setUp()
        self.scene.frame_start, self.scene.frame_end = 10, 13
        self.scene.render.filepath = os.path.join(self.folder, "out", "shot_##_")

    def written(self):
        return sorted(os.listdir(os.path.join(self.folder, "out")))

    def test_images_have_the_names_that_blender_gives_them(self):
        folder = self.stub()
        bpy.ops.brume.film()
        self.assertEqual(self.written(), [f"shot_{frame}_.png" for frame in (10, 11, 12, 13)])
        self.assertEqual((self.option(folder, "--frames"), self.option(folder, "--fps")), ("0-3", "24"))

    def test_an_event_before_the_first_frame_shifts_the_frames_of_brume(self):
        folder = self.stub()
        self.event("BLAST", frame=4)
        bpy.ops.brume.film()
        self.assertEqual(self.option(folder, "--frames"), "6-9")
        self.assertEqual(len(self.written()), 4)

    def test_a_frame_step(self):
        self.scene.frame_step = 2
        folder = self.stub()
        bpy.ops.brume.film()
        self.assertEqual((self.option(folder, "--frames"), self.option(folder, "--fps")), ("0-1", "12"))
        self.assertEqual(self.written(), ["shot_10_.png", "shot_12_.png"])
        self.scene.frame_step = 5
        self.assertIn("frame step 5 does not divide 24", self.error_of(bpy.ops.brume.film))

    def test_other_formats_are_an_error(self):
        self.scene.render.image_settings.file_format = "JPEG"
        self.assertIn("Brume does not write JPEG; choose PNG or FFmpeg Video", self.error_of(bpy.ops.brume.film))

    def test_a_fractional_frame_rate_is_rounded_with_a_warning(self):
        self.scene.render.fps, self.scene.render.fps_base = 24, 1.001
        self.stub()
        bpy.ops.brume.film()
        self.assertSaid("the frame rate 23.976 becomes 24", "WARNING")

    def test_brume_renders_images_and_a_film(self):
        """With the program itself."""
        render_settings = self.scene.render
        render_settings.resolution_x, render_settings.resolution_y = 64, 48
        render_settings.resolution_percentage = 100
        self.scene.frame_end = 11
        bpy.ops.brume.film()
        image = bpy.data.images.load(os.path.join(self.folder, "out", "shot_11_.png"))
        self.assertEqual(tuple(image.size), (64, 48))
        render_settings.image_settings.file_format = "FFMPEG"
        render_settings.filepath = os.path.join(self.folder, "movie.mp4")
        bpy.ops.brume.film()
        clip = bpy.data.movieclips.load(os.path.join(self.folder, "movie.mp4"))
        self.assertEqual((tuple(clip.size), clip.frame_duration, clip.fps), ((64, 48), 2, 24))


class Stop(AddonCase):
    def test_a_program_that_ignores_requests_ends_at_once_with_its_children(self):
        mark = os.path.join(self.folder, "child")
        script = f"trap '' TERM INT; sleep 600 & echo $! > '{mark}.new'; mv '{mark}.new' '{mark}'; wait; wait"
        job = program.Job(["/bin/sh", "-c", script], self.folder)
        while not os.path.exists(mark):
            self.assertTrue(job.running())
        job.kill()
        job._child.wait(_HANG)
        self.assertEqual(job._child.returncode, -signal.SIGKILL)
        with open(mark, encoding="ascii") as file:
            child = int(file.read())
        while os.path.exists(f"/proc/{child}"):
            with open(f"/proc/{child}/stat", encoding="ascii") as file:
                if file.read().split()[2] == "Z":
                    break
