"""Presets: settings of an event that belong together."""

import bpy
from bpy.props import StringProperty

from .conversion import metres_per_unit
from .kinds import KINDS

# Kind of event: name: settings.
PRESETS = {identifier: kind.presets for identifier, kind in KINDS.items() if kind.presets}


def apply(scene, event, name):
    """Sets all settings of a preset."""
    for setting, value in PRESETS[event.type][name].items():
        if event.type != "SMOKE":
            setattr(event, setting, value)
        elif setting == "radius":
            scene.brume.smoke_radius = value / metres_per_unit(scene)
        else:
            setattr(scene.brume, setting, value)


class BRUME_OT_preset(bpy.types.Operator):
    """Use the settings of a preset"""

    bl_idname = "brume.preset"
    bl_label = "Use Preset"
    bl_options = {"REGISTER", "UNDO"}

    name: StringProperty(name="Preset")

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.brume_event.type in PRESETS

    def execute(self, context):
        event = context.object.brume_event
        if self.name not in PRESETS[event.type]:
            self.report({"ERROR"}, f'no preset "{self.name}"; choose one of {", ".join(PRESETS[event.type])}')
            return {"CANCELLED"}
        apply(context.scene, event, self.name)
        return {"FINISHED"}


class BRUME_MT_presets(bpy.types.Menu):
    bl_idname = "BRUME_MT_presets"
    bl_label = "Presets"

    def draw(self, context):
        for name in PRESETS.get(context.object.brume_event.type, ()):
            self.layout.operator(BRUME_OT_preset.bl_idname, text=name).name = name


def register():
    bpy.utils.register_class(BRUME_OT_preset)
    bpy.utils.register_class(BRUME_MT_presets)


def unregister():
    bpy.utils.unregister_class(BRUME_MT_presets)
    bpy.utils.unregister_class(BRUME_OT_preset)
