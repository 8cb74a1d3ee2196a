"""Properties that the add-on stores in a .blend file: roles of objects, events, and settings of the scene.

Names, defaults and ranges match docs/timeline.md.
"""

import math

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

HOLE_TIMES = ("reach", "expand", "stay", "fade")

ROLES = (
    ("SOLID", "Solid", "Rendered and blocks smoke"),
    ("PASSABLE", "Ignored by smoke", "Rendered, but smoke passes through it"),
    ("DOOR", "Door", "Opens and closes together with its children"),
    ("LEFT_OUT", "Not exported", "Ignored by Brume"),
)

EVENTS = (
    ("NONE", "None", "An ordinary empty"),
    ("SMOKE", "Smoke grenade", "A grenade goes off here"),
    ("SHOT", "Shot", "A shot is fired from here along the arrow"),
    ("TEXT", "Text", "Letters are shot from here along the arrow"),
    ("BLAST", "Blast", "An explosion"),
    ("DOOR", "Door event", "A door opens or closes"),
)


def _seconds(name, default, most, what, least=0.0):
    return FloatProperty(name=name, default=default, min=least, max=most, description=what + " [s]")


def _metres(name, default, least, most, what):
    return FloatProperty(name=name, default=default, min=least, max=most, description=what + " [m]")


class BrumeObject(bpy.types.PropertyGroup):
    role: EnumProperty(items=ROLES, name="Role", description="How Brume treats this object")


class BrumeEvent(bpy.types.PropertyGroup):
    type: EnumProperty(items=EVENTS, name="Event", description="Event at this empty")
    time: _seconds("Time", 1.0, 3600.0, "Time of the event, from the first frame of the scene")
    thrown_from: PointerProperty(
        type=bpy.types.Object,
        name="Thrown From",
        description="Position of the thrower; empty: the grenade goes off here",
    )
    aim: PointerProperty(
        type=bpy.types.Object, name="Aim", description="Target that the shot passes through; empty: along the arrow"
    )
    radius: _metres("Radius", 0.25, 0.01, 10.0, "Radius of the hole, half the edge of a box or mask")
    shape: EnumProperty(
        items=(
            ("CYLINDER", "Cylinder", "A round hole"),
            ("BOX", "Box", "A square hole"),
            ("MASK", "Mask", "A hole in the shape of an image: white removes all smoke"),
        ),
        name="Shape",
        description="Cross-section of the hole",
    )
    mask: StringProperty(name="Mask", description="Image of the cross-section", subtype="FILE_PATH")
    roll: FloatProperty(
        name="Roll",
        description="Rotates a box, mask or text clockwise as seen by the shooter",
        min=-2 * math.pi,
        max=2 * math.pi,
        subtype="ANGLE",
    )
    flash: FloatProperty(
        name="Flash", default=25.0, min=0.0, max=1e6, description="Intensity of the muzzle flash (0.06 s) [W/sr]"
    )
    reach: _seconds("Reach", 0.25, 60.0, "Time until the hole reaches the far end")
    expand: _seconds("Expand", 0.05, 60.0, "Time to open at each depth")
    stay: _seconds("Stay", 0.6, 600.0, "Time open")
    fade: _seconds("Fade", 0.35, 60.0, "Time to close")
    text: StringProperty(name="Text", description="One line of letters", default="SMOKE")
    size: _metres("Size", 0.5, 0.02, 10.0, "Height of a capital letter")
    font: StringProperty(name="Font", description="Font file; empty: DejaVu Sans Bold", subtype="FILE_PATH")
    spacing: FloatProperty(
        name="Spacing", default=0.0, min=-0.5, max=10.0, description="Extra space between letters, in capital heights"
    )
    interval: _seconds("Interval", 0.0, 10.0, "Time between letters")
    blast_radius: FloatProperty(
        name="Radius", default=5.0, min=0.1, max=100.0, description="Radius of the cavity [m]"
    )
    blast_flash: FloatProperty(
        name="Flash", default=250.0, min=0.0, max=1e6, description="Intensity of the fireball, which lasts 0.3 s [W/sr]"
    )
    speed: FloatProperty(name="Speed", default=32.0, min=1.0, max=10000.0, description="Speed of the front [m/s]")
    remaining: FloatProperty(
        name="Remaining", default=0.02, min=0.0, max=1.0, description="Fraction of the density that remains"
    )
    refill_rim: _seconds("Refill Rim", 0.5, 60.0, "Time until the rim is refilled", least=0.01)
    refill_middle: _seconds("Refill Middle", 5.0, 60.0, "Time until the middle is refilled", least=0.01)
    door: PointerProperty(
        type=bpy.types.Object, name="Door", description="The door to open or close; its role must be Door"
    )
    open: BoolProperty(name="Open", default=True, description="Opens the door; otherwise closes it")


class BrumeScene(bpy.types.PropertyGroup):
    format: EnumProperty(
        items=(
            ("GLTF", "glTF", "One .glb file: all lights, materials and the camera"),
            ("TXT", "Scene.txt", "Scene.txt with OBJ meshes and textures: point lights, plain materials"),
        ),
        name="Format",
        description="Intermediate format for rendering and voxelizing",
    )
    voxel: FloatProperty(name="Voxel", default=0.25, min=1 / 64, max=10.0, description="Edge of a voxel [m]")
    smoke_voxels: IntProperty(
        name="Smoke", default=1800, min=1, max=16777216, description="Volume of a fully grown smoke [voxels]"
    )
    smoke_bloom: FloatProperty(
        name="Bloom", default=1.0, min=0.05, max=60.0, description="Time from detonation to full size [s]"
    )
    smoke_hold: FloatProperty(
        name="Hold", default=18.0, min=0.0, max=3600.0, description="Time at full size [s]"
    )
    smoke_dissolve: FloatProperty(
        name="Dissolve", default=3.0, min=0.05, max=60.0, description="Time to dissolve completely [s]"
    )
    smoke_extinction: FloatProperty(
        name="Extinction", default=3.0, min=0.01, max=100.0, description="Extinction coefficient of dense smoke [1/m]"
    )
    sky: EnumProperty(
        items=(
            ("BRUME", "Brume's Daylight", "Brume's own sky"),
            ("WORLD", "World", "The colour of Blender's world in all directions"),
        ),
        name="Sky",
        description="Light from the sky",
    )
    march: EnumProperty(
        items=(
            ("full", "Full", "One smoke ray per pixel"),
            ("half", "Half", "One smoke ray per 2x2 pixels"),
            ("quarter", "Quarter", "One smoke ray per 4x4 pixels"),
        ),
        name="March",
        description="Resolution of the smoke",
    )


_CLASSES = (BrumeObject, BrumeEvent, BrumeScene)


def register():
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.brume = PointerProperty(type=BrumeObject)
    bpy.types.Object.brume_event = PointerProperty(type=BrumeEvent)
    bpy.types.Scene.brume = PointerProperty(type=BrumeScene)


def unregister():
    del bpy.types.Scene.brume
    del bpy.types.Object.brume_event
    del bpy.types.Object.brume
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
