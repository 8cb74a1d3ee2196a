"""Exports the open scene as a scene file and a timeline."""

import os
import tempfile
from dataclasses import dataclass

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from . import checks, export_gltf, export_txt, program, timeline
from .clock import Clock, events_of
from .level import Gathered
from .messages import BrumeError, Warnings, fail
from .solids import Solids

EXTENSIONS = {"GLTF": ".glb", "TXT": ".txt"}


@dataclass
class Exported:
    path: str  # Of the timeline; without a timeline that of the scene file.
    clock: Clock


def _tone(context, warnings):
    """The tone of the timeline, or None if the installed program has only its own."""
    tone, shown = context.scene.brume.tone, context.scene.view_settings.view_transform
    try:
        known = program.render_has(program.find(context), "--tone")
    except (BrumeError, OSError):
        known = False
    if tone == "standard" and not known:
        warnings.note("this brume has no tone Standard: its shadows are darker than Blender's")
    elif tone == "standard" and shown != "Standard":
        warnings.note(f'tones are those of Standard, Blender shows "{shown}" (Render Properties > Color Management)')
    return tone if known else None


def check(context, warnings):
    """Adds the messages of an export, without a file. Raises BrumeError."""
    file_format = context.scene.brume.format
    with tempfile.TemporaryDirectory(prefix="brume_") as folder:
        path = os.path.join(folder, "level" + EXTENSIONS[file_format])
        # Blender's exporter of glTF has no messages for the sidebar.
        export(context, path, file_format, warnings, with_level=file_format != "GLTF")


def export(context, path, file_format, warnings, with_timeline=True, frames=(), with_level=True):
    """Writes the level to `path`, whose extension must match the format, and the timeline next to it as .toml.

    The timeline includes `frames` even if they are before the first frame of the scene. Raises BrumeError.
    """
    stem, _ = os.path.splitext(path)
    with Gathered(context, warnings) as level:
        if not level.things and not (level.volumes and with_timeline):
            raise BrumeError("the scene has no visible mesh; add one that renders and is exported")
        solids = Solids(level)
        checks.check_level(level, solids, warnings)
        if not with_level:
            pass
        elif file_format == "GLTF":
            camera = context.scene.camera
            perspective = camera and camera.type == "CAMERA" and camera.data.type == "PERSP"
            export_gltf.export(context, path, level, camera if perspective else None)
        else:
            export_txt.export(path, level, warnings)
        starts = [thing.brume_event.frame for thing in events_of(context.scene) if thing in level.rendered]
        with Clock(context, [*starts, *frames]) as clock:
            if not with_timeline:
                return Exported(path, clock)
            checks.check_events(context.scene, level, solids, clock, warnings)
            writer = timeline.Writer(context, level, clock, os.path.dirname(path), warnings)
            writer.write(stem + ".toml", os.path.basename(path), _tone(context, warnings))
        return Exported(stem + ".toml", clock)


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
        description="File format of the level; a typed .glb or .txt chooses it too",
    )
    # The format at the last check(), which reveals whether the user changed the format or the name.
    checked_format: StringProperty(options={"HIDDEN", "SKIP_SAVE"})
    with_timeline: BoolProperty(
        name="Timeline", default=True, description="Write camera and events to a .toml file next to it"
    )

    def invoke(self, context, event):
        self.filename_ext = EXTENSIONS[self.format]
        self.checked_format = self.format
        return super().invoke(context, event)

    def check(self, _context):
        """Keeps format and file extension in line: the one that the user changed last determines the other."""
        before = self.filepath, self.format
        stem, extension = os.path.splitext(self.filepath)
        typed = [kind for kind, own in EXTENSIONS.items() if own == extension.lower()]
        if typed and self.format in (self.checked_format or self.format, typed[0]):
            self.format = typed[0]
        else:
            # An unknown extension is a part of the name.
            self.filepath = (stem if typed else self.filepath) + EXTENSIONS[self.format]
        self.checked_format = self.format
        return before != (self.filepath, self.format)

    def execute(self, context):
        warnings = Warnings()
        self.check(context)
        try:
            written = export(context, bpy.path.abspath(self.filepath), self.format, warnings, self.with_timeline)
        except BrumeError as error:
            return fail(self, error, warnings.messages)
        self.report({"INFO"}, "Wrote " + written.path)
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
