"""glTF export: runs Blender's exporter on a temporary scene whose objects have plain transforms in metres."""

import json
import os
import struct
import tempfile

import bpy
import numpy as np
from mathutils import Matrix

from . import conversion, files, gltf_materials, meshes
from .level import AREA_BLEND, WIDEST_SPOT, spot_for_area
from .messages import BrumeError
from .properties import BRUME_ROLES

# All settings that affect the result; some versions of the exporter lack or rename some of them.
_SETTINGS = {
    "export_format": "GLB",
    "check_existing": False,
    "will_save_settings": False,
    "use_selection": False,
    "use_visible": False,
    "use_renderable": False,
    "use_active_collection": False,
    "use_active_scene": True,
    "export_yup": True,
    "export_apply": False,  # The meshes are evaluated already.
    "export_materials": "EXPORT",
    "export_image_format": "AUTO",
    "export_texcoords": True,
    "export_normals": True,
    "export_tangents": False,
    "export_cameras": True,
    "export_lights": True,
    # Candela and lux, at 683 lm/W, by which Brume divides.
    "convert_lighting_mode": "SPEC",
    "export_import_convert_lighting_mode": "SPEC",
    "export_extras": False,
    "export_animations": False,
    "export_skins": False,
    "export_morph": False,
    "export_draco_mesh_compression_enable": False,
}


# What differs for shapes alone: without normals a corner of the mesh is one point of the file.
_SHAPES = {"export_materials": "NONE", "export_texcoords": False, "export_normals": False}


def _blender_matrix(world_from_mesh):
    """Converts back to Blender's axes, still in metres."""
    turn = np.identity(4)
    turn[:3, :3] = conversion.BRUME_FROM_BLENDER
    return Matrix((turn.T @ world_from_mesh @ turn).tolist())


class _TemporaryScene:
    """A scene with copies of the exported objects, removed after the export."""

    def __init__(self, scene, only_shapes):
        self._made, self._only_shapes = [], only_shapes
        self._materials, self.material_names = {}, {}  # Stand-ins, and whose names they get.
        self.scene = bpy.data.scenes.new("brume export")
        self.names, self.roles = {}, {}
        render, own = self.scene.render, scene.render
        for setting in ("resolution_x", "resolution_y", "pixel_aspect_x", "pixel_aspect_y"):
            setattr(render, setting, getattr(own, setting))

    def remove(self):
        bpy.data.scenes.remove(self.scene)
        bpy.data.batch_remove(self._made)

    def _add(self, data, matrix, name):
        made = bpy.data.objects.new(f"brume {len(self._made)}", data)
        self._made.append(made)
        self.scene.collection.objects.link(made)
        made.rotation_mode = "QUATERNION"
        made.matrix_world = matrix
        self.names[made.name] = name
        return made

    def _material(self, material):
        """A material that the exporter can read."""
        if material is None or self._only_shapes:
            return material
        if material not in self._materials:
            made = gltf_materials.stand_in(material)
            if made:
                made.name = f"brume {len(self._made)}"
                self._made.append(made)
                self.material_names[made.name] = material.name
            self._materials[material] = made or material
        return self._materials[material]

    def add_piece(self, piece, thing):
        for index, material in enumerate(piece.mesh.materials):
            # A copy of the level; replaced already if another object has it.
            if material and material.name not in self.material_names:
                piece.mesh.materials[index] = self._material(material.original)
        mesh, matrix = piece.mesh, _blender_matrix(piece.world_from_mesh)
        linear = np.array(matrix)[:3, :3]
        if not conversion.has_orthogonal_columns(linear):
            # Sheared by a parent: scale and rotation of a node cannot represent it, so bake it into the points.
            # A reflection stays in the node, so that the winding of the faces is preserved.
            mesh = mesh.copy()
            self._made.append(mesh)
            side = Matrix.Scale(-1 if np.linalg.det(linear) < 0 else 1, 4, (1, 0, 0))
            meshes.bend(mesh, side @ matrix)
            matrix = side
        made = self._add(mesh, matrix, thing.name)
        for slot, material in zip(made.material_slots, map(self._material, piece.materials)):
            if slot.material != material:
                slot.link = "OBJECT"
                slot.material = material
        if thing.role in BRUME_ROLES:
            self.roles[made.name] = BRUME_ROLES[thing.role]

    def add_light(self, light):
        data = light.data.copy()
        self._made.append(data)
        data.use_nodes = False
        data.energy, data.color = light.power, light.color
        if data.type == "AREA":
            data.type = "SPOT"
            data = bpy.data.lights[data.name]  # Changing the type changes the Python class.
            data.spot_size, data.spot_blend = WIDEST_SPOT, AREA_BLEND
            data.energy = spot_for_area(light.power)
        if data.type == "SPOT":
            data.spot_size = min(data.spot_size, WIDEST_SPOT)
        self._add(data, _blender_matrix(light.world_from_light), light.data.name)

    def add_camera(self, camera, metres):
        data = camera.data.copy()
        self._made.append(data)
        matrix = conversion.matrix(camera.matrix_world, metres)
        self.scene.camera = self._add(data, _blender_matrix(matrix), camera.name)


