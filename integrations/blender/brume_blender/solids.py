"""Rays and points against the exported meshes, in Brume's axes and metres."""

import bmesh
import numpy as np
from mathutils import Matrix, Vector
from mathutils.bvhtree import BVHTree

from . import conversion

_NUDGE = 1e-4  # Past a hit, for the next ray [m].
_ON_SURFACE = 1e-3  # What lies this close to a surface is on either side of it [m].
_TOUCH = 1e-6  # Voxels that triangles touch are solid; of their edge.
_SKIN = 0.02  # What lies on a floor is not inside of it [m].
_DIRECTIONS = (Vector((0.577, 0.577, 0.578)), Vector((-0.8, 0.36, 0.48)), Vector((0.28, -0.1, -0.95)))


class _Solid:
    """A piece of a thing; its tree is built at the first ray that meets its bounds."""

    def __init__(self, thing, piece, corners):
        self.thing, self._mesh, self._matrix = thing, piece.mesh, piece.world_from_mesh
        world = corners @ self._matrix[:3, :3].T + self._matrix[:3, 3]
        self.low, self.high = world.min(axis=0), world.max(axis=0)
        self._tree = self._triangles = None
        self._volume = 0.0

    def tree(self):
        if self._tree is None:
            turn = np.identity(4)
            turn[:3, :3] = conversion.BRUME_FROM_BLENDER
            copy = bmesh.new()
            try:
                copy.from_mesh(self._mesh)
                copy.transform(Matrix((self._matrix @ turn).tolist()))
                self._volume = abs(copy.calc_volume())
                self._tree = BVHTree.FromBMesh(copy)
            finally:
                copy.free()
        return self._tree

    def volume(self):
        """Of the inside of a closed mesh [m^3]."""
        self.tree()
        return self._volume

    def triangles_in(self, low, high):
        """The triangles whose bounds meet a box: an array of corners, (n, 3, 3)."""
        if np.any(self.low > high) or np.any(self.high < low):
            return np.empty((0, 3, 3))
        if self._triangles is None:
            mesh = self._mesh
            mesh.calc_loop_triangles()
            points = np.empty(3 * len(mesh.vertices), dtype=np.float32)
            mesh.vertices.foreach_get("co", points)
            points = points.reshape(-1, 3).astype(float) @ conversion.BRUME_FROM_BLENDER.T
            points = points @ self._matrix[:3, :3].T + self._matrix[:3, 3]
            corners = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
            mesh.loop_triangles.foreach_get("vertices", corners)
            self._triangles = points[corners.reshape(-1, 3)]
        below, above = self._triangles.min(axis=1), self._triangles.max(axis=1)
        return self._triangles[np.all((below <= high) & (above >= low), axis=1)]

    def meets(self, start, direction, far):
        """Whether a ray meets the bounds (slabs of Kay and Kajiya 1986)."""
        near_enter, far_exit = 0.0, far
        for axis in range(3):
            if abs(direction[axis]) < 1e-12:
                if not self.low[axis] <= start[axis] <= self.high[axis]:
                    return False
                continue
            a = (self.low[axis] - _NUDGE - start[axis]) / direction[axis]
            b = (self.high[axis] + _NUDGE - start[axis]) / direction[axis]
            near_enter, far_exit = max(near_enter, min(a, b)), min(far_exit, max(a, b))
        return near_enter <= far_exit

    def encloses(self, point):
        """Whether a point is well inside of the mesh: most of three rays leave it an odd number of times."""
        if not all(self.low[axis] <= point[axis] <= self.high[axis] for axis in range(3)):
            return False
        if self.tree().find_nearest(point, _SKIN)[0] is not None:
            return False
        return sum(self._crossings(point, direction) % 2 for direction in _DIRECTIONS) >= 2

    def _crossings(self, point, direction):
        count, start = 0, Vector(point)
        while count < 1000:
            place, _, _, _ = self.tree().ray_cast(start, direction)
            if place is None:
                break
            count, start = count + 1, place + direction * _NUDGE
        return count


