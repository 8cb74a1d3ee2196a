"""The contents of the open scene for both exporters: evaluated, instances expanded, with unique names."""

import math
import os
import tempfile
from dataclasses import dataclass, field

import bpy
import numpy as np

from . import conversion, light_nodes, names, surfaces
from .clock import moves
from .properties import BRUME_ROLES
from .visibility import AsRendered


@dataclass
class Piece:
    """A mesh with its transform."""

    mesh: bpy.types.Mesh  # A copy with modifiers applied, in mesh space and Blender units.
    world_from_mesh: np.ndarray  # In Brume's axes and metres.
    materials: list  # By slot; None for an empty one.


@dataclass
class Thing:
    """An object in Brume: a mesh, or a door together with its children."""

    name: str
    role: str
    label: str  # Name in Blender.
    pieces: list = field(default_factory=list)


@dataclass
class Light:
    label: str  # Name in Blender.
    data: bpy.types.Light
    world_from_light: np.ndarray  # In Brume's axes and metres.
    power: float  # [W]; for a sun [W/m^2].
    color: tuple  # Linear, at most 1.


@dataclass
class Volume:
    label: str  # Name in Blender.
    data: bpy.types.Volume
    material: bpy.types.Material  # None without one.
    world_from_file: np.ndarray  # To Brume's axes and metres.
    moves: bool
    evaluated_file: str = ""  # The grids after modifiers; removed with the level.


@dataclass
class Level:
    things: list = field(default_factory=list)
    volumes: list = field(default_factory=list)
    lights: list = field(default_factory=list)
    door_names: dict = field(default_factory=dict)  # Name in Blender: names of its instances in Brume.
    # Objects of which something is not exported, by their names in Blender.
    hairy: list = field(default_factory=list)
    only_volumes: list = field(default_factory=list)
    metres: float = 1.0  # Length of a Blender unit.
    rendered: set = field(default_factory=set)  # Objects of the scene that Blender renders, empties included.


# Object types that Blender renders but cannot evaluate to a mesh.
_NO_MESH = {
    "POINTCLOUD": "point cloud",
    "CURVES": "hair",
    "GPENCIL": "drawing",
    "GREASEPENCIL": "drawing",
}


def _hidden_from_renders(instance):
    """Whether the depsgraph lists an instance that Blender does not render."""
    source = instance.object.original
    if instance.is_instance:
        # Geometry nodes render instances of hidden objects.
        parent = instance.parent.original
        return parent.hide_render or (parent.instance_type == "COLLECTION" and source.hide_render)
    if source.hide_render:
        return True
    # Instances on vertices and faces replace the child; the instancer itself renders only if its option says so.
    if source.parent and source.parent.instance_type in {"VERTS", "FACES"}:
        return True
    instancing = source.instance_type in {"VERTS", "FACES"} or len(source.particle_systems) > 0
    return instancing and not source.show_instancer_for_render


def _role(instance):
    roles = [instance.object.original.brume.role]
    if instance.is_instance and instance.parent:
        roles.append(instance.parent.original.brume.role)
    for role in ("LEFT_OUT", *BRUME_ROLES):
        if role in roles:
            return role
    return roles[0]


def _door_of(source):
    """The nearest door among an object and its ancestors, or None."""
    while source is not None and source.brume.role != "DOOR":
        source = source.parent
    return source


def _materials(evaluated):
    """Materials by slot: that of the object if the slot is linked to it, else that of the mesh."""
    found = list(evaluated.data.materials)
    for index, slot in enumerate(evaluated.material_slots):
        if index < len(found) and slot.link == "OBJECT":
            found[index] = slot.material
    return [material.original if material else None for material in found]


def _is_volume_alone(material):
    """Whether Blender shows nothing of the surface of a material."""
    return surfaces.is_linked(material, "Volume") and not surfaces.is_linked(material, "Surface")


