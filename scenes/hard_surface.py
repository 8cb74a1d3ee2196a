"""Closed parts with bevels and smooth normals: lofts, lathes, tubes, chamfered boxes, extruded outlines.

A part is a pair: points (n, 3) in metres, triangles (m, 3) counter-clockwise seen from outside. A `Model` gathers parts
by material and gives them normals: smooth across edges below the crease angle, weighted by area, so that large faces
stay flat and narrow bevels carry the gradient.
"""
import numpy as np

from demo_geometry import Y, unit

TURN = 2 * np.pi


def closed(points, triangles):
    """The part, turned inside out if its volume is negative."""
    points, triangles = np.asarray(points, float), np.asarray(triangles, int)
    p = points[triangles] - points.mean(axis=0)
    volume = np.einsum("ij,ij->", p[:, 0], np.cross(p[:, 1], p[:, 2]))
    return points, triangles if volume > 0 else triangles[:, ::-1]


def loft(rings, loop=False):
    """A skin over rings of equally many points. A ring without extent is a tip; open ends get a flat cap."""
    rings = [np.asarray(ring, float) for ring in rings]
    points, first, tips = [], [], []
    at = 0
    for ring in rings:
        tip = np.ptp(ring, axis=0).max() < 1e-9
        points.append(ring[:1] if tip else ring)
        first.append(at)
        tips.append(tip)
        at += len(points[-1])
    n = len(rings[0])
    i = np.arange(n)
    j = (i + 1) % n
    tri = []
    for a, b in [(k, (k + 1) % len(rings)) for k in range(len(rings) if loop else len(rings) - 1)]:
        ai, aj = (np.full(n, first[a]),) * 2 if tips[a] else (first[a] + i, first[a] + j)
        bi, bj = (np.full(n, first[b]),) * 2 if tips[b] else (first[b] + i, first[b] + j)
        if not tips[a]:
            tri.append(np.stack([ai, aj, bj], axis=1))
        if not tips[b]:
            tri.append(np.stack([ai, bj, bi], axis=1))
    for end, order in ((0, -1), (len(rings) - 1, 1)):
        if not loop and not tips[end]:
            points.append(rings[end].mean(axis=0)[None])
            fan = np.stack([first[end] + i, first[end] + j, np.full(n, at)], axis=1)
            tri.append(fan if order > 0 else fan[:, ::-1])
            at += 1
    return closed(np.concatenate(points), np.concatenate(tri))


def lathe(profile, segments, loop=False):
    """A profile of (radius, height) points turned about +y."""
    angle = np.arange(segments) / segments * TURN
    ring = lambda r, y: np.stack([r * np.cos(angle), np.full(segments, float(y)), r * np.sin(angle)], axis=1)
    return loft([ring(r, y) for r, y in profile], loop)


def tube(path, radius, segments=10, loop=False):
    """A round tube along points; `radius` is one number, or one for each point."""
    path = np.asarray(path, float)
    count = len(path)
    radius = np.broadcast_to(radius, (count,))
    near = lambda k: path[k % count] if loop else path[min(max(k, 0), count - 1)]
    ways = [unit(near(k + 1) - near(k - 1)) for k in range(count)]
    side = unit(np.cross(ways[0], [0.31, 0.93, 0.19]))
    angle = np.arange(segments) / segments * TURN
    rings = []
    for k in range(count):
        side = unit(side - ways[k] * (side @ ways[k]))
        up = np.cross(ways[k], side)
        rings.append(path[k] + radius[k] * (np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * up))
    return loft(rings, loop)


