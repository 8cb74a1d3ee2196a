"""Scene.txt export, with Meshes/*.obj and Textures/*_diffuse.png: one line per object or light."""

import hashlib
import os

import numpy as np

from . import conversion, files, meshes, names, textures
from .conversion import number


class _Part:
    """The triangles of a piece with one material, as arrays by corner."""

    def __init__(self, positions, normals, uvs, material):
        self.positions, self.normals, self.uvs, self.material = positions, normals, uvs, material
        self._key = None

    def turned(self, linear):
        """Applies a 3x3 matrix; reverses the winding under a reflection, so that faces stay outward."""
        normals = self.normals @ meshes.cofactors(linear).T
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = np.where(lengths > 1e-30, normals / np.maximum(lengths, 1e-30), self.normals)
        positions, uvs = self.positions @ linear.T, self.uvs
        if np.linalg.det(linear) < 0:
            order = np.arange(len(positions)).reshape(-1, 3)[:, ::-1].ravel()
            positions, normals, uvs = positions[order], normals[order], uvs[order]
        return _Part(positions, normals, uvs, self.material)

    def key(self):
        """A hash of the geometry, to share equal meshes."""
        if self._key is None:
            arrays = (array.astype(np.float32).tobytes() for array in (self.positions, self.normals, self.uvs))
            self._key = hashlib.sha256(b"".join(arrays)).digest()
        return self._key


def _parts_of(piece):
    """Splits the mesh of a piece by material; in mesh space with Brume's axes."""
    mesh = piece.mesh
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    corners, slots = np.empty(3 * count, dtype=np.int32), np.empty(count, dtype=np.int32)
    mesh.loop_triangles.foreach_get("loops", corners)
    mesh.loop_triangles.foreach_get("material_index", slots)
    points = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", points)
    of_corner = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", of_corner)
    uvs = np.zeros((len(mesh.loops), 2), dtype=np.float32)
    layer = next((layer for layer in mesh.uv_layers if layer.active_render), None)
    if layer:
        flat = np.empty(2 * len(mesh.loops), dtype=np.float32)
        layer.data.foreach_get("uv", flat)
        uvs = flat.reshape(-1, 2)

    turn = conversion.BRUME_FROM_BLENDER.T
    positions = points.reshape(-1, 3).astype(float)[of_corner] @ turn
    normals = meshes.corner_normals(mesh).astype(float) @ turn
    materials = piece.materials or [None]
    slots = np.clip(slots, 0, len(materials) - 1)
    parts = {}
    for slot in np.unique(slots):
        taken = corners.reshape(-1, 3)[slots == slot].ravel()
        material = materials[slot]
        part = _Part(positions[taken], normals[taken], uvs[taken].astype(float), material)
        parts.setdefault(material, []).append(part)
    return [_joined(same, material) for material, same in parts.items()]


def _joined(parts, material):
    if len(parts) == 1:
        return parts[0]
    arrays = (np.concatenate([getattr(part, name) for part in parts]) for name in ("positions", "normals", "uvs"))
    return _Part(*arrays, material)


def _unique_rows(values):
    """The sorted unique rows of an array as float32, and the index of each row among them."""
    values = values.astype(np.float32)
    order = np.lexsort(values.T[::-1])
    in_order = values[order]
    is_first = np.ones(len(values), dtype=bool)
    is_first[1:] = (in_order[1:] != in_order[:-1]).any(axis=1)
    index = np.empty(len(values), dtype=np.int64)
    index[order] = np.cumsum(is_first) - 1
    return in_order[is_first], index


def _obj_text(part):
    """OBJ text with unique positions, texture coordinates and normals."""
    lines, columns = ["# Metres or units of the scene file, Y up"], []
    for keyword, values in (("v", part.positions), ("vt", part.uvs), ("vn", part.normals)):
        unique, index = _unique_rows(values)
        form = keyword + " {:.9g}" * unique.shape[1]
        lines += [form.format(*row) for row in unique.tolist()]
        columns.append(index + 1)
    for face in np.stack(columns, axis=1).reshape(-1, 9).tolist():
        lines.append("f {}/{}/{} {}/{}/{} {}/{}/{}".format(*face))
    return "\n".join(lines) + "\n"


# How names begin that give their objects a role.
_PREFIXES = {"PASSABLE": "IGNORE_", "GLASS": "GLASS_", "GRILLE": "GRILLE_"}


