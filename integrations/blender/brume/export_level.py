"""Exports the open scene as a scene file and a timeline."""

import os

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from . import export_gltf, export_txt, timeline
from .level import Gathered
from .messages import BrumeError, Warnings

EXTENSIONS = {"GLTF": ".glb", "TXT": ".txt"}


def export(context, path, file_format, warnings, with_timeline=True):
    """Writes the level to `path`, whose extension must match the format, and the timeline next to it as .toml.

    Returns the path of the timeline, or that of the scene file without a timeline. Raises BrumeError.
    """
    stem, _ = os.path.splitext(path)
    with Gathered(context, warnings) as level:
        if not level.things:
            raise BrumeError("the scene has no visible mesh; add one that renders and is exported")
        if file_format == "GLTF":
            camera = context.scene.camera
            perspective = camera and camera.type == "CAMERA" and camera.data.type == "PERSP"
            export_gltf.export(context, path, level, camera if perspective else None)
        else:
            export_txt.export(path, level, warnings)
        if not with_timeline:
            return path
        writer = timeline.Writer(context, level, os.path.dirname(path), warnings)
        writer.write(stem + ".toml", os.path.basename(path))
        return stem + ".toml"


class BRUME_OT_export_level(bpy.types.Operator, ExportHelper):
    """Export the scene as a level for Brume, with its timeline"""

    bl_idname = "brume.export_level"
    bl_label = "Export Brume Level"

    filename_ext = ".glb"
    filter_glob: StringProperty(default="*.glb;*.txt", options={"HIDDEN"})
    format: EnumProperty(
        items=(
            ("GLTF", "glTF (.glb)", "One file: all lights, materials and the camera"),
            ("TXT", "Scene.txt", "One line per object, with the folders Meshes and Textures next to it"),
        ),
        name="Format",
        description="File format of the level",
    )
    with_timeline: BoolProperty(
        name="Timeline", default=True, description="Write camera and events to a .toml file next to it"
    )

    def check(self, _context):
        """Keeps the file extension in line with the format."""
        expected = os.path.splitext(self.filepath)[0] + EXTENSIONS[self.format]
        changed, self.filepath = expected != self.filepath, expected
        return changed

    def execute(self, context):
        warnings = Warnings()
        self.check(context)
        try:
            written = export(context, bpy.path.abspath(self.filepath), self.format, warnings, self.with_timeline)
        except BrumeError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, "Wrote " + written)
        warnings.report(self)
        return {"FINISHED"}


def _menu(self, _context):
    self.layout.operator(BRUME_OT_export_level.bl_idname, text="Brume Level (.glb, .txt)")


def register():
    bpy.utils.register_class(BRUME_OT_export_level)
    bpy.types.TOPBAR_MT_file_export.append(_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(_menu)
    bpy.utils.unregister_class(BRUME_OT_export_level)
