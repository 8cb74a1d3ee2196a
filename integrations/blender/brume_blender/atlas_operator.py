"""Base of operators that bake the selected objects into a slice atlas: an image whose tiles are slices of a volume."""

import json
import os

import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from . import export_gltf, image_editor
from .job_operator import JobOperator
from .messages import BrumeError, Warnings
from .names import safe
from .selection import Selected, selected

_MESH_FILE = "selection.glb"  # In the folder that the program runs in, so that its messages are short.
_EXTENSIONS = {"PNG8": ".png", "PNG16": ".png", "EXR16": ".exr", "EXR32": ".exr"}


def _load(path):
    """Loads or reloads an image of numbers."""
    image = bpy.data.images.load(path, check_existing=True)
    image.reload()
    image.colorspace_settings.name = "Non-Color"
    image.alpha_mode = "CHANNEL_PACKED"
    return image


class AtlasOperator(JobOperator, ExportHelper):
    """A subclass defines `ending`, of the name of the file, and bake_arguments(level)."""

    filename_ext = ".png"
    filter_glob: StringProperty(default="*.png;*.exr", options={"HIDDEN"})
    depth: EnumProperty(
        items=(
            ("PNG8", "PNG, 8 bits", "Values in 255 steps"),
            ("PNG16", "PNG, 16 bits", "Values in 65,535 steps"),
            ("EXR16", "OpenEXR, 16 bits", "Half floats"),
            ("EXR32", "OpenEXR, 32 bits", "Floats"),
        ),
        name="Format",
        description="File format of the image; a typed .png or .exr chooses it too",
    )
    # The format at the last check(), which reveals whether the user changed the format or the name.
    checked_depth: StringProperty(options={"HIDDEN", "SKIP_SAVE"})
    preset: EnumProperty(
        items=(
            ("NONE", "None", "Slices seen from the front; those of occlusion from above"),
            ("unreal", "Unreal Engine", "Axes and tiles of a Volume Texture"),
            ("unity", "Unity", "Axes and tiles of a texture of the shape 3D"),
            ("godot", "Godot", "Axes and tiles of a Texture3D, and import settings beside the image"),
            ("houdini", "Houdini", "Axes and tiles for a volume that reads the image"),
        ),
        name="Engine",
        description="Program that imports the image",
    )
    layout_of_tiles: EnumProperty(
        items=(
            ("AUTO", "Automatic", "A strip if it is short enough; near a square with an engine"),
            ("strip", "Strip", "All tiles in a row"),
            ("square", "Square", "As near to a square as the tiles allow"),
            ("COLUMNS", "Columns", "A chosen number of tiles in a row"),
        ),
        name="Layout",
        description="Where the tiles are in the image",
    )
    columns: IntProperty(name="Columns", default=8, min=1, max=16384, description="Tiles in a row")
    padding: IntProperty(name="Padding", default=0, min=0, max=64, description="Texels around each tile that mirror it")

    _job = None
    _in_browser = False

    def invoke(self, context, _event):
        """Opens a file browser, which calls execute()."""
        self._warnings = Warnings()
        try:
            selected(context)
        except BrumeError as error:
            return self._failed(error)
        folder = os.path.dirname(self.filepath) or os.path.dirname(bpy.data.filepath)
        self.filepath = os.path.join(folder, self._default_name(context))
        self.checked_depth, self._in_browser = self.depth, True
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def _default_name(self, context):
        chosen = selected(context)
        first = context.active_object if context.active_object in chosen else chosen[0]
        return safe(first.name) + self.ending + _EXTENSIONS[self.depth]

    def check(self, _context):
        """Keeps format and file extension in line: the one that the user changed last determines the other."""
        before = self.filepath, self.depth
        stem, extension = os.path.splitext(self.filepath)
        typed = {".png": "PNG8", ".exr": "EXR16"}.get(extension.lower())
        if typed and self.depth == (self.checked_depth or self.depth):
            if _EXTENSIONS[self.depth] != extension.lower():
                self.depth = typed
        else:
            # An unknown extension is a part of the name.
            self.filepath = (stem if typed else self.filepath) + _EXTENSIONS[self.depth]
        self.checked_depth = self.depth
        return before != (self.filepath, self.depth)

    def execute(self, context):
        """Beside the file browser in the background, else blocking."""
        if self._in_browser:
            return JobOperator.invoke(self, context, None)
        return super().execute(context)

    def cancel(self, context):
        if self._job:
            super().cancel(context)

    def draw(self, _context):
        self.layout.use_property_split, self.layout.use_property_decorate = True, False
        self.draw_bake(self.layout.column())
        column = self.layout.column()
        for name in ("depth", "preset", "layout_of_tiles"):
            column.prop(self, name)
        if self.layout_of_tiles == "COLUMNS":
            column.prop(self, "columns")
        column.prop(self, "padding")

    def images(self):
        """The files of the images."""
        return [self._target]

    def arguments(self, context, folder):
        if not self.filepath:
            if not bpy.data.filepath:
                raise BrumeError("save the .blend file first, or choose a file: the image is written beside it")
            self.filepath = os.path.join(os.path.dirname(bpy.data.filepath), self._default_name(context))
        self.check(context)
        self._target = bpy.path.abspath(self.filepath)
        with Selected(context, self._warnings) as level:
            arguments = self.bake_arguments(level)
            export_gltf.export(context, os.path.join(folder, _MESH_FILE), level, None, only_shapes=True)
        kind, *options = arguments
        arguments = ["bake", kind, _MESH_FILE, "-o", self._target, "--bits", self.depth[3:], *options, "--json", "-"]
        if self.preset != "NONE":
            arguments += ["--preset", self.preset]
        if self.layout_of_tiles != "AUTO":
            arguments += ["--layout", str(self.columns) if self.layout_of_tiles == "COLUMNS" else self.layout_of_tiles]
        return arguments + (["--padding", str(self.padding)] if self.padding else [])

    def finish(self, _context, _folder, out):
        result = json.loads(out)
        try:
            loaded = [_load(path) for path in self.images()]
        except RuntimeError as error:
            raise BrumeError(str(error).strip().splitlines()[-1]) from error
        size = "{} tiles of {}x{} texels".format(result["tiles"], *result["tile"])
        self.report({"INFO"}, f"Wrote {self._target}: {size}")
        if not bpy.app.background:
            image_editor.show(loaded[0].name, [image.name for image in loaded])
