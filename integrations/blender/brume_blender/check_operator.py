"""Check Scene: the messages of an export, without a file."""

import bpy

from . import export_level
from .messages import BrumeError, Message, Warnings, fail, show


class BRUME_OT_check(bpy.types.Operator):
    """Find grenades inside walls, shots that reach no smoke, and what Brume renders differently from Blender"""

    bl_idname = "brume.check"
    bl_label = "Check Scene"

    def execute(self, context):
        warnings = Warnings()
        try:
            export_level.check(context, warnings)
        except BrumeError as error:
            return fail(self, error, warnings.messages)
        warnings.report(self)
        if not warnings.messages:
            show([Message("INFO", "nothing found")])
            self.report({"INFO"}, "Check Scene: nothing found")
        return {"FINISHED"}


def register():
    bpy.utils.register_class(BRUME_OT_check)


def unregister():
    bpy.utils.unregister_class(BRUME_OT_check)