class _Writer:
    def __init__(self, folder, level, warnings):
        self._folder, self._level, self._warnings = folder, level, warnings
        self._mesh_names, self._written, self._materials, self._known_parts = {}, {}, {}, {}
        # Names of parts must not collide with those of things.
        self._part_names = names.UniqueNames(thing.name for thing in level.things)
        self._material_names = names.UniqueNames()
        self.lines = ["# Name\tPosition\tRotation\tScale\tMaterial\tRoughness"]

    def add(self, thing):
        if thing.role == "DOOR" or thing.name == "Grenade":
            self._add_as_one(thing)
            return
        parts = self._parts(thing.pieces[0])
        for part in parts:
            name = thing.name
            if len(parts) > 1:
                name = f"{thing.name}.{names.safe(part.material.name if part.material else 'plain')}"
                name = self._part_names.take(name)
            prefix = _PREFIXES.get(thing.role, "")
            if thing.role == "SOLID" and textures.look_of(part.material).is_glass:
                prefix = _PREFIXES["GLASS"]
            if not name.startswith(prefix):
                name = prefix + name
            self._place(part, thing.pieces[0].world_from_mesh, name, shared=True)

    def _parts(self, piece):
        key = (piece.mesh, tuple(piece.materials))
        if key not in self._known_parts:
            self._known_parts[key] = _parts_of(piece)
        return self._known_parts[key]

    def _add_as_one(self, thing):
        """Writes a single mesh with one material: Scene.txt identifies a door or grenade by the name of one line."""
        origin = thing.pieces[0].world_from_mesh.copy()
        parts = []
        for piece in thing.pieces:
            offset = piece.world_from_mesh[:3, 3] - origin[:3, 3]
            for part in self._parts(piece):
                turned = part.turned(piece.world_from_mesh[:3, :3])
                turned.positions = turned.positions + offset
                parts.append(turned)
        origin[:3, :3] = np.identity(3)
        found = list({part.material: None for part in parts})
        if len(found) == 1:
            self._place(_joined(parts, found[0]), origin, thing.name, shared=False)
            return
        looks = [textures.look_of(material) for material in found]
        if any(look.image for look in looks):
            self._warnings.add(f'"{thing.name}" has several materials; Scene.txt stores only their mean colours')
        for part in parts:
            tile = found.index(part.material)
            part.uvs = np.tile([(tile + 0.5) / len(found), 0.5], (len(part.uvs), 1))
        material = self._material_names.take(thing.name + "_colours")
        tiles = textures.plain_png([look.mean_color() for look in looks])
        files.write(os.path.join(self._folder, "Textures", material + "_diffuse.png"), tiles)
        roughness = sum(look.roughness for look in looks) / len(looks)
        self._place(_joined(parts, None), origin, thing.name, shared=False, look=(material, roughness))

    def _place(self, part, world_from_mesh, name, shared, look=None):
        linear = world_from_mesh[:3, :3]
        scale_and_angles = conversion.scale_and_angles(linear)
        if scale_and_angles is None:
            part, scale_and_angles = part.turned(linear), (np.ones(3), np.zeros(3))
        if shared:
            key = (part.key(), next((prefix for prefix in _PREFIXES.values() if name.startswith(prefix)), ""))
            name = self._mesh_names.setdefault(key, name)
        if name not in self._written:
            self._written[name] = True
            files.write(os.path.join(self._folder, "Meshes", name + ".obj"), _obj_text(part))
        material, roughness = look or self._material(part.material)
        vectors = (world_from_mesh[:3, 3], scale_and_angles[1], scale_and_angles[0])
        fields = [name] + [" ".join(number(value) for value in vector) for vector in vectors]
        self.lines.append("\t".join(fields + [material, number(roughness)]))

    def _material(self, material):
        """The name and roughness of a material; writes its texture on first use."""
        if material in self._materials:
            return self._materials[material]
        look = textures.look_of(material)
        name = self._material_names.take(names.safe(material.name if material else "plain", "material"))
        stored = textures.image_file(look.image) if look.image else None
        if look.image and not stored:
            self._warnings.add(f'the image "{look.image.name}" has no pixels; its material is exported plain')
        extension, data = stored or (".png", textures.plain_png([look.color]))
        files.write(os.path.join(self._folder, "Textures", f"{name}_diffuse{extension}"), data)
        if extension == ".jpg":  # A PNG of an earlier export would take precedence.
            files.remove(os.path.join(self._folder, "Textures", f"{name}_diffuse.png"))
        self._materials[material] = (name, look.roughness)
        return self._materials[material]

    def add_light(self, light):
        """Writes a point light that emits `power` watts uniformly, the only kind that Scene.txt supports."""
        kind = light.data.type
        if kind == "SUN":
            self._warnings.add(f'the sun "{light.label}" is not exported: Scene.txt has no suns; use glTF')
            return
        if kind != "POINT":
            name = light.label
            self._warnings.add(f'the light "{name}" becomes a point light in Scene.txt; use glTF to keep its shape')
        values = [light.world_from_light[:3, 3], light.color, [light.power]]
        fields = [" ".join(number(value) for value in vector) for vector in values]
        self.lines.append("\t".join(["LIGHT_SOURCE"] + fields))


def export(path, level, warnings):
    """Writes the scene file and, next to it, the folders Meshes and Textures."""
    writer = _Writer(os.path.dirname(path), level, warnings)
    for thing in level.things:
        writer.add(thing)
    for light in level.lights:
        writer.add_light(light)
    files.write(path, "\n".join(writer.lines) + "\n")
