"""Walk In: exports the scene and opens it in the Brume viewer."""

import os

import bpy
from bpy.props import BoolProperty

from .export_level import EXTENSIONS, export
from .job_operator import JobOperator


class BRUME_OT_view(JobOperator, bpy.types.Operator):
    """Walk through the scene in the Brume viewer, throw smoke and shoot through it"""

    bl_idname = "brume.view"
    bl_label = "Walk In"

    play: BoolProperty(name="Play", description="Play the events of the scene, viewed by its camera")

    # The viewer has its own window, so Esc in Blender must not stop it.
    stopped_by_escape = False

    def arguments(self, context, folder):
        file_format = context.scene.brume.format
        level = os.path.join(folder, "level" + EXTENSIONS[file_format])
        written = export(context, level, file_format, self._warnings).path
        # Screenshots and recordings outlive the exported level.
        keep = os.path.dirname(bpy.data.filepath) or os.path.expanduser("~")
        return ["view"] + (["--play"] if self.play else []) + [written, "--folder", keep]

    def finish(self, _context, _folder, _out):
        """The viewer returns no result."""


def register():
    bpy.utils.register_class(BRUME_OT_view)


def unregister():
    bpy.utils.unregister_class(BRUME_OT_view)
