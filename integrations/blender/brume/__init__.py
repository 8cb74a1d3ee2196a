"""Brume for Blender: exports levels and timelines, and shows Brume's renderings.

An add-on for Blender 3.4 to 4.1 (bl_info) and an extension from 4.2 on (blender_manifest.toml).
"""

bl_info = {
    "name": "Brume",
    "description": "Exports levels for volumetric smoke and renders them with Brume",
    "author": "The Brume authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Brume, File > Export > Brume Level, Add > Brume",
    "category": "Import-Export",
}

from . import export_level, panels, preferences, properties, render, view, voxels  # noqa: E402

_MODULES = (preferences, properties, export_level, render, view, voxels, panels)


def register():
    for module in _MODULES:
        module.register()


def unregister():
    for module in reversed(_MODULES):
        module.unregister()