def chamfer_box(low, high, bevel):
    """A box with every edge chamfered."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    points, index = [], {}
    for sx in (0, 1):
        for sy in (0, 1):
            for sz in (0, 1):
                sign = np.array([sx, sy, sz])
                for axis in range(3):
                    inset = np.where(np.arange(3) == axis, 0.0, bevel)
                    index[(sx, sy, sz, axis)] = len(points)
                    points.append(np.where(sign == 1, high - inset, low + inset))
    points = np.array(points)
    middle = points.mean(axis=0)
    tri = []

    def face(corners):
        p = points[corners]
        if np.cross(p[1] - p[0], p[2] - p[0]) @ (p.mean(axis=0) - middle) < 0:
            corners = corners[::-1]
        tri.extend((corners[0], corners[k], corners[k + 1]) for k in range(1, len(corners) - 1))

    def key(axis, s, b, t, c, u, which):
        out = [0, 0, 0, which]
        out[axis], out[b], out[c] = s, t, u
        return index[tuple(out)]

    for axis in range(3):
        b, c = (axis + 1) % 3, (axis + 2) % 3
        for s in (0, 1):
            face([key(axis, s, b, t, c, u, axis) for t, u in ((0, 0), (1, 0), (1, 1), (0, 1))])
            for t in (0, 1):  # the edge between faces `axis` and `b`, along `c`
                face([key(axis, s, b, t, c, 0, axis), key(axis, s, b, t, c, 1, axis),
                      key(axis, s, b, t, c, 1, b), key(axis, s, b, t, c, 0, b)])
    for sx in (0, 1):
        for sy in (0, 1):
            for sz in (0, 1):
                face([index[(sx, sy, sz, axis)] for axis in range(3)])
    return points, np.array(tri)


def rounded(polygon, radius, steps=2):
    """A convex polygon of 2D points whose corners are arcs of about this radius."""
    polygon, out = np.asarray(polygon, float), []
    for k, corner in enumerate(polygon):
        before, after = polygon[k - 1] - corner, polygon[(k + 1) % len(polygon)] - corner
        reach = min(radius, 0.45 * np.linalg.norm(before), 0.45 * np.linalg.norm(after))
        a, b = corner + unit(before) * reach, corner + unit(after) * reach
        for t in np.linspace(0, 1, steps + 1):
            out.append((1 - t) ** 2 * a + 2 * t * (1 - t) * corner + t ** 2 * b)
    return np.array(out)


def inset(polygon, distance):
    """A convex polygon, counter-clockwise, with every edge moved inward."""
    polygon = np.asarray(polygon, float)
    count, out = len(polygon), []
    way = [unit(polygon[(k + 1) % count] - polygon[k]) for k in range(count)]
    for k in range(count):
        n0, n1 = (np.array([-w[1], w[0]]) for w in (way[k - 1], way[k]))
        out.append(polygon[k] + (n0 + n1) * distance / (1 + n0 @ n1))
    return np.array(out)


def extrude(polygon, low, high, bevel=0.0, axis=1):
    """A convex outline swept along an axis, with chamfered rims. Its 2D points lie along the next two axes, cyclic."""
    polygon = np.asarray(polygon, float)
    area = np.sum(polygon[:, 0] * np.roll(polygon[:, 1], -1) - polygon[:, 1] * np.roll(polygon[:, 0], -1))
    polygon = polygon if area > 0 else polygon[::-1]
    rim = inset(polygon, bevel) if bevel else polygon
    levels = [(rim, low), (polygon, low + bevel), (polygon, high - bevel), (rim, high)] if bevel else \
        [(polygon, low), (polygon, high)]
    rings = []
    for outline, level in levels:
        ring = np.empty((len(outline), 3))
        ring[:, axis], ring[:, (axis + 1) % 3], ring[:, (axis + 2) % 3] = level, outline[:, 0], outline[:, 1]
        rings.append(ring)
    return loft(rings)


def sphere(radius, segments=24, rows=12):
    a = np.linspace(-np.pi / 2, np.pi / 2, rows + 1)
    profile = [(radius * np.cos(t), radius * np.sin(t)) for t in a]
    profile[0], profile[-1] = (0.0, -radius), (0.0, radius)
    return lathe(profile, segments)


def rotation(axis, degrees):
    """About "x", "y" or "z", counter-clockwise seen from the axis's tip."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array({"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
                     "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis], float)


ALONG_Z = rotation("x", 90)  # turns +y to +z: lathes along the axis of a nozzle
ALONG_X = rotation("z", -90)  # turns +y to +x


def placed(part, matrix=None, offset=(0, 0, 0)):
    """The part, turned or mirrored, then moved."""
    points, tri = part
    if matrix is not None:
        points = points @ np.asarray(matrix, float).T
        if np.linalg.det(matrix) < 0:
            tri = tri[:, ::-1]
    return points + np.asarray(offset, float), tri


def monotone(xs, ys):
    """A smooth curve through points that does not overshoot (Fritsch and Carlson 1980)."""
    xs, ys = np.asarray(xs, float), np.asarray(ys, float)
    step = np.diff(xs)
    slope = np.diff(ys) / step
    same = slope[:-1] * slope[1:] > 0
    w0, w1 = 2 * step[1:] + step[:-1], step[1:] + 2 * step[:-1]
    mean = (w0 + w1) / (w0 / np.where(same, slope[:-1], 1) + w1 / np.where(same, slope[1:], 1))
    tangent = np.concatenate([slope[:1], np.where(same, mean, 0), slope[-1:]])

    def at(x):
        x = np.asarray(x, float)
        k = np.clip(np.searchsorted(xs, x, side="right") - 1, 0, len(step) - 1)
        t = (x - xs[k]) / step[k]
        return ((1 + 2 * t) * (1 - t) ** 2 * ys[k] + t * (1 - t) ** 2 * step[k] * tangent[k] +
                t * t * (3 - 2 * t) * ys[k + 1] + t * t * (t - 1) * step[k] * tangent[k + 1])

    return at