def _run_exporter(context, scene, path, chosen):
    operator = getattr(bpy.ops.export_scene, "gltf", None)
    try:
        known = set(operator.get_rna_type().properties.keys())
    except (AttributeError, KeyError) as error:
        raise BrumeError('the add-on "glTF 2.0 format" is disabled; enable it in the preferences') from error
    window, before = context.window, context.scene
    if window:
        window.scene = scene
    try:
        with context.temp_override(scene=scene, view_layer=scene.view_layers[0]):
            scene.view_layers[0].update()
            settings = {key: value for key, value in chosen.items() if key in known}
            operator("EXEC_DEFAULT", filepath=path, **settings)
    except RuntimeError as error:
        raise BrumeError(f"Blender's glTF exporter failed: {str(error).strip().splitlines()[-1]}") from error
    finally:
        if window:
            window.scene = before


def _json_and_rest(data):
    """Splits a GLB into its JSON and the remaining chunks (glTF 2.0, section 4.4)."""
    length, kind = struct.unpack_from("<II", data, 12)
    if data[:4] != b"glTF" or kind != 0x4E4F534A:
        raise BrumeError("Blender's glTF exporter did not write a GLB file")
    return json.loads(data[20 : 20 + length]), data[20 + length :]


def _glb(document, rest):
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    size = 20 + len(text) + len(rest)
    return struct.pack("<4sIIII", b"glTF", 2, size, len(text), 0x4E4F534A) + text + rest


def _set_names(document, temporary):
    """Sets Brume's object names and roles, and the names of materials."""
    for material in document.get("materials", []):
        material["name"] = temporary.material_names.get(material.get("name"), material.get("name", ""))
    shapes = document.get("meshes", [])
    for node in document.get("nodes", []):
        made = node.get("name", "")
        if made not in temporary.names:
            continue
        node["name"] = temporary.names[made]
        if made in temporary.roles:
            node["extras"] = {"brume_role": temporary.roles[made]}
        if "mesh" in node:
            # The original mesh name could give a role or make it the grenade for all objects that share it.
            shapes[node["mesh"]]["name"] = "mesh of " + temporary.names[made]


def export(context, path, level, camera, only_shapes=False):
    """Writes a GLB: meshes, materials, textures, lights (KHR_lights_punctual), the camera; or only points and faces."""
    temporary = _TemporaryScene(context.scene, only_shapes)
    try:
        for thing in level.things:
            for piece in thing.pieces:
                temporary.add_piece(piece, thing)
        for light in level.lights:
            temporary.add_light(light)
        if camera:
            temporary.add_camera(camera, level.metres)
        with tempfile.TemporaryDirectory(prefix="brume_") as folder:
            written = os.path.join(folder, "level.glb")
            _run_exporter(context, temporary.scene, written, _SETTINGS | (_SHAPES if only_shapes else {}))
            with open(written, "rb") as file:
                document, rest = _json_and_rest(file.read())
    finally:
        temporary.remove()
    _set_names(document, temporary)
    files.write(path, _glb(document, rest))
