"""Presets: settings of smokes, shots, words and blasts that belong together."""

import bpy
from bpy.props import StringProperty

from .conversion import metres_per_unit

# Kind of event: name: settings. Those of smokes are settings of the scene, with the radius in metres.
PRESETS = {
    "SMOKE": {
        "Small Screen": {"radius": 1.5, "smoke_bloom": 0.8, "smoke_hold": 10.0, "smoke_extinction": 3.0},
        "Room": {"radius": 2.0, "smoke_bloom": 1.0, "smoke_hold": 18.0, "smoke_extinction": 3.0},
        "Wide Smoke": {"radius": 4.0, "smoke_bloom": 2.5, "smoke_hold": 25.0, "smoke_extinction": 3.0},
        "Thin Haze": {"radius": 4.0, "smoke_bloom": 4.0, "smoke_hold": 30.0, "smoke_extinction": 0.5},
    },
    "SHOT": {
        "Pistol": {"shape": "CYLINDER", "radius": 0.1, "reach": 0.25, "stay": 0.3, "flash": 12.0},
        "Rifle": {"shape": "CYLINDER", "radius": 0.25, "reach": 0.25, "stay": 0.6, "flash": 25.0},
        "Shotgun": {"shape": "CYLINDER", "radius": 0.6, "reach": 0.3, "stay": 1.0, "flash": 60.0},
        "Window": {"shape": "BOX", "radius": 0.7, "reach": 0.1, "stay": 5.0, "flash": 0.0},
    },
    "WORD": {
        "At Once": {"interval": 0.0, "stay": 2.0, "size": 0.5},
        "Letter by Letter": {"interval": 0.15, "stay": 3.0, "size": 0.5},
    },
    "BLAST": {
        "Flashbang": {"blast_radius": 2.0, "blast_flash": 800.0, "remaining": 0.3},
        "Grenade": {"blast_radius": 5.0, "blast_flash": 250.0, "remaining": 0.02},
        "Big Blast": {"blast_radius": 10.0, "blast_flash": 1500.0, "remaining": 0.0},
    },
}


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