def corner_normals(points, tri, crease):
    """The normal of each triangle's corners, and a key that equal corners of one point share."""
    edges = points[tri[:, 1]] - points[tri[:, 0]], points[tri[:, 2]] - points[tri[:, 0]]
    area = np.cross(*edges)
    face = area / np.maximum(np.linalg.norm(area, axis=1, keepdims=True), 1e-30)
    # All pairs of corners at one point.
    vertex = tri.reshape(-1)
    order = np.argsort(vertex, kind="stable")
    count = np.bincount(vertex, minlength=len(points))
    start = np.cumsum(count) - count
    per_corner = count[vertex]
    a = np.repeat(np.arange(len(vertex)), per_corner)
    within = np.arange(len(a)) - np.repeat(np.cumsum(per_corner) - per_corner, per_corner)
    b = order[start[vertex[a]] + within]
    joined = (face[a // 3] * face[b // 3]).sum(axis=1) > np.cos(np.radians(crease))
    a, b = a[joined], b[joined]
    # Corners are equal where they average the same faces, whatever the last bits of the average are.
    rng = np.random.Generator(np.random.PCG64(7))
    token = rng.integers(1, 1 << 40, len(tri))
    key, normal = np.zeros(len(vertex), np.int64), np.zeros((len(vertex), 3))
    np.add.at(key, a, token[b // 3])
    np.add.at(normal, a, area[b // 3])
    return normal / np.linalg.norm(normal, axis=1, keepdims=True), key


class Model:
    """Parts by material. `repeat`: material -> metres that one repeat of its texture covers; others get no UVs."""

    def __init__(self, repeat=None):
        self.repeat = repeat or {}
        self.parts = {}

    def add(self, material, part, matrix=None, offset=(0, 0, 0), crease=37.0, uv_offset=(0.0, 0.0)):
        part = placed(part, matrix, offset)
        self.parts.setdefault(material, []).append((*part, crease, uv_offset))

    def box(self, material, low, high, bevel=0.0, uv_offset=(0.0, 0.0)):
        if bevel:
            self.add(material, chamfer_box(low, high, bevel), uv_offset=uv_offset)
        else:
            outline = [(low[2], low[0]), (high[2], low[0]), (high[2], high[0]), (low[2], high[0])]
            self.add(material, extrude(outline, low[1], high[1]), uv_offset=uv_offset)

    def merge(self, other, matrix=None, offset=(0, 0, 0)):
        for material, parts in other.parts.items():
            for points, tri, crease, uv_offset in parts:
                self.add(material, (points, tri), matrix, offset, crease, uv_offset)

    def triangle_count(self):
        return sum(len(tri) for parts in self.parts.values() for _, tri, _, _ in parts)

    def arrays(self):
        """(material, positions, normals, tangents, uvs, indices) each; tangents and UVs None without a texture."""
        out = []
        for material, parts in self.parts.items():
            pieces, base = [[], [], [], [], []], 0
            for points, tri, crease, uv_offset in parts:
                piece = self._split(points, tri, crease, self.repeat.get(material), uv_offset)
                for store, value in zip(pieces, piece):
                    store.append(value)
                pieces[4][-1] = pieces[4][-1] + base
                base += len(piece[0])
            join = lambda store: None if store[0] is None else np.concatenate(store)
            out.append((material, *(join(store) for store in pieces)))
        return out

    @staticmethod
    def _split(points, tri, crease, repeat, uv_offset):
        normal, key = corner_normals(points, tri, crease)
        vertex = tri.reshape(-1)
        side = np.zeros(len(vertex), np.int64)
        if repeat:  # mapped from the direction that each triangle faces most
            p = points[tri]
            face = np.round(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]) * 1e6)
            axis = np.argmax(abs(face) * [1.0, 1.02, 1.01], axis=1)
            sign = np.take_along_axis(face, axis[:, None], 1)[:, 0] < 0
            side = np.repeat(axis * 2 + sign, 3)
        _, keep, index = np.unique(np.stack([vertex, key, side], axis=1), axis=0, return_index=True,
                                   return_inverse=True)
        pos, nrm, side = points[vertex[keep]], normal[keep], side[keep]
        if not repeat:
            return pos, nrm, None, None, index.reshape(-1)
        uv, tan = np.zeros((len(pos), 2)), np.zeros((len(pos), 4))
        for which in range(6):
            way = np.zeros(3)
            way[which // 2] = -1.0 if which % 2 else 1.0
            up = Y if which // 2 != 1 else np.array([0, 0, -way[1]])
            u_axis = np.cross(up, way)
            v_axis = np.cross(way, u_axis)
            own = side == which
            uv[own] = np.stack([pos[own] @ u_axis, -(pos[own] @ v_axis)], axis=1) / repeat + uv_offset
            flat = u_axis - nrm[own] * (nrm[own] @ u_axis)[:, None]
            tan[own] = np.concatenate([flat / np.linalg.norm(flat, axis=1, keepdims=True),
                                       np.ones((own.sum(), 1))], axis=1)
        return pos, nrm, tan, uv, index.reshape(-1)