def _corners(mesh):
    """The corners of the bounds of a mesh in Brume's axes, as Piece.world_from_mesh expects them."""
    points = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", points)
    points = points.reshape(-1, 3).astype(float) @ conversion.BRUME_FROM_BLENDER.T
    low, high = points.min(axis=0), points.max(axis=0)
    return np.array([[(high if i >> axis & 1 else low)[axis] for axis in range(3)] for i in range(8)])


def _touches(triangles, centre):
    """Whether one of the triangles touches the unit cube around a point (Akenine-Moller 2001: 13 axes)."""
    corners = triangles - centre
    edges = np.roll(corners, -1, axis=1) - corners
    axes = np.eye(3)
    along = [np.broadcast_to(axis, (len(corners), 3)) for axis in axes]
    along += [np.cross(edges[:, 0], edges[:, 1])]
    along += [np.cross(axis, edges[:, k]) for axis in axes for k in range(3)]
    apart = np.zeros(len(corners), dtype=bool)
    for axis in along:
        places = np.einsum("nkc,nc->nk", corners, axis)
        reach = (0.5 + _TOUCH) * np.abs(axis).sum(axis=1)
        apart |= (places.min(axis=1) > reach) | (places.max(axis=1) < -reach)
    return not apart.all()


class Solids:
    """The things of a level that stop smoke and shots."""

    def __init__(self, level):
        self._solids, corners = [], {}
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        for thing in level.things:
            for piece in thing.pieces:
                if piece.mesh not in corners:
                    corners[piece.mesh] = _corners(piece.mesh)
                solid = _Solid(thing, piece, corners[piece.mesh])
                low, high = np.minimum(low, solid.low), np.maximum(high, solid.high)
                if thing.role not in {"PASSABLE", "GRILLE"}:
                    self._solids.append(solid)
        # Without a thing the level is the origin.
        self.low, self.high = (low, high) if level.things else (np.zeros(3), np.zeros(3))

    def cast(self, start, direction, far, without=()):
        """(distance, label) of the first solid thing on a ray, or None. `without`: names of open doors."""
        found = None
        for solid in self._solids:
            if solid.thing.name in without or not solid.meets(start, direction, far):
                continue
            place, _, _, distance = solid.tree().ray_cast(start, direction, far)
            if place is not None:
                far, found = distance, (distance, solid.thing.label)
        return found

    def around(self, point, without=()):
        """(label, volume [m^3]) of a closed mesh around a point, or None."""
        for solid in self._solids:
            if solid.thing.name not in without and solid.encloses(point):
                return solid.thing.label, solid.volume()
        return None

    def is_free(self, point, voxel, without=()):
        """Whether smoke can begin at a point: its voxel is free, or one beside it on the same side of all surfaces.

        The rule of src/scenario/smoke_start.cpp.
        """
        own = np.floor(np.asarray(point, dtype=float) / voxel)
        low, high = (own - 1 - _TOUCH) * voxel, (own + 2 + _TOUCH) * voxel
        near = [solid.triangles_in(low, high) for solid in self._solids if solid.thing.name not in without]
        triangles = np.concatenate([*near, np.empty((0, 3, 3))]) / voxel
        if not _touches(triangles, own + 0.5):
            return True
        for offset in np.ndindex(3, 3, 3):
            centre = own + np.array(offset) - 0.5
            if not _touches(triangles, centre) and self._is_open(Vector(point), Vector(centre * voxel), without):
                return True
        return False

    def _is_open(self, start, end, without):
        """Whether no surface is between two points; a surface at the first does not count."""
        along = (end - start).normalized()
        start = start + along * _ON_SURFACE
        return self.cast(start, along, (end - start).length, without) is None

    def distance_outside(self, point):
        """How far a point is outside the bounds of the level [m]; 0 inside."""
        return float(np.linalg.norm(np.maximum(np.maximum(self.low - point, point - self.high), 0)))
