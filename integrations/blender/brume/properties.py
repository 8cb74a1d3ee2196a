"""What the add-on keeps in a .blend file: what objects are to Brume, what happens when, how it is rendered.

Names, defaults and ranges are those of docs/timeline.md.
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
    ("SOLID", "Solid", "Drawn, and smoke stops at it"),
    ("PASSABLE", "Ignored by smoke", "Drawn, but smoke passes through it"),
    ("DOOR", "Door", "Opens and shuts as one, with what is parented to it"),
    ("LEFT_OUT", "Left out", "Not exported"),
)

EVENTS = (
    ("NONE", "None", "An empty like any other"),
    ("SMOKE", "Smoke grenade", "A grenade goes off here"),
    ("SHOT", "Shot", "A shot is fired from here along the arrow"),
    ("TEXT", "Text", "Letters are shot from here along the arrow"),
    ("BLAST", "Blast", "An explosion"),
    ("DOOR", "Door event", "A door opens or shuts"),
)


def _seconds(name, default, most, what, least=0.0):
    return FloatProperty(name=name, default=default, min=least, max=most, description=what + " [s]")


def _metres(name, default, least, most, what):
    return FloatProperty(name=name, default=default, min=least, max=most, description=what + " [m]")


class BrumeObject(bpy.types.PropertyGroup):
    role: EnumProperty(items=ROLES, name="Role", description="What this object is to Brume")


class BrumeEvent(bpy.types.PropertyGroup):
    type: EnumProperty(items=EVENTS, name="Event", description="What happens at this empty")
    time: _seconds("Time", 1.0, 3600.0, "When it happens, from the scene's first frame")
    thrown_from: PointerProperty(
        type=bpy.types.Object, name="Thrown From", description="Where the grenade is thrown; nothing: it goes off here"
    )
    aim: PointerProperty(
        type=bpy.types.Object, name="Aim", description="What the shot passes through; nothing: along the arrow"
    )
    radius: _metres("Radius", 0.25, 0.01, 10.0, "Radius of the hole, half the edge of a box or mask")
    shape: EnumProperty(
        items=(
            ("CYLINDER", "Cylinder", "A round hole"),
            ("BOX", "Box", "A square hole"),
            ("MASK", "Mask", "A hole in the shape of a picture: white takes all smoke away"),
        ),
        name="Shape",
        description="Cross-section of the hole",
    )
    mask: StringProperty(name="Mask", description="Picture of the cross-section", subtype="FILE_PATH")
    roll: FloatProperty(
        name="Roll",
        description="Turns a box, mask or text clockwise as the shooter sees it",
        min=-2 * math.pi,
        max=2 * math.pi,
        subtype="ANGLE",
    )
    flash: FloatProperty(
        name="Flash", default=25.0, min=0.0, max=1e6, description="Of the muzzle: light for 0.06 s [W/sr]"
    )
    reach: _seconds("Reach", 0.25, 60.0, "The front's way to the far end")
    expand: _seconds("Expand", 0.05, 60.0, "Opening at each depth")
    stay: _seconds("Stay", 0.6, 600.0, "Open")
    fade: _seconds("Fade", 0.35, 60.0, "Closing")
    text: StringProperty(name="Text", description="One line of letters", default="SMOKE")
    size: _metres("Size", 0.5, 0.02, 10.0, "Height of a capital letter")
    font: StringProperty(name="Font", description="A font file; nothing: DejaVu Sans Bold", subtype="FILE_PATH")
    spacing: FloatProperty(
        name="Spacing", default=0.0, min=-0.5, max=10.0, description="More room between letters, in capital heights"
    )
    interval: _seconds("Interval", 0.0, 10.0, "From letter to letter")
    blast_radius: FloatProperty(
        name="Radius", default=5.0, min=0.1, max=100.0, description="Of the cavity that it opens [m]"
    )
    blast_flash: FloatProperty(
        name="Flash", default=250.0, min=0.0, max=1e6, description="Of the fire: light for 0.3 s [W/sr]"
    )
    speed: FloatProperty(name="Speed", default=32.0, min=1.0, max=10000.0, description="Of the front [m/s]")
    remaining: FloatProperty(
        name="Remaining", default=0.02, min=0.0, max=1.0, description="Fraction of the density that remains"
    )
    refill_rim: _seconds("Refill Rim", 0.5, 60.0, "Until the rim is full again", least=0.01)
    refill_middle: _seconds("Refill Middle", 5.0, 60.0, "Until the middle is full; no less than the rim", least=0.01)
    door: PointerProperty(
        type=bpy.types.Object, name="Door", description="The door that opens or shuts; its role is Door"
    )
    open: BoolProperty(name="Open", default=True, description="Whether the door opens; else it shuts")


class BrumeScene(bpy.types.PropertyGroup):
    format: EnumProperty(
        items=(
            ("GLTF", "glTF", "One .glb file: all lights, materials and the camera"),
            ("TXT", "Scene.txt", "Scene.txt with OBJ meshes and textures: point lights, plain materials"),
        ),
        name="Format",
        description="What renders and voxels go through",
    )
    voxel: FloatProperty(name="Voxel", default=0.25, min=1 / 64, max=10.0, description="Edge of a voxel [m]")
    smoke_voxels: IntProperty(
        name="Smoke", default=1800, min=1, max=16777216, description="How many voxels a grown smoke fills"
    )
    smoke_bloom: FloatProperty(
        name="Bloom", default=1.0, min=0.05, max=60.0, description="From going off to full size [s]"
    )
    smoke_hold: FloatProperty(
        name="Hold", default=18.0, min=0.0, max=3600.0, description="From there until it begins to dissolve [s]"
    )
    smoke_dissolve: FloatProperty(
        name="Dissolve", default=3.0, min=0.05, max=60.0, description="From there until nothing is left [s]"
    )
    smoke_extinction: FloatProperty(
        name="Extinction", default=3.0, min=0.01, max=100.0, description="In dense smoke [1/m]"
    )
    sky: EnumProperty(
        items=(
            ("BRUME", "Brume's Daylight", "Brume's own sky"),
            ("WORLD", "World", "The colour of Blender's world on all sides"),
        ),
        name="Sky",
        description="What light comes from everywhere",
    )
    march: EnumProperty(
        items=(
            ("full", "Full", "A ray of the smoke for each pixel"),
            ("half", "Half", "A ray for 2x2 pixels"),
            ("quarter", "Quarter", "A ray for 4x4 pixels"),
        ),
        name="March",
        description="Rays of the smoke",
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
