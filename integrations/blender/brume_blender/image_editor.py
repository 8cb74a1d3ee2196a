"""Shows images in Image Editors."""

import functools

import bpy


def spaces():
    """Of all Image Editors."""
    areas = (area for window in bpy.context.window_manager.windows for area in window.screen.areas)
    return [area.spaces.active for area in areas if area.type == "IMAGE_EDITOR"]


def _show(name, enough):
    image = bpy.data.images.get(name)
    place = bpy.context.preferences.view.render_display_type
    found = spaces()
    if not found and place != "NONE":
        window = bpy.context.window_manager.windows[0]
        if place == "WINDOW":
            with bpy.context.temp_override(window=window):
                bpy.ops.wm.window_new()
            area = bpy.context.window_manager.windows[-1].screen.areas[0]
        else:
            areas = [area for area in window.screen.areas if area.type != "VIEW_3D"] or list(window.screen.areas)
            area = max(areas, key=lambda area: area.width * area.height)
        area.type = "IMAGE_EDITOR"
        found = [area.spaces.active]
    # An editor with another image, such as a texture, keeps it if one shows renders already.
    showing = [space for space in found if space.image and space.image.name in enough]
    for space in [] if showing else found[:1]:
        space.image = image


def show(name, enough):
    """Shows an image in an Image Editor, unless one shows an image of the names `enough`; without an editor, where the
    preferences place renders. Waits for a timer, because a modal operator that opens a window does not end."""
    bpy.app.timers.register(functools.partial(_show, name, enough), first_interval=0)
