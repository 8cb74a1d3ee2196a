"""Render with Brume: exports the scene, renders the current frame and shows the image in an Image Editor."""

import os

import bpy

from . import timeline
from .export_level import EXTENSIONS, export
from .job_operator import JobOperator
from .messages import BrumeError

IMAGE_NAME = "Brume Render"


def _take_image(path):
    """Replaces the image of the previous render; packs the new one, because its file is temporary."""
    before = bpy.data.images.get(IMAGE_NAME)
    image = bpy.data.images.load(path)
    image.pack()
    if before:
        before.user_remap(image)
        bpy.data.images.remove(before)
    image.name = IMAGE_NAME


def _show():
    """Shows the image in all open Image Editors, or in a new window. Called by a timer, because a modal operator
    that opens a window does not end."""
    image = bpy.data.images.get(IMAGE_NAME)
    windows = bpy.context.window_manager.windows
    editors = [area for window in windows for area in window.screen.areas if area.type == "IMAGE_EDITOR"]
    if not editors:
        with bpy.context.temp_override(window=windows[0]):
            bpy.ops.wm.window_new()
        area = windows[-1].screen.areas[0]
        area.type = "IMAGE_EDITOR"
        editors = [area]
    for area in editors:
        area.spaces.active.image = image


class BRUME_OT_render(JobOperator, bpy.types.Operator):
    """Render the current frame with Brume"""

    bl_idname = "brume.render"
    bl_label = "Render with Brume"

    def arguments(self, context, folder):
        scene = context.scene
        options, render = scene.brume, scene.render
        level = os.path.join(folder, "level" + EXTENSIONS[options.format])
        written = export(context, level, options.format, self._warnings)
        time = timeline.seconds(scene, scene.frame_current_final)
        if not 0 <= time <= 3600:
            raise BrumeError(f"frame {scene.frame_current} is at {time:g} s; choose one between 0 and 3600 s")
        width, height = (
            max(1, side * render.resolution_percentage // 100) for side in (render.resolution_x, render.resolution_y)
        )
        return ["render", written, "-o", "render.png", "--time", f"{time:.6f}", "--size", f"{width}x{height}"] + [
            "--march",
            options.march,
        ]

    def finish(self, _context, folder, _out):
        path = os.path.join(folder, "render.png")
        if not os.path.isfile(path):
            raise BrumeError("brume wrote no image; check the program path in the preferences")
        _take_image(path)
        if not bpy.app.background:
            bpy.app.timers.register(_show, first_interval=0)


def register():
    bpy.utils.register_class(BRUME_OT_render)


def unregister():
    bpy.utils.unregister_class(BRUME_OT_render)
