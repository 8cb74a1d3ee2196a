"""Sizes and paths of events in the 3D view: balls of smokes and explosions, lines of throws, shots and words."""

import math

import bpy
from mathutils import Matrix, Vector

from . import checks, messages
from .clock import events_of
from .conversion import metres_per_unit, radius_of_voxels
from .kinds import KINDS

_SIDES = 48
# Mean width of the capitals of DejaVu Sans Bold, with their gaps, in heights of a capital.
_LETTER_WIDTH = 1.05


def _ring(center, a, b, sides=_SIDES):
    """A closed polygon around two half axes, as pairs of points."""
    angles = [2 * math.pi * i / sides for i in range(sides)]
    points = [center + a * math.cos(angle) + b * math.sin(angle) for angle in angles]
    return [point for i in range(sides) for point in (points[i], points[(i + 1) % sides])]


def _ball(center, radius):
    x, y, z = (Vector(axis) * radius for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
    return _ring(center, x, y) + _ring(center, y, z) + _ring(center, z, x)


def _across(along, roll):
    """Right and up of a cross-section, seen by the shooter; the roll is clockwise."""
    right = along.cross(Vector((0, 0, 1)))
    right = right.normalized() if right.length > 1e-6 else Vector((1, 0, 0))
    turn = Matrix.Rotation(roll, 3, along)
    return turn @ right, turn @ right.cross(along)


def _section(event, center, along, metres):
    """The outline of a hole or of a row of letters."""
    right, up = _across(along, event.roll)
    if event.type == "WORD":
        height = event.size / metres
        width = height * max(1, len(event.text)) * (_LETTER_WIDTH + event.spacing)
        right, up = right * width / 2, up * height / 2
    else:
        right, up = right * event.radius / metres, up * event.radius / metres
        if event.shape == "CYLINDER":
            return _ring(center, right, up, 24)
    corners = [center + right * x + up * y for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return [corner for i in range(4) for corner in (corners[i], corners[(i + 1) % 4])]


def _checked_end(thing):
    """Where the last check found the end of a throw or shot, unless the empty has moved since."""
    matrix, point = checks.ends.get(thing.name, (None, None))
    return point if matrix is not None and matrix == thing.matrix_world else None


def lines(scene, thing):
    """What is drawn for an event: pairs of world-space points, in Blender units."""
    event, metres = thing.brume_event, metres_per_unit(scene)
    here, end = thing.matrix_world.translation.copy(), _checked_end(thing)
    if event.type == "SMOKE":
        center = end or here
        radius = radius_of_voxels(scene.brume.smoke_voxels, scene.brume.voxel) / metres
        start = event.thrown_from.matrix_world.translation if event.thrown_from else here
        return _ball(center, radius) + [start, here, here, center]
    if KINDS[event.type].ball:
        return _ball(here, getattr(event, KINDS[event.type].ball) / metres)
    if event.type == "DOOR":
        return [here, event.door.matrix_world.translation] if event.door else []
    target = here + thing.matrix_world.col[2].to_3d().normalized() * (10 / metres)
    if event.aim:
        target = event.aim.matrix_world.translation
    along = target - here
    if along.length < 1e-6:
        return []
    along.normalize()
    end = end or target
    found = [here, end] + _section(event, end, along, metres)
    if event.aim:
        found += _section(event, target, along, metres)
    return found


def label(scene, thing):
    """What stands beside an event: its name, and its size or what the last check found."""
    event = thing.brume_event
    found = [message.text for message in messages.last() if message.thing == thing.name]
    if found and _checked_end(thing) is not None:
        return found[0]
    if event.type == "SMOKE":
        radius = radius_of_voxels(scene.brume.smoke_voxels, scene.brume.voxel)
    elif KINDS[event.type].ball:
        radius = getattr(event, KINDS[event.type].ball)
    else:
        return thing.name
    size = bpy.utils.units.to_string(scene.unit_settings.system, "LENGTH", radius, precision=3)
    return f"{thing.name}: radius {size}"


def _shown(context):
    """The events that the view shows."""
    scene = context.scene
    if not scene.brume.gizmos or not context.space_data.overlay.show_overlays:
        return []
    return [thing for thing in events_of(scene) if thing.visible_get()]


def _draw_lines():
    import gpu  # Fails without a window.
    from gpu_extras.batch import batch_for_shader

    context = bpy.context
    names = ("UNIFORM_COLOR",) if bpy.app.version >= (4, 0, 0) else ("3D_UNIFORM_COLOR",)
    shader = gpu.shader.from_builtin(*names)
    gpu.state.blend_set("ALPHA")
    for thing in _shown(context):
        points = lines(context.scene, thing)
        if not points:
            continue
        batch = batch_for_shader(shader, "LINES", {"pos": [tuple(point) for point in points]})
        chosen = thing.select_get()
        gpu.state.line_width_set(2.0 if chosen else 1.0)
        # Faint where something is in front.
        for depth_test, alpha in (("NONE", 0.15), ("LESS_EQUAL", 1.0 if chosen else 0.5)):
            gpu.state.depth_test_set(depth_test)
            shader.bind()
            shader.uniform_float("color", (*KINDS[thing.brume_event.type].color, alpha))
            batch.draw(shader)
    gpu.state.line_width_set(1.0)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def _draw_labels():
    import blf
    from bpy_extras.view3d_utils import location_3d_to_region_2d

    context = bpy.context
    preferences = context.preferences
    size = 11 * preferences.system.ui_scale
    for thing in _shown(context):
        if not thing.select_get():
            continue
        place = location_3d_to_region_2d(context.region, context.region_data, thing.matrix_world.translation)
        if place is None:
            continue
        if bpy.app.version >= (4, 0, 0):
            blf.size(0, size)
        else:
            blf.size(0, round(size), 72)
        blf.color(0, *KINDS[thing.brume_event.type].color, 1.0)
        blf.position(0, place.x + 12, place.y + 8, 0)
        blf.draw(0, label(context.scene, thing))


_handlers = []


def register():
    if bpy.app.background:
        return
    add = bpy.types.SpaceView3D.draw_handler_add
    _handlers.append(add(_draw_lines, (), "WINDOW", "POST_VIEW"))
    _handlers.append(add(_draw_labels, (), "WINDOW", "POST_PIXEL"))


def unregister():
    while _handlers:
        bpy.types.SpaceView3D.draw_handler_remove(_handlers.pop(), "WINDOW")
