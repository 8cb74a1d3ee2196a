"""Properties that the add-on stores in a .blend file: roles of objects, events, and settings of the scene.

Defaults and ranges: settings.py. Lengths are stored in metres; panels show the property with the
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
from .kinds import KINDS, PROPERTIES
from .settings import EVENT_FIELDS, SETTINGS

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
EVENTS = (("NONE", "None", "An ordinary empty", 0),) + tuple(
    (identifier, kind.label, kind.description, kind.number) for identifier, kind in KINDS.items()
)

_SMOKE = SETTINGS["smoke"]
_FIXED = set()  # Options of a property without keyframes.


def _number(setting, name, **more):
    """A setting of timelines or of their events."""
    if setting.unit == "s":
        more["unit"] = "TIME_ABSOLUTE"
    kind, default = FloatProperty, setting.default
    if isinstance(default, int):
        kind = IntProperty
    low, high = setting.low, setting.high
    if setting.unit == "degrees":
        low, high, more["subtype"] = math.radians(low), math.radians(high), "ANGLE"
    more = {"description": setting.description} | more
    return kind(name=name, default=default, min=low, max=high, options=_FIXED, **more)


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
    text: StringProperty(name="Word", description="One line of letters", default="SMOKE", options=_FIXED)
    font: StringProperty(
        name="Font", description="Font file; empty: DejaVu Sans Bold", subtype="FILE_PATH", options=_FIXED
    )
    door: PointerProperty(
        type=bpy.types.Object, name="Door", description="The door to open or close; its role must be Door"
    )
    open: BoolProperty(name="Open", default=True, description="Opens the door; otherwise closes it", options=_FIXED)


def _add_numbers():
    """The numbers of all kinds."""
    lengths, more = {}, {"remaining": {"subtype": "FACTOR"}}
    for kind in KINDS.values():
        numbers = EVENT_FIELDS[kind.name].numbers
        for key, label in kind.labels.items():
            name = PROPERTIES[kind.name, key]
            if name not in BrumeEvent.__annotations__:
                BrumeEvent.__annotations__[name] = _number(numbers[key], label, **more.get(key, {}))
            unit = {"m": "LENGTH", "m/s": "VELOCITY"}.get(numbers[key].unit)
            if unit:
                lengths[name] = unit
    _show(BrumeEvent, lengths)


_add_numbers()


def _read_smoke_radius(self):
    return radius_of_voxels(self.smoke_voxels, self.voxel) / metres_per_unit(_scene_of(self))


def _write_smoke_radius(self, radius):
    metres = min(max(radius * metres_per_unit(_scene_of(self)), 0.0), 1e4)
    self.smoke_voxels = min(voxels_of_radius(metres, self.voxel), _SMOKE["voxels"].high)


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
    voxel: _number(SETTINGS["grid"]["voxel"], "Voxel Size")
    smoke_voxels: _number(_SMOKE["voxels"], "Voxels")
    smoke_radius: FloatProperty(
        name="Radius",
        description="Radius of a fully grown smoke in open air, as a ball; walls and floors make it wider",
        unit="LENGTH",
        get=_read_smoke_radius,
        set=_write_smoke_radius,
        options=_FIXED,
    )
    smoke_bloom: _number(_SMOKE["bloom"], "Grow Time")
    smoke_hold: _number(_SMOKE["hold"], "Stay Time")
    smoke_dissolve: _number(_SMOKE["dissolve"], "Dissolve Time")
    smoke_extinction: _number(
        _SMOKE["extinction"],
        "Density (1/m)",
        description="Extinction coefficient of dense smoke: at 3 one sees 1 m far",
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
        description="Shows the size of smokes and explosions and the paths of shots in the 3D view",
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
