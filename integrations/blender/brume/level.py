"""What stands in the open scene, as both exporters read it: evaluated, every instance a thing, names unique."""

import math
from dataclasses import dataclass, field

import bpy
import numpy as np

from . import conversion, names


@dataclass
class Piece:
    """A mesh where it stands."""

    mesh: bpy.types.Mesh  # A copy with modifiers applied, in its own space and in Blender's units.
    world_from_mesh: np.ndarray  # In Brume's axes and metres.
    materials: list  # Of each slot; None for an empty one.


@dataclass
class Thing:
    """What is one object in Brume: a mesh, or a door with what is parented to it."""

    name: str
    role: str
    pieces: list = field(default_factory=list)


@dataclass
class Lamp:
    data: bpy.types.Light
    world_from_light: np.ndarray  # In Brume's axes and metres.
    power: float  # [W]; of a sun [W/m^2].


@dataclass
class Level:
    things: list = field(default_factory=list)
    lights: list = field(default_factory=list)
    door_names: dict = field(default_factory=dict)  # Name of a door in Blender: those of its doors in Brume.
    metres: float = 1.0  # One unit of Blender's.


# What renders in Blender and is no mesh there.
_NO_MESH = {
    "VOLUME": "volume",
    "POINTCLOUD": "point cloud",
    "CURVES": "hair",
    "GPENCIL": "drawing",
    "GREASEPENCIL": "drawing",
}


def _hidden_from_renders(instance):
    """What Blender's renders leave out of what its depsgraph lists."""
    source = instance.object.original
    if instance.is_instance:
        # Geometry nodes show instances of what is hidden itself.
        parent = instance.parent.original
        return parent.hide_render or (parent.instance_type == "COLLECTION" and source.hide_render)
    if source.hide_render:
        return True
    # The instance on vertices and faces replaces the child; the instancer shows itself where it says so.
    if source.parent and source.parent.instance_type in {"VERTS", "FACES"}:
        return True
    instancing = source.instance_type in {"VERTS", "FACES"} or len(source.particle_systems) > 0
    return instancing and not source.show_instancer_for_render


def _role(instance):
    roles = [instance.object.original.brume.role]
    if instance.is_instance and instance.parent:
        roles.append(instance.parent.original.brume.role)
    for role in ("LEFT_OUT", "PASSABLE"):
        if role in roles:
            return role
    return roles[0]


def _door_of(source):
    """The nearest door among an object and its parents."""
    while source is not None and source.brume.role != "DOOR":
        source = source.parent
    return source


def _materials(evaluated):
    """Of each slot: the object's where it has its own there, else the mesh's."""
    found = list(evaluated.data.materials)
    for index, slot in enumerate(evaluated.material_slots):
        if index < len(found) and slot.link == "OBJECT":
            found[index] = slot.material
    return [material.original if material else None for material in found]


class Gathered:
    """`with Gathered(context, warnings) as level`: the copies of the meshes are gone behind it."""

    def __init__(self, context, warnings):
        self._context, self._warnings = context, warnings
        self._copies, self._doors, self._mode = {}, {}, None
        self._level = Level(metres=conversion.metres_per_unit(context.scene))
        self._names = names.UniqueNames()

    def __enter__(self):
        # What is being edited has no faces in the depsgraph.
        if self._context.mode.startswith("EDIT"):
            self._mode = self._context.object.mode
            bpy.ops.object.mode_set(mode="OBJECT")
        try:
            depsgraph = self._context.evaluated_depsgraph_get()
            depsgraph.update()
            for instance in depsgraph.object_instances:
                if _hidden_from_renders(instance):
                    continue
                if instance.object.type == "MESH":
                    self._add_mesh(instance)
                elif instance.object.type == "LIGHT":
                    self._add_light(instance)
                elif instance.object.type in _NO_MESH:
                    what = _NO_MESH[instance.object.type]
                    self._warnings.add(f'"{instance.object.name}" is a {what}, and is left out')
        except BaseException:
            self.__exit__()
            raise
        return self._level

    def __exit__(self, *_):
        bpy.data.batch_remove(self._copies.values())
        self._copies = {}
        if self._mode:
            bpy.ops.object.mode_set(mode=self._mode)
            self._mode = None

    def _add_mesh(self, instance):
        evaluated, source = instance.object, instance.object.original
        role = _role(instance)
        if role == "LEFT_OUT" or len(evaluated.data.polygons) == 0:
            return
        # Objects without modifiers share the evaluated mesh. All live as long as the depsgraph is not evaluated anew.
        key = evaluated.data.as_pointer()
        if key not in self._copies:
            # Of an evaluated object this is its evaluated mesh. Asked to evaluate it again, with all layers,
            # Blender 3.4 crashes on instances of letters.
            self._copies[key] = bpy.data.meshes.new_from_object(evaluated)
        matrix = conversion.matrix(instance.matrix_world, self._level.metres)
        if not np.isfinite(matrix).all():
            self._warnings.add(f'"{source.name}" has a matrix that is not finite, and is left out')
            return
        if not matrix[:3, :3].any():
            return  # Scaled to a point, in Blender too.
        piece = Piece(self._copies[key], matrix, _materials(evaluated))
        door = _door_of(source) if role in {"SOLID", "DOOR"} else None
        if door:
            self._add_to_door(instance, door, piece)
            return
        name = self._names.take(names.safe(source.name))
        if "door" in name.lower():
            self._warnings.add(f'"{source.name}" is no door, but the viewer opens it for its name; rename or mark it')
        self._level.things.append(Thing(name, role, [piece]))

    def _add_to_door(self, instance, door, piece):
        """A door and what is parented to it are one thing, once for each instance of their collection."""
        copy = ()
        if instance.is_instance:
            parent = instance.parent
            ids = tuple(instance.persistent_id)
            copy = (parent.name_full, ids[1:] if parent.instance_type == "COLLECTION" else ids)
        key = (door.name_full, copy)
        if key not in self._doors:
            name = names.safe(door.name)
            # The name is how the viewer knows a door.
            name = self._names.take(name if "door" in name.lower() else "door_" + name)
            self._doors[key] = Thing(name, "DOOR")
            self._level.things.append(self._doors[key])
            self._level.door_names.setdefault(door.name, []).append(name)
        self._doors[key].pieces.append(piece)

    def _add_light(self, instance):
        light = instance.object.original.data
        metres = self._level.metres
        # Light falls off with the square of Blender's units: in metres it takes metres^2 as much power to
        # light a surface the same.
        power = light.energy * (1.0 if light.type == "SUN" else metres * metres)
        if power < 0 or min(light.color) < 0:
            self._warnings.add(f'the light "{instance.object.name}" takes light away, and is left out')
            return
        self._level.lights.append(Lamp(light, conversion.matrix(instance.matrix_world, metres), power))


# Blender's lights of P watts, as its renderers show them (tests/blender/lights.py measures it): points, and spots inside
# their cone, have the intensity P / (4 pi) W/sr; area lights have P / 4 along their axis, and cos times that beside it.
def spot_for_area(power):
    """The power of a spot of 180 degrees, faded from its axis on, that lights as an area light does.

    A spot of power q has q / (4 pi) along its axis. Faded by Brume's smoothstep(0, 1, cos) it gives off
    2 pi * q / (4 pi) * integral of (3 c^2 - 2 c^3) from 0 to 1 = q / 4; the area light pi * power / 4. Both ask for
    q = pi * power.
    """
    return math.pi * power


# Of a spot, side to side [radians]: a float nearest to pi would be more than the half circle that glTF allows.
WIDEST_SPOT = math.pi - 1e-6
