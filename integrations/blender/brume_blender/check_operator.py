"""Check Scene: the checks of an export, without a file."""

import bpy

from . import checks
from .clock import Clock, events_of
from .level import Gathered
from .messages import BrumeError, Message, Warnings, fail, show
from .solids import Solids


class BRUME_OT_check(bpy.types.Operator):
    """Find grenades inside walls, shots that reach no smoke, and what Brume renders differently from Blender"""

    bl_idname = "brume.check"
    bl_label = "Check Scene"

    def execute(self, context):
        warnings = Warnings()
        try:
            with Gathered(context, warnings) as level:
                if not level.things and not level.volumes:
                    raise BrumeError("the scene has no visible mesh; add one that renders and is exported")
                solids = Solids(level)
                checks.check_level(level, solids, warnings)
                frames = [thing.brume_event.frame for thing in events_of(context.scene)]
                with Clock(context, frames) as clock:
                    checks.check_events(context.scene, level, solids, clock, warnings)
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
