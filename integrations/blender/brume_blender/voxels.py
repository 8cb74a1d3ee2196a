"""Shows solid voxels as a mesh: those of the open scene, or of an OBJ file from `brume voxelize --obj`."""

import json
import os

import bpy
import numpy as np
from bpy.props import StringProperty
from bpy_extras.io_utils import ImportHelper

from . import conversion
from .export_level import EXTENSIONS, export
from .job_operator import JobOperator
from .messages import BrumeError, fail

OBJECT_NAME = "Brume voxels"


def _read_quads(path):
    """Reads points and faces of an OBJ file from `brume voxelize`, which has only `v` and `f` lines."""
    points, faces = [], []
    try:
        with open(path, encoding="ascii") as file:
            for number, line in enumerate(file, 1):
                words = line.split()
                if words and words[0] == "v":
                    points.append([float(word) for word in words[1:4]])
                elif words and words[0] == "f":
                    faces.append([int(word) - 1 for word in words[1:]])
                elif words and not words[0].startswith("#"):
                    raise BrumeError(f"{path}:{number}: expected voxels written by brume voxelize --obj")
    except OSError as error:
        raise BrumeError(f"{path}: {error.strerror}") from error
    except ValueError as error:
        raise BrumeError(f"{path}: expected voxels written by brume voxelize --obj: {error}") from error
    if not points or any(len(face) < 3 or not 0 <= min(face) <= max(face) < len(points) for face in faces):
        raise BrumeError(f"{path}: expected voxels written by brume voxelize --obj")
    return np.array(points), faces


def add_voxels(context, path):
    """Adds the voxels as an object with the role Not exported, in Blender's axes and units."""
    points, faces = _read_quads(path)
    points = points @ conversion.BRUME_FROM_BLENDER / conversion.metres_per_unit(context.scene)
    mesh = bpy.data.meshes.new(OBJECT_NAME)
    mesh.from_pydata(points.tolist(), [], faces)
    mesh.update()
    voxels = bpy.data.objects.new(OBJECT_NAME, mesh)
    voxels.brume.role = "LEFT_OUT"
    voxels.display_type = "WIRE"
    voxels.hide_render = True
    context.scene.collection.objects.link(voxels)
    return voxels


class BRUME_OT_voxels(JobOperator, bpy.types.Operator):
    """Show the voxels of the scene that block smoke"""

    bl_idname = "brume.voxels"
    bl_label = "Show Voxels"
    bl_options = {"REGISTER", "UNDO"}

    def arguments(self, context, folder):
        options = context.scene.brume
        level = os.path.join(folder, "level" + EXTENSIONS[options.format])
        written = export(context, level, options.format, self._warnings, with_timeline=False).path
        edge = conversion.number(options.voxel)
        return ["voxelize", written, "--voxel", edge, "--obj", "voxels.obj", "--json", "-"]

    def finish(self, context, folder, out):
        result = json.loads(out)
        voxels = add_voxels(context, os.path.join(folder, "voxels.obj"))
        voxels["solid"] = result["solid"]
        self.report({"INFO"}, "{} voxels of {}x{}x{} are solid".format(result["solid"], *result["grid"]))


class BRUME_OT_import_voxels(bpy.types.Operator, ImportHelper):
    """Import voxels written by brume voxelize --obj"""

    bl_idname = "brume.import_voxels"
    bl_label = "Import Brume Voxels"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".obj"
    filter_glob: StringProperty(default="*.obj", options={"HIDDEN"})

    def execute(self, context):
        try:
            add_voxels(context, bpy.path.abspath(self.filepath))
        except BrumeError as error:
            return fail(self, error)
        return {"FINISHED"}


def _menu(self, _context):
    self.layout.operator(BRUME_OT_import_voxels.bl_idname, text="Brume Voxels (.obj)")


def register():
    bpy.utils.register_class(BRUME_OT_voxels)
    bpy.utils.register_class(BRUME_OT_import_voxels)
    bpy.types.TOPBAR_MT_file_import.append(_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(_menu)
    bpy.utils.unregister_class(BRUME_OT_import_voxels)
    bpy.utils.unregister_class(BRUME_OT_voxels)
