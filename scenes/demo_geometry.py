"""Closed, textured solids: boxes, prisms, walls with openings, lathes and tubes.

A `Solid` gathers triangles by material, in metres, counter-clockwise seen from outside. Each face gets a flat or smooth
normal, a tangent along +u, and UVs mapped from positions so that one repeat covers the material's own size.
"""
import numpy as np

from demo_textures import REPEAT_M, SIZE_M

Y = np.array([0.0, 1.0, 0.0])


def unit(v):
    v = np.asarray(v, float)
    return v / np.linalg.norm(v)


def rotation_y(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def quaternion(matrix):
    """The unit quaternion x, y, z, w of a rotation matrix."""
    m = np.asarray(matrix, float)
    w = np.sqrt(max(0.0, 1 + m[0, 0] + m[1, 1] + m[2, 2])) / 2
    x = np.copysign(np.sqrt(max(0.0, 1 + m[0, 0] - m[1, 1] - m[2, 2])) / 2, m[2, 1] - m[1, 2])
    y = np.copysign(np.sqrt(max(0.0, 1 - m[0, 0] + m[1, 1] - m[2, 2])) / 2, m[0, 2] - m[2, 0])
    z = np.copysign(np.sqrt(max(0.0, 1 - m[0, 0] - m[1, 1] + m[2, 2])) / 2, m[1, 0] - m[0, 1])
    return unit([x, y, z, w])


def look_rotation(forward, up=Y):
    """The rotation that turns -z to `forward`: what cameras, spots and directional lights need."""
    back = -unit(forward)
    if abs(back @ up) > 0.999:
        up = np.array([0.0, 0.0, -1.0])
    right = unit(np.cross(up, back))
    return np.stack([right, np.cross(back, right), back], axis=1)


class Solid:
    """Triangles by material: name -> [positions, normals, tangents, uvs, indices] as lists of arrays."""

    def __init__(self):
        self.parts = {}

    def _append(self, material, pos, nrm, tan, uv, idx):
        part = self.parts.setdefault(material, [[], [], [], [], [], 0])
        for store, value in zip(part, (pos, nrm, tan, uv, np.asarray(idx) + part[5])):
            store.append(np.asarray(value))
        part[5] += len(pos)

    def arrays(self):
        """(material, positions, normals, tangents, uvs, indices) of each part, in the order of first use."""
        return [(name, *(np.concatenate(store) for store in part[:4]), np.concatenate(part[4]).reshape(-1))
                for name, part in self.parts.items()]

    def face(self, material, points, outward=None, turn=False, offset=(0.0, 0.0)):
        """A flat convex polygon. `outward` settles the winding; `turn` lays the texture's u along the other axis."""
        points = np.asarray(points, float)
        normal = unit(np.cross(points[1] - points[0], points[2] - points[0]))
        if outward is not None and normal @ np.asarray(outward) < 0:
            points, normal = points[::-1], -normal
        up = Y if abs(normal[1]) < 0.999 else np.array([0, 0, -np.sign(normal[1])])
        u_axis = unit(np.cross(up, normal))
        v_axis = np.cross(normal, u_axis)
        if turn:
            u_axis, v_axis = v_axis, -u_axis
        repeat = REPEAT_M.get(material, SIZE_M)
        uv = np.stack([points @ u_axis / repeat + offset[0], -(points @ v_axis) / repeat + offset[1]], axis=1)
        count = len(points)
        fan = [(0, i, i + 1) for i in range(1, count - 1)]
        self._append(material, points, np.tile(normal, (count, 1)), np.tile([*u_axis, 1.0], (count, 1)), uv, fan)

    def prism(self, materials, polygon, sweep, turn=False, offset=(0.0, 0.0)):
        """A convex polygon swept along a vector. `materials`: one name, or {"start", "end", "side", side index}."""
        polygon, sweep = np.asarray(polygon, float), np.asarray(sweep, float)
        pick = (lambda key: materials) if isinstance(materials, str) else \
            (lambda key: materials.get(key, materials["side"]))
        middle = polygon.mean(axis=0) + sweep / 2
        self.face(pick("start"), polygon, -sweep, turn, offset)
        self.face(pick("end"), polygon + sweep, sweep, turn, offset)
        for i in range(len(polygon)):
            a, b = polygon[i], polygon[(i + 1) % len(polygon)]
            quad = np.array([a, b, b + sweep, a + sweep])
            self.face(pick(i), quad, quad.mean(axis=0) - middle, turn, offset)

    def box(self, material, low, high, turn=False, offset=(0.0, 0.0)):
        """`material`: one name, or {"side": ..., "top": ..., "bottom": ...}."""
        (x0, y0, z0), (x1, y1, z1) = low, high
        if not isinstance(material, str):
            material = {"start": material.get("bottom", material["side"]), "end": material.get("top", material["side"]),
                        "side": material["side"]}
        self.prism(material, [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)], (0, y1 - y0, 0), turn, offset)

    def beam(self, material, start, end, width, height, turn=False, offset=(0.0, 0.0)):
        """A box from `start` to `end` with a cross-section `width` across and `height` upward."""
        start, end = np.asarray(start, float), np.asarray(end, float)
        along = unit(end - start)
        side = unit(np.cross(along, Y if abs(along[1]) < 0.99 else np.array([0.0, 0, 1])))
        rise = np.cross(side, along)
        corners = [start + side * width / 2 * a + rise * height / 2 * b
                   for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        self.prism(material, corners, end - start, turn, offset)

    def wall(self, materials, origin, along, outward, length, height, thickness, openings=()):
        """A closed wall with rectangular holes, reveals included.

        It runs `length` from `origin` along the unit vector `along`; its outer face lies `thickness` out along
        `outward`. `openings`: (start, end, bottom, top). `materials`: {"out", "in", "edge"}, and {"base": (height,
        name)} for another outer material near the ground.
        """
        origin, along, outward = (np.asarray(v, float) for v in (origin, along, outward))
        base_height, base_name = materials.get("base", (0.0, None))
        s_cuts = sorted({0.0, length, *(s for o in openings for s in o[:2])})
        y_cuts = sorted({0.0, height, *(y for o in openings for y in o[2:])} | ({base_height} if base_name else set()))
        solid = np.ones((len(s_cuts) - 1, len(y_cuts) - 1), bool)
        for s0, s1, y0, y1 in openings:
            for i in range(len(s_cuts) - 1):
                for j in range(len(y_cuts) - 1):
                    solid[i, j] &= not (s0 <= s_cuts[i] < s1 and y0 <= y_cuts[j] < y1)
        at = lambda s, y, t: origin + along * s + Y * y + outward * t
        for i, j in zip(*np.nonzero(solid)):
            (s0, s1), (y0, y1) = s_cuts[i:i + 2], y_cuts[j:j + 2]
            outer = base_name if base_name and y1 <= base_height else materials["out"]
            for t, name, way in ((thickness, outer, outward), (0.0, materials["in"], -outward)):
                self.face(name, [at(s0, y0, t), at(s1, y0, t), at(s1, y1, t), at(s0, y1, t)], way)
            for di, dj, way, ends in ((-1, 0, -along, ((s0, y0), (s0, y1))), (1, 0, along, ((s1, y0), (s1, y1))),
                                      (0, -1, -Y, ((s0, y0), (s1, y0))), (0, 1, Y, ((s0, y1), (s1, y1)))):
                ni, nj = i + di, j + dj
                inside = 0 <= ni < solid.shape[0] and 0 <= nj < solid.shape[1] and solid[ni, nj]
                if not inside:
                    (sa, ya), (sb, yb) = ends
                    reveal = [at(sa, ya, 0), at(sb, yb, 0), at(sb, yb, thickness), at(sa, ya, thickness)]
                    self.face(materials["edge"], reveal, way)

    def lathe(self, material, profile, segments=32, center=(0, 0, 0), closed=False):
        """A profile of (radius, height) points, bottom to top, turned about +y. Creases stay sharp at each point.

        Ends at radius 0, or `closed` into a ring, make the solid watertight. The u seam lies at -z.
        """
        profile = [np.asarray(p, float) for p in profile]
        pairs = list(zip(profile, profile[1:] + profile[:1])) if closed else list(zip(profile, profile[1:]))
        reference = max(p[0] for p in profile)
        turn = np.pi + np.arange(segments + 1) / segments * 2 * np.pi
        c, s = np.sin(turn), np.cos(turn)
        run = 0.0
        for a, b in pairs:
            step = b - a
            length = np.linalg.norm(step)
            slope = np.array([step[1], -step[0]]) / length  # outward for profiles that run bottom to top
            rows = []
            for (radius, y), v in ((a, run), (b, run + length)):
                pos = np.stack([radius * c, np.full_like(c, y), radius * s], axis=1) + np.asarray(center, float)
                nrm = np.stack([slope[0] * c, np.full_like(c, slope[1]), slope[0] * s], axis=1)
                tan = np.stack([s, np.zeros_like(c), -c, np.ones_like(c)], axis=1)
                uv = np.stack([(turn - np.pi) * reference / SIZE_M, np.full_like(c, -v / SIZE_M)], axis=1)
                rows.append((pos, nrm, tan, uv))
            pos, nrm, tan, uv = (np.concatenate([rows[0][k], rows[1][k]]) for k in range(4))
            n = segments + 1
            idx = []
            for i in range(segments):
                if a[0] > 0:
                    idx.append((i, i + 1, n + i + 1))
                if b[0] > 0:
                    idx.append((i, n + i + 1, n + i))
            self._append(material, pos, nrm, tan, uv, idx)
            run += length

    def tube(self, material, path, radius, segments=10, loop=False):
        """A round tube along a path of points, with flat end caps unless it loops."""
        path = np.asarray(path, float)
        count = len(path)
        if loop:
            ways = np.array([unit(path[(i + 1) % count] - path[i - 1]) for i in range(count)])
        else:
            ways = np.array([unit(path[min(i + 1, count - 1)] - path[max(i - 1, 0)]) for i in range(count)])
        side = unit(np.cross(ways[0], [0.31, 0.93, 0.19]))
        angle = np.arange(segments + 1) / segments * 2 * np.pi
        rings, run = [], 0.0
        order = list(range(count)) + ([0] if loop else [])
        frames = []
        for k in range(count):
            side = unit(side - ways[k] * (side @ ways[k]))
            frames.append((side, np.cross(ways[k], side)))
        for step, k in enumerate(order):
            if step:
                run += np.linalg.norm(path[k] - path[order[step - 1]])
            a, b = frames[k]
            nrm = np.cos(angle)[:, None] * a + np.sin(angle)[:, None] * b
            # The bitangent cross(normal, tangent) runs along the path and v with it, so the image's up is against it.
            around = -np.sin(angle)[:, None] * a + np.cos(angle)[:, None] * b
            tan = np.concatenate([around, np.full((segments + 1, 1), -1.0)], axis=1)
            uv = np.stack([angle * radius / SIZE_M, np.full_like(angle, run / SIZE_M)], axis=1)
            rings.append((path[k] + radius * nrm, nrm, tan, uv))
        n = segments + 1
        pos, nrm, tan, uv = (np.concatenate([r[k] for r in rings]) for k in range(4))
        idx = []
        for r in range(len(rings) - 1):
            for i in range(segments):
                p = r * n + i
                idx += [(p, p + 1, p + n + 1), (p, p + n + 1, p + n)]
        self._append(material, pos, nrm, tan, uv, idx)
        if not loop:
            self.face(material, rings[0][0][:-1], -ways[0])
            self.face(material, rings[-1][0][:-1], ways[-1])
