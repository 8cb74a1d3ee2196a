"""Checks the bytes of demo.glb and the solids it was made from. Every finding is one line; none is good."""
import json
import os
import struct
import zlib

import numpy as np

from demo_textures import REPEAT_M

MAX_BYTES = 6 << 20
FORMATS = {5126: "<f4", 5125: "<u4", 5123: "<u2"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def read_glb(data):
    """The JSON document and the binary chunk."""
    magic, version, total = struct.unpack_from("<4sII", data)
    assert magic == b"glTF" and version == 2 and total == len(data), "bad GLB header"
    length, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON", "first chunk is not JSON"
    doc = json.loads(data[20:20 + length])
    size, kind = struct.unpack_from("<I4s", data, 20 + length)
    assert kind == b"BIN\0" and 28 + length + size == len(data), "bad binary chunk"
    return doc, data[28 + length:]


def accessor(doc, blob, index):
    entry = doc["accessors"][index]
    view = doc["bufferViews"][entry["bufferView"]]
    width = WIDTHS[entry["type"]]
    dtype = np.dtype(FORMATS[entry["componentType"]])
    assert entry["count"] * width * dtype.itemsize <= view["byteLength"], f"accessor {index} runs past its view"
    out = np.frombuffer(blob, dtype, entry["count"] * width, view["byteOffset"])
    return out.reshape(-1, width) if width > 1 else out


def png_problem(data):
    """None, or what is wrong with a PNG's chunks."""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        return "no PNG signature"
    at, body = 8, b""
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        chunk = data[at + 4:at + 8 + length]
        if zlib.crc32(chunk) != struct.unpack_from(">I", data, at + 8 + length)[0]:
            return f"bad checksum in {kind}"
        if kind == b"IHDR":
            width, height = struct.unpack_from(">II", data, at + 8)
        body += chunk[4:] if kind == b"IDAT" else b""
        at += 12 + length
    return None if len(zlib.decompress(body)) == height * (1 + 3 * width) else "rows missing"


def weld(positions, triangles):
    """The triangles over points that are one wherever positions agree to 10 micrometres."""
    _, same = np.unique(np.round(positions * 1e5).astype(np.int64), axis=0, return_inverse=True)
    return same.reshape(-1)[triangles]


def open_edges(tri):
    """How many directed edges lack their opposite: 0 for a watertight, consistently wound surface."""
    count = {}
    for a, b in np.concatenate([tri[:, [0, 1]], tri[:, [1, 2]], tri[:, [2, 0]]]).tolist():
        count[(a, b)] = count.get((a, b), 0) + 1
    return sum(abs(n - count.get((b, a), 0)) for (a, b), n in count.items())


def signed_volumes(positions, triangles, tri):
    """The volume inside each connected surface, below 0 where it is wound inward. `tri` is welded."""
    parent = list(range(tri.max() + 1))

    def root(i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    for a, b, c in tri.tolist():
        parent[root(b)] = parent[root(c)] = root(a)
    roots = np.array([root(a) for a in tri[:, 0].tolist()])
    p = positions[triangles] - positions.mean(axis=0)
    volumes = np.einsum("ij,ij->i", p[:, 0], np.cross(p[:, 1], p[:, 2])) / 6
    return [float(volumes[roots == r].sum()) for r in np.unique(roots)]


def check_primitive(label, pos, nrm, tan, uv, tri, repeat, found):
    for name, values in (("position", pos), ("normal", nrm), ("tangent", tan), ("uv", uv)):
        if not np.isfinite(values).all():
            found.append(f"{label}: {name} is not finite")
    if abs(np.linalg.norm(nrm, axis=1) - 1).max() > 1e-4:
        found.append(f"{label}: a normal is not a unit vector")
    if abs(np.linalg.norm(tan[:, :3], axis=1) - 1).max() > 1e-4 or not (abs(tan[:, 3]) == 1).all():
        found.append(f"{label}: a tangent is not a unit vector with w = +-1")
    if abs((nrm * tan[:, :3]).sum(axis=1)).max() > 1e-3:
        found.append(f"{label}: a tangent is not at right angles to its normal")
    edge1, edge2 = pos[tri[:, 1]] - pos[tri[:, 0]], pos[tri[:, 2]] - pos[tri[:, 0]]
    face = np.cross(edge1, edge2).astype(float)
    area = np.linalg.norm(face, axis=1)
    if (area < 1e-10).any():
        found.append(f"{label}: {int((area < 1e-10).sum())} triangles without area")
    keep = area > 1e-10
    if ((face[keep] * nrm[tri[keep]].sum(axis=1)).sum(axis=1) <= 0).any():
        found.append(f"{label}: a normal looks against its triangle")
    duv1, duv2 = uv[tri[:, 1]] - uv[tri[:, 0]], uv[tri[:, 2]] - uv[tri[:, 0]]
    uv_area = abs(duv1[:, 0] * duv2[:, 1] - duv1[:, 1] * duv2[:, 0])
    if repeat is not None and keep.any():
        density = np.sqrt(uv_area[keep].sum() / area[keep].sum()) * repeat
        if not 0.6 < density < 1.5:
            found.append(f"{label}: {density:.2f} texture repeats where 1 was meant")
    # The tangent runs along +u, and w * cross(normal, tangent) up the image, against +v.
    det = duv1[:, 0] * duv2[:, 1] - duv1[:, 1] * duv2[:, 0]
    ok = keep & (abs(det) > 1e-9)
    along_u = (edge1 * duv2[:, 1:] - edge2 * duv1[:, 1:]) / np.where(ok, det, 1)[:, None]
    along_v = (edge2 * duv1[:, :1] - edge1 * duv2[:, :1]) / np.where(ok, det, 1)[:, None]
    middle_t, middle_n = tan[tri[:, 0], :3], nrm[tri[:, 0]]
    bitangent = np.cross(middle_n, middle_t) * tan[tri[:, 0], 3:]
    if (((along_u * middle_t).sum(axis=1) <= 0) & ok).any() or (((along_v * bitangent).sum(axis=1) >= 0) & ok).any():
        found.append(f"{label}: tangents disagree with the UVs")


def check_file(data, found):
    doc, blob = read_glb(data)
    if len(data) > MAX_BYTES:
        found.append(f"{len(data)} bytes, more than {MAX_BYTES}")
    used, triangles, vertices = set(), 0, 0
    for mesh in doc["meshes"]:
        for primitive in mesh["primitives"]:
            pos, nrm, tan, uv = (accessor(doc, blob, primitive["attributes"][key]).astype(float)
                                 for key in ("POSITION", "NORMAL", "TANGENT", "TEXCOORD_0"))
            indices = accessor(doc, blob, primitive["indices"]).astype(np.int64)
            material = doc["materials"][primitive["material"]]
            label = f"{mesh['name']}/{material['name']}"
            used.add(primitive["material"])
            if len(indices) % 3 or indices.max() >= len(pos):
                found.append(f"{label}: bad indices")
                continue
            textured = "baseColorTexture" in material["pbrMetallicRoughness"]
            check_primitive(label, pos, nrm, tan, uv, indices.reshape(-1, 3),
                            REPEAT_M.get(material["name"], 2.0) if textured else None, found)
            triangles, vertices = triangles + len(indices) // 3, vertices + len(pos)
    for i, material in enumerate(doc["materials"]):
        if i not in used:
            found.append(f"material {material['name']} is not used")
    for image in doc["images"]:
        view = doc["bufferViews"][image["bufferView"]]
        problem = png_problem(blob[view["byteOffset"]:view["byteOffset"] + view["byteLength"]])
        if problem:
            found.append(f"image {image['name']}: {problem}")
    lights = doc["extensions"]["KHR_lights_punctual"]["lights"]
    names = [node["name"] for node in doc["nodes"]]
    for want, have in (("Grenade", names), ("camera_yard", names)):
        if want not in have:
            found.append(f"no node {want}")
    if len(lights) < 5:
        found.append(f"only {len(lights)} lights")
    print(f"{len(data)} bytes, {len(doc['nodes'])} nodes, {len(doc['meshes'])} meshes, {triangles} triangles, "
          f"{vertices} vertices, {len(doc['materials'])} materials, {len(doc['images'])} images, {len(lights)} lights")


def check_solids(scene, found):
    """Every object is made of closed surfaces, wound outward."""
    for name, solid, *_ in scene.objects + [("Grenade", scene.grenade)]:
        pos, tri, base = [], [], 0
        for _, p, _, _, _, idx in solid.arrays():
            pos.append(p)
            tri.append(idx.reshape(-1, 3) + base)
            base += len(p)
        pos, tri = np.concatenate(pos), np.concatenate(tri)
        welded = weld(pos, tri)
        gaps = open_edges(welded)
        if gaps:
            found.append(f"{name}: {gaps} open edges")
        inward = sum(v <= 0 for v in signed_volumes(pos, tri, welded))
        if inward:
            found.append(f"{name}: {inward} surfaces wound inward")


def check_grid(scene, found):
    """No face of a wall or a floor lies on an edge of the timeline's voxels, where one side would be a toss-up."""
    cell, origin = 0.25, np.array([-14.1, -0.35, -12.1])
    for name, solid, *_ in scene.objects:
        if not name.startswith(("wing_f", "wing_b", "wing_w", "wing_c", "tower_f", "tower_b", "tower_e", "tower_w",
                                "partition", "loft")):
            continue
        for _, pos, nrm, _, _, _ in solid.arrays():
            for axis in range(3):
                at = (pos[abs(nrm[:, axis]) > 0.999, axis] - origin[axis]) / cell
                near = abs(at - np.round(at)) * cell
                if (near < 0.009).any():
                    bad = pos[abs(nrm[:, axis]) > 0.999, axis][near < 0.009][0]
                    found.append(f"{name}: a face at {'xyz'[axis]} = {bad:.3f} lies on a voxel's edge")


def alike(a, b):
    """Whether two parts of glTF documents are the same but for the last bits of numbers."""
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(alike(a[key], b[key]) for key in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(map(alike, a, b))
    if isinstance(a, float) or isinstance(b, float):
        return isinstance(a, (int, float)) and isinstance(b, (int, float)) and abs(a - b) <= 1e-6 * max(1, abs(a))
    return a == b


def check_stale(data, stored, found):
    """The file is what the script makes. Pixels are left out: their last bits depend on the machine's FFT and zlib, as
    those of numbers do on its mathematical functions."""
    (doc, blob), (old_doc, old_blob) = read_glb(data), read_glb(stored)
    parts = ("nodes", "materials", "meshes", "cameras", "extensions")
    same = all(alike(doc.get(part), old_doc.get(part)) for part in parts) and \
        len(doc["accessors"]) == len(old_doc["accessors"]) and \
        [image["name"] for image in doc.get("images", [])] == [image["name"] for image in old_doc.get("images", [])]
    for i in range(len(doc["accessors"]) if same else 0):
        new, old = accessor(doc, blob, i), accessor(old_doc, old_blob, i)
        same = same and new.shape == old.shape and np.allclose(new, old, rtol=0, atol=1e-5)
    if not same:
        found.append("the stored file differs from what the script makes; run the script")


def run(scene, data, path):
    found = []
    check_file(data, found)
    check_solids(scene, found)
    check_grid(scene, found)
    if not os.path.exists(path):
        found.append(f"{path} is missing; run make_demo.py")
    else:
        with open(path, "rb") as stored:
            check_stale(data, stored.read(), found)
    for line in found:
        print("problem:", line)
    return 1 if found else 0
