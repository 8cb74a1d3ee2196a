"""Checks a .glb file that one of the scripts made. Every finding is one line; none is good."""
import math
import os

import numpy as np

from demo_check import accessor, check_stale, open_edges, png_problem, read_glb, signed_volumes, weld

MAX_BYTES, MAX_IMAGE_BYTES = 3_000_000, 1_500_000
MIN_AREA = 1e-12  # triangles below a square micrometre [m^2]
COPLANAR = 1e-4  # faces nearer than this may flicker [m]


def triangles_of(doc, blob, mesh):
    """Positions, normals and triangles of all primitives of a mesh."""
    pos, nrm, tri, base = [], [], [], 0
    for primitive in mesh["primitives"]:
        pos.append(accessor(doc, blob, primitive["attributes"]["POSITION"]).astype(float))
        nrm.append(accessor(doc, blob, primitive["attributes"]["NORMAL"]).astype(float))
        indices = accessor(doc, blob, primitive["indices"]).astype(np.int64)
        assert len(indices) % 3 == 0 and indices.max() < len(pos[-1]), "bad indices"
        tri.append(indices.reshape(-1, 3) + base)
        base += len(pos[-1])
    return np.concatenate(pos), np.concatenate(nrm), np.concatenate(tri)


def check_tangents(label, doc, blob, primitive, found):
    """The tangent runs along +u, and w * cross(normal, tangent) up the image, against +v."""
    pos, nrm, tan, uv = (accessor(doc, blob, primitive["attributes"][key]).astype(float)
                         for key in ("POSITION", "NORMAL", "TANGENT", "TEXCOORD_0"))
    tri = accessor(doc, blob, primitive["indices"]).astype(np.int64).reshape(-1, 3)
    if abs(np.linalg.norm(tan[:, :3], axis=1) - 1).max() > 1e-4 or abs((nrm * tan[:, :3]).sum(axis=1)).max() > 1e-3:
        found.append(f"{label}: a tangent is no unit vector at right angles to its normal")
    (p1, p2), (t1, t2) = ([x[tri[:, k]] - x[tri[:, 0]] for k in (1, 2)] for x in (pos, uv))
    det = t1[:, 0] * t2[:, 1] - t1[:, 1] * t2[:, 0]
    ok = abs(det) > 1e-9
    along_u = (p1 * t2[:, 1:] - p2 * t1[:, 1:]) / np.where(ok, det, 1)[:, None]
    along_v = (p2 * t1[:, :1] - p1 * t2[:, :1]) / np.where(ok, det, 1)[:, None]
    up = np.cross(nrm[tri[:, 0]], tan[tri[:, 0], :3]) * tan[tri[:, 0], 3:]
    if (((along_u * tan[tri[:, 0], :3]).sum(axis=1) <= 0) & ok).any() or (((along_v * up).sum(axis=1) >= 0) & ok).any():
        found.append(f"{label}: tangents disagree with the UVs")


def overlap(a, b):
    """Whether two triangles of a plane (2D points) share more than a rim: no edge of either separates them. Lists of
    numbers: arrays of three points would take twelve times as long."""
    for p, q in ((a, b), (b, a)):
        for k in range(3):
            (x, y), (x1, y1), (x2, y2) = p[k], p[k - 2], p[k - 1]
            nx, ny = y1 - y, x - x1
            unit = math.copysign(1 / math.hypot(nx, ny), (x2 - x) * nx + (y2 - y) * ny)
            nx, ny = nx * unit, ny * unit
            if max((u - x) * nx + (v - y) * ny for u, v in q) < 1e-4:
                return False
    return True


def coplanar_faces(pos, tri):
    """A point of each pair of triangles that lie in one plane, face the same way and overlap."""
    p = pos[tri]
    normal = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    area = np.linalg.norm(normal, axis=1)
    keep = area > 1e-7
    p, normal = p[keep], normal[keep] / area[keep, None]
    level = np.einsum("ij,ij->i", normal, p[:, 0])
    found = []
    bins = np.concatenate([np.round(normal / 0.004), np.round(level / (2 * COPLANAR))[:, None]], axis=1)
    _, group = np.unique(bins.astype(np.int64), axis=0, return_inverse=True)
    order = np.argsort(group.reshape(-1), kind="stable")
    for members in np.split(order, np.nonzero(np.diff(group.reshape(-1)[order]))[0] + 1):
        if len(members) < 2:
            continue
        axis = int(np.argmax(abs(normal[members[0]])))
        flat = p[members][:, :, [k for k in range(3) if k != axis]]
        low, high, points = flat.min(axis=1), flat.max(axis=1), flat.tolist()
        for i in range(len(members)):
            near = np.nonzero(((low[i + 1:] < high[i] - 1e-4) & (high[i + 1:] > low[i] + 1e-4)).all(axis=1))[0] + i + 1
            for j in near:
                if abs(level[members[i]] - level[members[j]]) < COPLANAR and overlap(points[i], points[j]):
                    found.append(p[members[i]].mean(axis=0))
    return found


