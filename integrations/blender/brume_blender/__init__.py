"""Brume for Blender: exports levels and timelines, shows Brume's renderings, and bakes meshes into slice atlases.

An add-on for Blender 3.4 to 4.1 (bl_info) and an extension from 4.2 on (blender_manifest.toml).
"""

bl_info = {
    "name": "Brume",
    "description": "Exports levels for volumetric smoke and renders them with Brume",
    "author": "The Brume authors",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Brume, File > Export > Brume Level, Add > Brume",
    "category": "Import-Export",
}

from . import (  # noqa: E402
    bake,
    check_operator,
    event_operators,
    export_level,
    film,
    gizmos,
    import_timeline,
    markers,
    panels,
    preferences,
    presets,
    properties,
    render,
    view,
    voxels,
)

_MODULES = (
    preferences,
    properties,
    presets,
    event_operators,
    export_level,
    import_timeline,
    check_operator,
    render,
    film,
    view,
    voxels,
    bake,
    markers,
    gizmos,
    panels,
)


def register():
    for module in _MODULES:
        module.register()


def unregister():
    for module in reversed(_MODULES):
        module.unregister()
