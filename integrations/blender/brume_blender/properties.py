"""Properties that the add-on stores in a .blend file: roles of objects, events, and settings of the scene.

Names, defaults and ranges: docs/guides/timelines.md. Lengths are stored in metres; panels show the property with the
prefix `shown_`, which is in the units of the scene. No property is animatable, because timelines have no keys for them.
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

from .clock import frames_per_second
from .conversion import metres_per_unit, radius_of_voxels, voxels_of_radius

HOLE_TIMES = ("reach", "expand", "stay", "fade")

# Identifier, name, description, number in .blend files.
ROLES = (
    ("SOLID", "Solid", "Stops what its material does not let pass", 0),
    ("WALL", "Wall", "Stops everything, whatever its material", 4),
    ("GLASS", "Glass", "Stops smoke, shots and bodies; sight passes", 5),
    ("GRILLE", "Grille", "Stops only bodies and thrown grenades: a fence, leaves", 6),
    ("PASSABLE", "Ghost", "Rendered, but stops nothing", 1),
    ("DOOR", "Door", "Opens and closes together with its children", 2),
    ("LEFT_OUT", "Not exported", "Ignored by Brume", 3),
)
# What Brume calls those that decide for their objects, the one that stops least first.
BRUME_ROLES = {"PASSABLE": "ghost", "GRILLE": "grille", "GLASS": "glass", "WALL": "wall"}

# Identifier, name, description, number in .blend files, which have no identifiers.
EVENTS = (
    ("NONE", "None", "An ordinary empty", 0),
    ("SMOKE", "Smoke Grenade", "A grenade goes off here", 1),
    ("SHOT", "Shot", "A shot is fired from here along the arrow", 2),
    ("WORD", "Word", "Letters are shot from here along the arrow", 3),
    ("BLAST", "Blast", "An explosion", 4),
    ("DOOR", "Door Event", "A door opens or closes", 5),
)

_FIXED = set()  # Options of a property without keyframes.


def _seconds(name, default, most, what, least=0.0):
    return FloatProperty(
        name=name, default=default, min=least, max=most, description=what, unit="TIME_ABSOLUTE", options=_FIXED
    )


def _plain(name, default, least, most, what, **more):
    return FloatProperty(name=name, default=default, min=least, max=most, description=what, options=_FIXED, **more)


def _scene_of(group):
    return group.id_data if isinstance(group.id_data, bpy.types.Scene) else bpy.context.scene


def _show(cls, units):
    """Adds `shown_NAME` for each property NAME in metres: the same value in Blender units, so that Blender formats and
    parses it in the unit of the scene."""

    def add(name, unit):
        stored = cls.__annotations__[name].keywords

        def read(self):
            return getattr(self, name) / metres_per_unit(_scene_of(self))

        def write(self, value):
            setattr(self, name, value * metres_per_unit(_scene_of(self)))

        cls.__annotations__["shown_" + name] = FloatProperty(
            name=stored["name"], description=stored["description"], unit=unit, get=read, set=write, options=_FIXED
        )

    for name, unit in units.items():
        add(name, unit)


class BrumeObject(bpy.types.PropertyGroup):
    role: EnumProperty(items=ROLES, name="Role", description="How Brume treats this object", options=_FIXED)


def _read_frame(self):
    if "at_frame" in self:
        return self["at_frame"]
    # Files of older versions store seconds from the first frame.
    scene = _scene_of(self)
    return scene.frame_start + self.get("time", 1.0) * frames_per_second(scene)


def _write_frame(self, frame):
    self["at_frame"] = frame
    self.id_data.update_tag()  # Handlers move its marker.


def _read_time(self):
    scene = _scene_of(self)
    return (self.frame - scene.frame_start) / frames_per_second(scene)


def _write_time(self, time):
    scene = _scene_of(self)
    self.frame = scene.frame_start + time * frames_per_second(scene)


class BrumeEvent(bpy.types.PropertyGroup):
    type: EnumProperty(items=EVENTS, name="Event", description="Event at this empty", options=_FIXED)
    frame: FloatProperty(
        name="Frame", description="Frame of the event", get=_read_frame, set=_write_frame, precision=1, options=_FIXED
    )
    time: FloatProperty(
        name="Time",
        description="Time of the event, from the first frame of the scene",
        get=_read_time,
        set=_write_time,
        unit="TIME_ABSOLUTE",
        options=_FIXED,
    )
    thrown_from: PointerProperty(
        type=bpy.types.Object,
        name="Thrown From",
        description="Position of the thrower; empty: the grenade goes off here",
    )
    aim: PointerProperty(
        type=bpy.types.Object, name="Aim", description="Target that the shot passes through; empty: along the arrow"
    )
    radius: _plain("Radius", 0.25, 0.01, 10.0, "Radius of the hole, half the edge of a box or mask")
    shape: EnumProperty(
        items=(
            ("CYLINDER", "Cylinder", "A round hole"),
            ("BOX", "Box", "A square hole"),
            ("MASK", "Mask", "A hole in the shape of an image: white removes all smoke"),
        ),
        name="Shape",
        description="Cross-section of the hole",
        options=_FIXED,
    )
    mask: StringProperty(
        name="Mask", description="Image of the cross-section", subtype="FILE_PATH", options=_FIXED
    )
    roll: FloatProperty(
        name="Roll",
        description="Rotates a box, mask or word clockwise as seen by the shooter",
        min=-2 * math.pi,
        max=2 * math.pi,
        subtype="ANGLE",
        options=_FIXED,
    )
    flash: _plain("Flash (W/sr)", 25.0, 0.0, 1e6, "Intensity of the muzzle flash, 0.06 s long")
    reach: _seconds("Bore Time", 0.25, 60.0, "Time until the hole reaches the far end")
    expand: _seconds("Open Time", 0.05, 60.0, "Time to open at each depth")
    stay: _seconds("Stay Open", 0.6, 600.0, "Time open")
    fade: _seconds("Close Time", 0.35, 60.0, "Time to close")
    text: StringProperty(name="Word", description="One line of letters", default="SMOKE", options=_FIXED)
    size: _plain("Height", 0.5, 0.02, 10.0, "Height of a capital letter")
    font: StringProperty(
        name="Font", description="Font file; empty: DejaVu Sans Bold", subtype="FILE_PATH", options=_FIXED
    )
    spacing: _plain("Spacing", 0.0, -0.5, 10.0, "Extra space between letters, in capital heights")
    interval: _seconds("Interval", 0.0, 10.0, "Time between letters")
    blast_radius: _plain("Radius", 5.0, 0.1, 100.0, "Radius of the cavity")
    blast_flash: _plain("Flash (W/sr)", 250.0, 0.0, 1e6, "Intensity of the fireball, which lasts 0.3 s")
    speed: _plain("Speed", 32.0, 1.0, 10000.0, "Speed of the front")
    remaining: _plain("Remaining", 0.02, 0.0, 1.0, "Fraction of the smoke that remains", subtype="FACTOR")
    refill_rim: _seconds("Rim Refills In", 0.5, 60.0, "Time until the rim is refilled", least=0.01)
    refill_middle: _seconds("Middle Refills In", 5.0, 60.0, "Time until the middle is refilled", least=0.01)
    door: PointerProperty(
        type=bpy.types.Object, name="Door", description="The door to open or close; its role must be Door"
    )
    open: BoolProperty(name="Open", default=True, description="Opens the door; otherwise closes it", options=_FIXED)


_show(BrumeEvent, {"radius": "LENGTH", "size": "LENGTH", "blast_radius": "LENGTH", "speed": "VELOCITY"})


def _read_smoke_radius(self):
    return radius_of_voxels(self.smoke_voxels, self.voxel) / metres_per_unit(_scene_of(self))


def _write_smoke_radius(self, radius):
    metres = min(max(radius * metres_per_unit(_scene_of(self)), 0.0), 1e4)
    self.smoke_voxels = min(voxels_of_radius(metres, self.voxel), 16777216)


class BrumeScene(bpy.types.PropertyGroup):
    format: EnumProperty(
        items=(
            ("GLTF", "glTF", "One .glb file: all lights, materials and the camera"),
            ("TXT", "Scene.txt", "Scene.txt with OBJ meshes and textures: point lights, plain materials"),
        ),
        name="Format",
        description="Intermediate format for rendering and voxelizing",
        options=_FIXED,
    )
    voxel: _plain("Voxel Size", 0.25, 1 / 64, 10.0, "Edge of a voxel")
    smoke_voxels: IntProperty(
        name="Voxels",
        default=1800,
        min=1,
        max=16777216,
        description="Number of voxels that a fully grown smoke fills",
        options=_FIXED,
    )
    smoke_radius: FloatProperty(
        name="Radius",
        description="Radius of a fully grown smoke in open air, as a ball; walls and floors make it wider",
        unit="LENGTH",
        get=_read_smoke_radius,
        set=_write_smoke_radius,
        options=_FIXED,
    )
    smoke_bloom: _seconds("Grow Time", 1.0, 60.0, "Time from going off to full size", least=0.05)
    smoke_hold: _seconds("Stay Time", 18.0, 3600.0, "Time at full size")
    smoke_dissolve: _seconds("Dissolve Time", 3.0, 60.0, "Time to dissolve completely", least=0.05)
    smoke_extinction: _plain(
        "Density (1/m)", 3.0, 0.01, 100.0, "Extinction coefficient of dense smoke: at 3 one sees 1 m far"
    )
    sky: EnumProperty(
        items=(
            ("WORLD", "World", "The colour of Blender's world in all directions", 1),
            ("BRUME", "Brume's Daylight", "Brume's own sky", 0),
        ),
        name="Sky",
        default="WORLD",
        description="Light from the sky",
        options=_FIXED,
    )
    tone: EnumProperty(
        items=(
            ("standard", "Standard", "The tones of Blender's view transform Standard"),
            ("neutral", "Brume", "Brume's own tone curve: darker shadows, highlights that do not clip"),
        ),
        name="Tone",
        description="How the brightness of the scene becomes that of the image",
        options=_FIXED,
    )
    march: EnumProperty(
        items=(
            ("full", "Full", "One smoke ray per pixel"),
            ("half", "Half", "One smoke ray per 2x2 pixels"),
            ("quarter", "Quarter", "One smoke ray per 4x4 pixels"),
        ),
        name="Smoke Detail",
        description="Resolution of the smoke",
        options=_FIXED,
    )
    samples: EnumProperty(
        items=(
            ("1", "1", "One sample per pixel: fast, with stepped edges"),
            ("2", "4", "2x2 samples per pixel: smooth edges, four times the time"),
            ("3", "9", "3x3 samples per pixel: smooth thin lines, nine times the time"),
        ),
        name="Samples",
        description="Samples per pixel of rendered images",
        options=_FIXED,
    )
    markers: BoolProperty(
        name="Markers",
        default=True,
        description="Shows events as markers of the timeline; moving a marker moves its event",
        options=_FIXED,
    )
    gizmos: BoolProperty(
        name="Sizes and Paths",
        default=True,
        description="Shows the size of smokes and blasts and the paths of shots in the 3D view",
        options=_FIXED,
    )


_show(BrumeScene, {"voxel": "LENGTH"})

_CLASSES = (BrumeObject, BrumeEvent, BrumeScene)


def register():
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.brume = PointerProperty(type=BrumeObject, options=_FIXED)
    bpy.types.Object.brume_event = PointerProperty(type=BrumeEvent, options=_FIXED)
    bpy.types.Scene.brume = PointerProperty(type=BrumeScene, options=_FIXED)


def unregister():
    del bpy.types.Scene.brume
    del bpy.types.Object.brume_event
    del bpy.types.Object.brume
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
