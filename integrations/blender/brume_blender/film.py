"""Render Film: the frame range of the scene, to the output path of the scene."""

import os
import shutil

import bpy

from . import samples
from .clock import frames_per_second
from .export_level import EXTENSIONS, export
from .job_operator import JobOperator
from .messages import BrumeError

_MOVIE = "film.mp4"
_IMAGE = "image_%06d.png"


def _rate(scene, warnings):
    """Whole frames per second, and how many Blender frames one of them is."""
    exact = frames_per_second(scene)
    rate = max(1, round(exact))
    if abs(rate - exact) > 1e-6:
        warnings.add(f"the frame rate {exact:g} becomes {rate} in the film; Brume renders whole rates")
    if rate % scene.frame_step:
        raise BrumeError(f"the frame step {scene.frame_step} does not divide {rate} frames per second; change it")
    return rate // scene.frame_step


def _movie_path(scene):
    """The output path; Blender appends the frame range and the extension of the container if it has no .mp4."""
    path = scene.render.filepath
    if path.lower().endswith(".mp4"):
        return path
    return os.path.splitext(scene.render.frame_path(frame=scene.frame_start))[0] + ".mp4"


class BRUME_OT_film(JobOperator, bpy.types.Operator):
    """Render the frame range of the scene to its output path: PNG images, or an .mp4 film for FFmpeg Video"""

    bl_idname = "brume.film"
    bl_label = "Render Film"

    def arguments(self, context, folder):
        scene = context.scene
        options, output = scene.brume, scene.render.image_settings.file_format
        if output not in {"PNG", "FFMPEG"}:
            raise BrumeError(f"Brume does not write {output}; choose PNG or FFmpeg Video in Output Properties")
        rate = _rate(scene, self._warnings)
        self._is_movie, self._samples = output == "FFMPEG", samples.factor(scene)
        if self._is_movie and self._samples > 1:
            self._warnings.add("an .mp4 film has one sample per pixel; choose PNG in Output Properties for more")
        level = os.path.join(folder, "level" + EXTENSIONS[options.format])
        written = export(context, level, options.format, self._warnings)
        # Frame numbers of brume begin at second 0, which may be an event before the first frame.
        first = round(written.clock.seconds(scene.frame_start) * rate)
        frames = range(scene.frame_start, scene.frame_end + 1, scene.frame_step)
        last = first + len(frames) - 1
        self._count, self._targets = len(frames), {}
        if self._is_movie:
            self._targets[_MOVIE] = bpy.path.abspath(_movie_path(scene))
        else:
            for number, frame in enumerate(frames, first):
                self._targets[_IMAGE % number] = bpy.path.abspath(scene.render.frame_path(frame=frame))
        self._last_target = list(self._targets.values())[-1]
        size = "x".join(str(side) for side in samples.size(scene)) if self._is_movie else samples.size_argument(scene)
        arguments = ["render", written.path, "-o", _MOVIE if self._is_movie else _IMAGE]
        arguments += ["--frames", f"{first}-{last}", "--fps", str(rate)]
        return arguments + ["--size", size, "--march", options.march]

    def _move_finished(self, folder):
        """Moves images to the output path; brume writes each under its name only when it is complete."""
        for name, target in list(self._targets.items()):
            path = os.path.join(folder, name)
            if not os.path.isfile(path):
                continue
            try:
                if not self._is_movie:
                    samples.reduce(path, self._samples)
                os.makedirs(os.path.dirname(target) or ".", exist_ok=True)
                shutil.move(path, target)
            except OSError as error:
                raise BrumeError(f"{target}: cannot be written: {error.strerror or error}") from error
            del self._targets[name]

    def progress(self, folder):
        if self._is_movie:
            return super().progress(folder)
        self._move_finished(folder)
        done = self._count - len(self._targets)
        return f"{done} of {self._count} images ({100 * done // self._count} %)"

    def stopped(self, folder):
        if self._is_movie:
            return self.bl_label + ": stopped; no film is written"
        self._move_finished(folder)
        return f"{self.bl_label}: stopped; {self._count - len(self._targets)} of {self._count} images are written"

    def finish(self, _context, folder, _out):
        self._move_finished(folder)
        if self._targets:
            raise BrumeError(f"brume wrote {self._count - len(self._targets)} of {self._count} files")
        what = self._last_target if self._is_movie else f"{self._count} images, the last {self._last_target}"
        self.report({"INFO"}, f"Wrote {what}")


def _menu(self, _context):
    self.layout.separator()
    self.layout.operator("brume.render", icon="RENDER_STILL")
    self.layout.operator(BRUME_OT_film.bl_idname, text="Render Film with Brume", icon="RENDER_ANIMATION")


def register():
    bpy.utils.register_class(BRUME_OT_film)
    bpy.types.TOPBAR_MT_render.append(_menu)


def unregister():
    bpy.types.TOPBAR_MT_render.remove(_menu)
    bpy.utils.unregister_class(BRUME_OT_film)
