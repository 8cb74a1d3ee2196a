"""Add-on preferences: the path of the brume program."""

import bpy
from bpy.props import StringProperty


class BrumePreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(
        name="brume", description="Path of the brume program; empty: search PATH", subtype="FILE_PATH"
    )

    def draw(self, _context):
        self.layout.prop(self, "program")


def program_path(context):
    addon = context.preferences.addons.get(__package__)
    return addon.preferences.program if addon else ""


def register():
    bpy.utils.register_class(BrumePreferences)


def unregister():
    bpy.utils.unregister_class(BrumePreferences)
