"""Render with Brume: exports the scene, renders the current frame and shows the image in an Image Editor."""

import os

import bpy

from . import image_editor, samples
from .export_level import EXTENSIONS, export
from .job_operator import JobOperator
from .messages import BrumeError

IMAGE_NAME = "Brume Render"
PREVIOUS_NAME = "Brume Render (previous)"


def _take_image(path):
    """Packs the image, because its file is temporary. The one before it stays, for comparison."""
    image = bpy.data.images.load(path)
    image.pack()
    before, oldest = bpy.data.images.get(IMAGE_NAME), bpy.data.images.get(PREVIOUS_NAME)
    if before:
        # Editors that show an image go on to show the one of the same age.
        shown = [space for space in image_editor.spaces() if space.image == before]
        if oldest:
            oldest.user_remap(before)
            bpy.data.images.remove(oldest)
        before.name = PREVIOUS_NAME
        for space in shown:
            space.image = image
    image.name = IMAGE_NAME


class BRUME_OT_render(JobOperator, bpy.types.Operator):
    """Render the current frame with Brume"""

    bl_idname = "brume.render"
    bl_label = "Render with Brume"

    def arguments(self, context, folder):
        scene = context.scene
        options, frame = scene.brume, scene.frame_current_final
        level = os.path.join(folder, "level" + EXTENSIONS[options.format])
        written = export(context, level, options.format, self._warnings, frames=[frame])
        time = written.clock.seconds(frame)
        if time > 3600:
            raise BrumeError(f"frame {frame:g} is at {time:g} s; choose one in the first 3600 s")
        self._samples = samples.factor(scene)
        arguments = ["render", written.path, "-o", "render.png", "--time", f"{time:.6f}"]
        return arguments + ["--size", samples.size_argument(scene), "--march", options.march]

    def finish(self, _context, folder, _out):
        path = os.path.join(folder, "render.png")
        if not os.path.isfile(path):
            raise BrumeError("brume wrote no image; check the program path in the preferences")
        samples.reduce(path, self._samples)
        _take_image(path)
        if not bpy.app.background:
            image_editor.show(IMAGE_NAME, (IMAGE_NAME, PREVIOUS_NAME))


def register():
    bpy.utils.register_class(BRUME_OT_render)


def unregister():
    bpy.utils.unregister_class(BRUME_OT_render)
