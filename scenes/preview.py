"""A small software picture of the demo scene, to judge its composition: z-buffer, textures, lights with shadows."""
import numpy as np

from demo_geometry import look_rotation
from gltf_writer import png_bytes

WIDTH, HEIGHT, CELL = 960, 540, 0.125


def world_triangles(scene, voxelized_only=False):
    """Positions (n, 3, 3), normals, tangents (n, 3, 4) and uvs (n, 3, 2) of the corners, and the materials' names."""
    rows, names = [[], [], [], []], []
    for _, solid, at, rotation, ignore in scene.objects:
        if ignore and voxelized_only:
            continue
        turn = np.eye(3) if rotation is None else rotation
        move = np.zeros(3) if at is None else np.asarray(at, float)
        for name, pos, nrm, tan, uv, idx in solid.arrays():
            tan = np.concatenate([tan[:, :3] @ turn.T, tan[:, 3:]], axis=1)
            for row, values in zip(rows, (pos @ turn.T + move, nrm @ turn.T, tan, uv)):
                row.append(values[idx].reshape(-1, 3, values.shape[1]))
            names += [name] * (len(idx) // 3)
    return (*[np.concatenate(row) for row in rows], np.array(names))


def rasterize(corners, eye, view, scale):
    """The triangle seen by each pixel (-1: sky) and its barycentrics. Triangles are clipped to the near plane."""
    depth = np.full((HEIGHT, WIDTH), 1e9)
    which = np.full((HEIGHT, WIDTH), -1)
    bary = np.zeros((HEIGHT, WIDTH, 3))
    local = (corners - eye) @ view
    near = 0.1
    for t in np.nonzero((local[..., 2] < -near).any(axis=1))[0]:
        shape = [(p, np.eye(3)[i]) for i, p in enumerate(local[t])]
        clipped = []
        for (p, b), (q, c) in zip(shape, shape[1:] + shape[:1]):
            if p[2] < -near:
                clipped.append((p, b))
            if (p[2] < -near) != (q[2] < -near):
                s = (-near - p[2]) / (q[2] - p[2])
                clipped.append((p + s * (q - p), b + s * (c - b)))
        for k in range(1, len(clipped) - 1):
            tri = [clipped[0], clipped[k], clipped[k + 1]]
            p = np.array([v[0] for v in tri])
            z = -p[:, 2]
            x = WIDTH / 2 + p[:, 0] / z * scale
            y = HEIGHT / 2 - p[:, 1] / z * scale
            area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
            x0, x1 = max(int(x.min()), 0), min(int(x.max()) + 1, WIDTH - 1)
            y0, y1 = max(int(y.min()), 0), min(int(y.max()) + 1, HEIGHT - 1)
            if area >= -1e-9 or x0 > x1 or y0 > y1:  # counter-clockwise on a page whose y runs down: negative
                continue
            gx, gy = np.meshgrid(np.arange(x0, x1 + 1) + 0.5, np.arange(y0, y1 + 1) + 0.5)
            w = [((x[(i + 1) % 3] - gx) * (y[(i + 2) % 3] - gy) - (x[(i + 2) % 3] - gx) * (y[(i + 1) % 3] - gy)) / area
                 for i in range(3)]
            inverse = sum(w[i] / z[i] for i in range(3))
            window = np.s_[y0:y1 + 1, x0:x1 + 1]
            new = (w[0] >= 0) & (w[1] >= 0) & (w[2] >= 0) & (inverse > 1e-9)
            distance = 1 / np.where(new, inverse, 1)
            new &= distance < depth[window]
            mixed = sum((w[i] / z[i])[..., None] * tri[i][1] for i in range(3)) * distance[..., None]
            depth[window] = np.where(new, distance, depth[window])
            which[window] = np.where(new, t, which[window])
            bary[window] = np.where(new[..., None], mixed, bary[window])
    return which, bary, depth


class Voxels:
    """The scene's surfaces sampled into a boolean grid."""

    def __init__(self, corners, cell, low=(-14.1, -0.35, -12.1), high=(14.2, 9.0, 16.2)):
        self.low, self.cell = np.array(low), cell
        self.size = np.ceil((np.array(high) - low) / cell).astype(int)
        self.solid = np.zeros(self.size, bool)
        for p in corners:
            steps = int(np.ceil(max(np.linalg.norm(p[1] - p[0]), np.linalg.norm(p[2] - p[0])) / (cell * 0.45))) + 1
            u, v = np.meshgrid(np.linspace(0, 1, steps + 1), np.linspace(0, 1, steps + 1))
            keep = u + v <= 1 + 1e-9
            u, v = u[keep][:, None], v[keep][:, None]
            at = self.index(p[0] + u * (p[1] - p[0]) + v * (p[2] - p[0]))
            at = at[((at >= 0) & (at < self.size)).all(axis=1)]
            self.solid[at[:, 0], at[:, 1], at[:, 2]] = True

    def index(self, points):
        return np.floor((points - self.low) / self.cell).astype(int)

    def visible(self, points, target):
        """Whether a straight line meets no solid voxel, both ends' surroundings left out."""
        way = target - points
        length = np.linalg.norm(way, axis=1)
        lit = np.ones(len(points), bool)
        steps = int(length.max(initial=0.0) / (self.cell * 0.7)) + 1
        for i in range(steps):
            s = 0.25 + i * self.cell * 0.7
            live = np.nonzero(lit & (s < length - 0.3))[0]
            if not len(live):
                break
            at = self.index(points[live] + way[live] * (s / length[live])[:, None])
            inside = ((at >= 0) & (at < self.size)).all(axis=1)
            at = np.clip(at, 0, self.size - 1)
            lit[live] = ~(inside & self.solid[at[:, 0], at[:, 1], at[:, 2]])
        return lit

    def flood(self, source, budget):
        """The `budget` free voxels nearest to `source`, by steps through faces and diagonals of weight 3, 4, 5."""
        import heapq
        moves = [(d, 2 + sum(map(abs, d))) for d in np.ndindex(3, 3, 3) for d in [tuple(np.array(d) - 1)] if any(d)]
        start = tuple(self.index(np.array(source, float)))
        best, heap, taken = {start: 0}, [(0, start)], []
        while heap and len(taken) < budget:
            d, at = heapq.heappop(heap)
            if d > best[at]:
                continue
            taken.append(at)
            for (dx, dy, dz), cost in moves:
                to = (at[0] + dx, at[1] + dy, at[2] + dz)
                if not all(0 <= c < s for c, s in zip(to, self.size)) or self.solid[to]:
                    continue
                if any(self.solid[at[0] + a, at[1] + b, at[2] + c]
                       for a, b, c in ((dx, 0, 0), (0, dy, 0), (0, 0, dz))):
                    continue
                if d + cost < best.get(to, 1 << 30):
                    best[to] = d + cost
                    heapq.heappush(heap, (d + cost, to))
        return np.array(taken)


def sky(directions):
    up = np.clip(directions[:, 1:2], -0.1, 1)
    return np.array([0.010, 0.017, 0.040]) * np.exp(-2.2 * up) + np.array([0.0016, 0.003, 0.009]) + \
        np.array([0.020, 0.012, 0.010]) * np.exp(-14 * np.abs(up))


def light_at(points, voxels, lights, normals=None):
    """Irradiance (with normals) or fluence/4 (without) from all lights."""
    total = np.zeros((len(points), 3))
    for kind, color, power, position, target, cone in lights.values():
        position = np.array(position)
        if kind == "directional":
            way = np.tile(position / np.linalg.norm(position), (len(points), 1))
            strength = np.full(len(points), power)
            aim = points + way * 30
        else:
            offset = position - points
            square = (offset ** 2).sum(axis=1)
            way = offset / np.sqrt(square)[:, None]
            strength = power / np.maximum(square, 0.01)
            aim = np.tile(position, (len(points), 1))
            if kind == "spot":
                axis = np.subtract(target, position)
                cosine = -(way @ (axis / np.linalg.norm(axis)))
                inner, outer = np.cos(cone[0]), np.cos(cone[1])
                strength = strength * np.clip((cosine - outer) / (inner - outer), 0, 1) ** 2
        facing = 0.25 if normals is None else np.clip((normals * way).sum(axis=1), 0, 1)
        strength = strength * facing
        ask = np.nonzero(strength > 0.003)[0]
        lit = voxels.visible(points[ask], aim[ask])
        total[ask] += (strength[ask] * lit)[:, None] * np.array(color)
    return total


def draw(scene, images, materials, lights, camera, path, smoke=False):
    eye, target, fov = np.array(camera[0]), np.array(camera[1]), camera[2]
    view = look_rotation(target - eye)
    scale = HEIGHT / 2 / np.tan(np.radians(fov) / 2)
    corners, normals, tangents, uvs, names = world_triangles(scene)
    which, bary, depth = rasterize(corners, eye, view, scale)
    voxels = Voxels(world_triangles(scene, True)[0], CELL)
    gx, gy = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
    rays = np.stack([(gx - WIDTH / 2) / scale, (HEIGHT / 2 - gy) / scale, -np.ones_like(gx)], axis=-1) @ view.T
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    image = sky(rays.reshape(-1, 3)).reshape(HEIGHT, WIDTH, 3)
    for name in np.unique(names[which[which >= 0]]):
        mask = (which >= 0) & (names[np.maximum(which, 0)] == name)
        tri, weight, spec = which[mask], bary[mask], materials[name]
        blend = lambda values: np.einsum("ni,nij->nj", weight, values[tri])
        point, normal, tangent, uv = blend(corners), blend(normals), blend(tangents), blend(uvs)
        albedo = np.tile(np.array(spec.get("color", (1, 1, 1))), (len(tri), 1))
        if "texture" in spec:
            kinds = images[spec["texture"]]
            size = kinds["color"].shape[0]
            row, col = (np.floor(uv[:, i] * size).astype(int) % size for i in (1, 0))
            albedo = albedo * (kinds["color"][row, col] / 255.0) ** 2.2
            bump = kinds["normal"][row, col] / 127.5 - 1
            side = tangent[:, :3]
            normal = side * bump[:, :1] + np.cross(normal, side) * tangent[:, 3:] * bump[:, 1:2] + normal * bump[:, 2:]
            normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        light = light_at(point, voxels, lights, normal) + 0.02 * np.array([0.5, 0.7, 1.2])
        image[mask] = albedo * light / np.pi * 1.15 + np.array(spec.get("emission", (0, 0, 0)))
    if smoke:
        image = add_smoke(scene, lights, voxels, image, eye, rays, depth, view, smoke)
    image = image * 1.6
    image = 1 - np.exp(-image * 1.3)
    with open(path, "wb") as out:
        out.write(png_bytes((np.clip(image, 0, 1) ** (1 / 2.2) * 255).astype(np.uint8)))


def add_smoke(scene, lights, shadows, image, eye, rays, depth, view, smoke):
    source, budget = smoke
    grid = Voxels(world_triangles(scene, True)[0], 0.25)
    cells = grid.flood(source, budget)
    centres = grid.low + (cells + 0.5) * grid.cell
    print("smoke", len(cells), "voxels from", centres.min(axis=0), "to", centres.max(axis=0),
          "inside room A", int(((centres[:, 0] < 0) & (centres[:, 2] < -0.2)).sum()),
          "room B", int((centres[:, 0] > 0.1).sum()), "yard", int(((centres[:, 0] < 0) & (centres[:, 2] > 0)).sum()))
    glow = np.zeros((*grid.size, 3))
    there = np.zeros(grid.size)
    glow[tuple(cells.T)] = light_at(centres, shadows, lights) * 0.35
    there[tuple(cells.T)] = 2.2
    along = -(rays @ view[:, 2])
    far = np.where(depth < 1e8, depth / along, 60.0)
    through = np.ones(depth.shape)
    low, high = centres.min(axis=0) - 0.3, centres.max(axis=0) + 0.3
    with np.errstate(divide="ignore"):
        a, b = (low - eye) / rays, (high - eye) / rays
    enter = np.maximum(np.minimum(a, b).max(axis=-1), 0)
    leave = np.minimum(np.maximum(a, b).min(axis=-1), far)
    added = np.zeros_like(image)
    step = 0.12
    rng = np.random.Generator(np.random.PCG64(1))
    t = enter + step * rng.random(depth.shape)
    while True:
        live = (t < leave) & (through > 0.01)
        if not live.any():
            break
        p = eye + rays[live] * t[live][:, None] + rng.uniform(-0.1, 0.1, (int(live.sum()), 3))
        at = np.clip(grid.index(p), 0, grid.size - 1)
        sigma = there[at[:, 0], at[:, 1], at[:, 2]]
        pass_on = np.exp(-sigma * step)
        added[live] += (through[live] * (1 - pass_on))[:, None] * glow[at[:, 0], at[:, 1], at[:, 2]]
        through[live] *= pass_on
        t[live] += step
    return image * through[..., None] + added