def check_mesh(doc, blob, mesh, shapes, found):
    name = mesh["name"]
    pos, nrm, tri = triangles_of(doc, blob, mesh)
    if not np.isfinite(pos).all() or abs(np.linalg.norm(nrm, axis=1) - 1).max() > 1e-4:
        found.append(f"{name}: a position is not finite, or a normal no unit vector")
    face = np.cross(pos[tri[:, 1]] - pos[tri[:, 0]], pos[tri[:, 2]] - pos[tri[:, 0]])
    area = np.linalg.norm(face, axis=1) / 2
    if (area < MIN_AREA).any():
        found.append(f"{name}: {int((area < MIN_AREA).sum())} triangles without area")
    if ((face[:, None] * nrm[tri]).sum(axis=2) <= 0).any():
        found.append(f"{name}: a normal looks against its triangle")
    welded = weld(pos * 100 if name in shapes else pos, tri)  # small shapes: to 0.1 micrometres
    gaps = open_edges(welded)
    if gaps:
        found.append(f"{name}: {gaps} open edges")
    volumes = signed_volumes(pos, tri, welded)
    if min(volumes) <= 0:
        found.append(f"{name}: {sum(v <= 0 for v in volumes)} surfaces wound inward")
    for primitive in mesh["primitives"]:
        if "TANGENT" in primitive["attributes"]:
            check_tangents(name, doc, blob, primitive, found)
    if name in shapes:  # a volume shape: one smooth surface inside of its box
        edges = np.sort(np.concatenate([welded[:, [0, 1]], welded[:, [1, 2]], welded[:, [2, 0]]]), axis=1)
        _, times = np.unique(edges, axis=0, return_counts=True)
        if len(volumes) != 1 or (times != 2).any():
            found.append(f"{name}: not one surface with two triangles at each edge")
        if (abs(pos).max(axis=0) > np.array(shapes[name]) / 2).any():
            found.append(f"{name}: leaves its box, {shapes[name]}")
    return len(tri)


def check_flicker(doc, blob, found):
    """No two faces of the scene lie in one plane, over each other; what is below a floor at y = 0 does not show."""
    pos, tri, base = [], [], 0
    for node in doc["nodes"]:
        if "mesh" not in node:
            continue
        p, _, t = triangles_of(doc, blob, doc["meshes"][node["mesh"]])
        x, y, z, w = node.get("rotation", (0, 0, 0, 1))
        turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
        pos.append(p @ turn.T + node.get("translation", (0, 0, 0)))
        tri.append(t + base)
        base += len(p)
    pos, tri = np.concatenate(pos), np.concatenate(tri)
    if any(node["name"].endswith("floor") for node in doc["nodes"]):
        tri = tri[pos[tri][:, :, 1].max(axis=1) > -1e-3]
    for point in coplanar_faces(pos, tri)[:12]:
        found.append("faces in one plane near " + ", ".join(f"{v:.3f}" for v in point))


def run(data, path, shapes):
    """Prints what is wrong and returns how much. `shapes`: volume shapes, and the boxes they fit in."""
    found = []
    doc, blob = read_glb(data)
    triangles = sum(check_mesh(doc, blob, mesh, shapes, found) for mesh in doc["meshes"])
    check_flicker(doc, blob, found)
    if len(data) > MAX_BYTES:
        found.append(f"{len(data)} bytes, more than {MAX_BYTES}")
    images = [doc["bufferViews"][image["bufferView"]] for image in doc.get("images", [])]
    if sum(view["byteLength"] for view in images) > MAX_IMAGE_BYTES:
        found.append(f"{sum(view['byteLength'] for view in images)} bytes of images, more than {MAX_IMAGE_BYTES}")
    for image, view in zip(doc.get("images", []), images):
        problem = png_problem(blob[view["byteOffset"]:view["byteOffset"] + view["byteLength"]])
        if problem:
            found.append(f"image {image['name']}: {problem}")
    for name in shapes:
        if name not in [node["name"] for node in doc["nodes"]]:
            found.append(f"no object {name}")
    if not os.path.exists(path):
        found.append("the file is missing; run the script")
    else:
        with open(path, "rb") as stored:
            check_stale(data, stored.read(), found)
    label = os.path.basename(path)
    print(f"{label}: {len(data)} bytes, {sum(view['byteLength'] for view in images)} of images, "
          f"{len(doc['nodes'])} nodes, {triangles} triangles in {len(doc['meshes'])} meshes")
    for line in found:
        print(f"{label}: problem: {line}")
    return len(found)
