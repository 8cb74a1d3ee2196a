"""Bake Slices and Bake Occlusion: the selected objects as slice atlases."""

import os

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, IntVectorProperty

from . import conversion
from .atlas_operator import AtlasOperator
from .messages import BrumeError

_MOST_CHANNELS = 4
_MOST_VOXELS = 16384


def _size(voxels):
    return "x".join(str(count) for count in voxels)


def _bounds(level):
    """Lowest and highest corner of all points, in Brume's axes and metres."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for piece in (piece for thing in level.things for piece in thing.pieces):
        points = np.empty(3 * len(piece.mesh.vertices), dtype=np.float32)
        piece.mesh.vertices.foreach_get("co", points)
        points = points.reshape(-1, 3).astype(float) @ conversion.BRUME_FROM_BLENDER.T
        points = points @ piece.world_from_mesh[:3, :3].T + piece.world_from_mesh[:3, 3]
        low, high = np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))
    return low, high


def _cubes(level, edge):
    """Options for cubes of an edge [m] around all objects, with one more on each side."""
    low, high = _bounds(level)
    counts = np.ceil((high - low) / edge - 1e-6) + 2
    if counts.max() > _MOST_VOXELS:
        raise BrumeError(f"{counts.max():.0f} voxels across the selection are too many; choose a larger voxel")
    middle, half = (low + high) / 2, counts * edge / 2
    corners = [",".join(f"{value:.9g}" for value in corner) for corner in (middle - half, middle + half)]
    return ["--size", _size(counts.astype(int)), "--box", " ".join(corners)]


class BRUME_OT_bake_slices(AtlasOperator, bpy.types.Operator):
    """Bake how much of each voxel the selected meshes fill, as slices in the tiles of an image"""

    bl_idname = "brume.bake_slices"
    bl_label = "Bake Slices"
    ending = "_slices"

    channels: EnumProperty(
        items=(
            ("ONE", "One", "All objects in one channel"),
            ("EACH", "One per Object", "Up to four objects, named after them, in red, green, blue and alpha"),
        ),
        name="Channels",
        description="Channels of the image that the objects fill",
    )
    size_by: EnumProperty(
        items=(
            ("TILES", "Tiles", "A size and a number of tiles; voxels are as long as it takes"),
            ("VOXEL", "Voxel", "Cubic voxels of one size; as many as it takes"),
        ),
        name="Size By",
        description="What determines the number of voxels",
    )
    tile: IntVectorProperty(
        name="Tile", size=2, default=(64, 64), min=1, max=_MOST_VOXELS, description="Width and height of a tile"
    )
    tiles: IntProperty(name="Tiles", default=32, min=1, max=_MOST_VOXELS, description="Number of slices")
    voxel: FloatProperty(
        name="Voxel Size", default=0.1, min=1e-4, max=1e4, unit="LENGTH", precision=4, description="Edge of a voxel"
    )

    def draw_bake(self, column):
        for name in ("channels", "size_by", *(("tile", "tiles") if self.size_by == "TILES" else ("voxel",))):
            column.prop(self, name)

    def bake_arguments(self, level):
        arguments = ["slices"]
        if self.size_by == "VOXEL":
            arguments += _cubes(level, self.voxel * level.metres)
        else:
            width, height = self.tile
            # Unreal Engine's slices are horizontal; those of the others face Blender's front.
            horizontal = self.preset == "unreal"
            arguments += ["--size", _size((width, self.tiles, height) if horizontal else (width, height, self.tiles))]
        if self.channels == "EACH":
            if len(level.things) > _MOST_CHANNELS:
                raise BrumeError(
                    f"{len(level.things)} objects for {_MOST_CHANNELS} channels; select fewer, or all in one channel"
                )
            pairs = zip(level.things, "rgba")
            arguments += ["--channels", ",".join(f"{thing.name}:{channel}" for thing, channel in pairs)]
        return arguments


class BRUME_OT_bake_occlusion(AtlasOperator, bpy.types.Operator):
    """Bake the ambient occlusion around the selected meshes, on planes that face up and down, as tiles of an image"""

    bl_idname = "brume.bake_occlusion"
    bl_label = "Bake Occlusion"
    ending = "_ao"

    voxels: IntVectorProperty(
        name="Voxels",
        size=3,
        default=(64, 64, 64),
        min=1,
        max=_MOST_VOXELS,
        subtype="XYZ",
        description="Voxels along X and Y, and planes along Z",
    )
    margin: FloatProperty(
        name="Margin",
        default=1.5,
        min=0,
        max=100,
        description="Space around the meshes, relative to their longest side",
    )
    rays: IntProperty(
        name="Rays", default=256, min=1, max=1 << 24, description="Rays of a texel, up and down each"
    )
    gamma: FloatProperty(
        name="Gamma",
        default=1,
        min=0.1,
        max=10,
        description="Exponent of the combined occlusion at the middle plane; below 1 darkens",
    )
    correction: FloatProperty(
        name="Correction",
        default=1,
        min=0,
        max=1,
        subtype="FACTOR",
        description="How much of Gamma applies at the middle plane",
    )
    falloff: FloatProperty(
        name="Falloff",
        default=1,
        min=0,
        max=100,
        description="How fast the correction fades towards the first and last plane",
    )
    separate: BoolProperty(
        name="Separate Images", description="Three images of one channel, combined, up and down, instead of one"
    )

    def draw_bake(self, column):
        for name in ("voxels", "margin", "rays", "gamma", "correction", "falloff", "separate"):
            column.prop(self, name)

    def images(self):
        stem, extension = os.path.splitext(self._target)
        return [stem + part + extension for part in (("", "_up", "_down") if self.separate else ("",))]

    def bake_arguments(self, _level):
        x, y, z = self.voxels
        arguments = ["occlusion", "--size", _size((x, z, y)), "--rays", str(self.rays)]
        for name in ("margin", "gamma", "correction", "falloff"):
            arguments += ["--" + name, conversion.number(getattr(self, name))]
        return arguments + (["--separate"] if self.separate else [])


_CLASSES = (BRUME_OT_bake_slices, BRUME_OT_bake_occlusion)


def register():
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