class Gathered:
    """`with Gathered(context, warnings) as level`: the level of the scene; removes its mesh copies on exit."""

    _chosen = None  # The objects that count; None: what Blender renders.

    def __init__(self, context, warnings):
        self._context, self._warnings = context, warnings
        self._copies, self._doors, self._mode = {}, {}, None
        self._level = Level(metres=conversion.metres_per_unit(context.scene))
        self._names = names.UniqueNames()
        self._folder = None  # Of evaluated volumes.

    def __enter__(self):
        # A mesh in edit mode has no faces in the depsgraph.
        if self._context.mode.startswith("EDIT"):
            self._mode = self._context.object.mode
            bpy.ops.object.mode_set(mode="OBJECT")
        try:
            with AsRendered(self._context, bpy.data, self._chosen):
                self._add_all()
        except BaseException:
            self.__exit__()
            raise
        return self._level

    def __exit__(self, *_):
        bpy.data.batch_remove(self._copies.values())
        self._copies = {}
        if self._folder:
            self._folder.cleanup()
            self._folder = None
        if self._mode:
            bpy.ops.object.mode_set(mode=self._mode)
            self._mode = None

    def _add_all(self):
        view_layer = self._context.view_layer
        self._level.rendered = {
            thing for thing in view_layer.objects if thing.visible_get(view_layer=view_layer)
        }
        self._level.hairy = [thing.name for thing in view_layer.objects if self._has_hair(thing)]
        depsgraph = self._context.evaluated_depsgraph_get()
        depsgraph.update()
        for instance in depsgraph.object_instances:
            if _hidden_from_renders(instance):
                continue
            if instance.object.type == "MESH":
                self._add_mesh(instance)
            elif instance.object.type == "LIGHT":
                self._add_light(instance)
            elif instance.object.type == "VOLUME":
                self._add_volume(instance)
            elif instance.object.type in _NO_MESH:
                what = _NO_MESH[instance.object.type]
                self._warnings.add(f'"{instance.object.name}" is a {what} and is not exported')

    def _has_hair(self, thing):
        if thing not in self._level.rendered or thing.brume.role == "LEFT_OUT":
            return False
        settings = [particles.settings for particles in thing.particle_systems]
        return any(hair.type == "HAIR" and hair.render_type == "PATH" for hair in settings)

    def _add_mesh(self, instance):
        source, role = instance.object.original, _role(instance)
        piece = self._piece(instance) if role != "LEFT_OUT" else None
        if piece is None:
            return
        if piece.materials and all(_is_volume_alone(material) for material in piece.materials):
            if source.name not in self._level.only_volumes:
                self._level.only_volumes.append(source.name)
            return
        door = _door_of(source) if role in {"SOLID", "DOOR"} else None
        if door:
            self._add_to_door(instance, door, piece)
            return
        name = self._names.take(names.safe(source.name))
        if "door" in name.lower():
            self._warnings.add(
                f'"{source.name}" has "door" in its name, so the viewer opens it; rename it or set its role to Door'
            )
        self._level.things.append(Thing(name, role, source.name, [piece]))

    def _piece(self, instance):
        """The evaluated mesh of an instance with its transform; None if nothing of it is visible."""
        evaluated = instance.object
        if len(evaluated.data.polygons) == 0:
            return None
        # Objects without modifiers share the evaluated mesh. Meshes live until the depsgraph is evaluated again.
        key = evaluated.data.as_pointer()
        if key not in self._copies:
            # Copies the evaluated mesh. With preserve_all_data_layers and a depsgraph Blender 3.4 crashes on
            # instances of text objects.
            self._copies[key] = bpy.data.meshes.new_from_object(evaluated)
        matrix = conversion.matrix(instance.matrix_world, self._level.metres)
        if not np.isfinite(matrix).all():
            name = evaluated.original.name
            self._warnings.add(f'"{name}" has a transform that is not finite and is not exported')
            return None
        if not matrix[:3, :3].any():
            return None  # Scaled to a point: invisible in Blender too.
        return Piece(self._copies[key], matrix, _materials(evaluated))

    def _add_to_door(self, instance, door, piece):
        """Adds a piece to the thing of its door: one thing per instance of the door's collection."""
        copy = ()
        if instance.is_instance:
            parent = instance.parent
            ids = tuple(instance.persistent_id)
            copy = (parent.name_full, ids[1:] if parent.instance_type == "COLLECTION" else ids)
        key = (door.name_full, copy)
        if key not in self._doors:
            name = names.safe(door.name)
            # The viewer recognizes doors by their name.
            name = self._names.take(name if "door" in name.lower() else "door_" + name)
            self._doors[key] = Thing(name, "DOOR", door.name)
            self._level.things.append(self._doors[key])
            self._level.door_names.setdefault(door.name, []).append(name)
        self._doors[key].pieces.append(piece)

    def _add_volume(self, instance):
        if _role(instance) == "LEFT_OUT":
            return
        evaluated, source = instance.object, instance.object.original
        material = (_materials(evaluated) or [None])[0]
        matrix = conversion.from_file(instance.matrix_world, self._level.metres)
        moving = moves(source) or (instance.is_instance and moves(instance.parent.original))
        volume = Volume(source.name, source.data, material, matrix, moving)
        if any(modifier.show_render for modifier in source.modifiers):
            volume.evaluated_file = self._evaluated_file(evaluated)
        self._level.volumes.append(volume)

    def _evaluated_file(self, evaluated):
        """Saves what the modifiers make of a volume; the file of the object has it without them."""
        self._folder = self._folder or tempfile.TemporaryDirectory(prefix="brume_")
        path = os.path.join(self._folder.name, f"{len(self._level.volumes)}.vdb")
        if evaluated.data.grids.save(filepath=path) and os.path.exists(path):
            return path
        self._warnings.add(f'the volume "{evaluated.name}" is exported without its modifiers')
        return ""

    def _add_light(self, instance):
        light = instance.object.original.data
        metres = self._level.metres
        # Light falls off with the square of the distance in Blender units: in metres the same irradiance takes
        # metres^2 times the power.
        power = light.energy * (1.0 if light.type == "SUN" else metres * metres)
        if power < 0 or min(light.color) < 0:
            self._warnings.add(f'the light "{instance.object.name}" has negative power or colour and is not exported')
            return
        color = np.array(light.color) * np.maximum(light_nodes.factor_of(light)[0], 0)
        most = max(1.0, float(color.max()))
        matrix = conversion.matrix(instance.matrix_world, metres)
        self._level.lights.append(Light(instance.object.name, light, matrix, power * most, tuple(color / most)))


# Intensity of Blender's lights of P watts (measured by tests/blender/lights.py): P / (4 pi) W/sr for points and for
# spots inside their cone; P / 4 along the axis of area lights, times the cosine off axis.
def spot_for_area(power):
    """The power of a 180 degree spot with AREA_BLEND that approximates an area light.

    A spot of power q has the intensity q / (4 pi) along its axis. With the falloff that glTF recommends, from an outer
    angle of 90 degrees to an inner angle of cosine 3/4, it emits 2 pi * q / (4 pi) times the integral of
    min(4/3 c, 1)^2 over the cosine c from 0 to 1, 1/2: q / 4. The area light emits pi * power / 4. Both axis intensity
    and total match for q = pi * power.
    """
    return math.pi * power


# Full angle of the widest spot [radians]: pi rounded to float32 exceeds the maximum of glTF.
WIDEST_SPOT = math.pi - 1e-6
# Blender's exporter writes the inner angle (1 - blend) * WIDEST_SPOT / 2.
AREA_BLEND = 1 - math.acos(0.75) / (math.pi / 2)
