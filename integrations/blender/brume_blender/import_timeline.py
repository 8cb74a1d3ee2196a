"""Imports the events of a timeline, such as a session recorded in the viewer, as empties."""

import math
import os

import bpy
from bpy.props import StringProperty
from bpy_extras.io_utils import ImportHelper
from mathutils import Vector

from . import conversion, markers, names
from .clock import frames_per_second
from .event_operators import add_event
from .kinds import PROPERTIES, TYPES
from .messages import BrumeError, Warnings, fail
from .settings import EVENT_FIELDS

_COLLECTION = "Brume events"
_PLAIN = ("text", "open")  # Keys that are properties of the same name, besides numbers.


def _read(path):
    try:
        import tomllib
    except ImportError as error:
        raise BrumeError("importing timelines requires Python 3.11, which Blender has from 4.1 on") from error
    try:
        with open(path, "rb") as file:
            content = tomllib.load(file)
    except OSError as error:
        raise BrumeError(f"{path}: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise BrumeError(f"{path}: {error}") from error
    if content.get("version") != 1 or not isinstance(content.get("event", []), list):
        raise BrumeError(f"{path}: expected a timeline with version = 1")
    return content


class _Import:
    def __init__(self, context, path, warnings):
        self._context, self._scene, self._warnings = context, context.scene, warnings
        self._path, self._metres = path, conversion.metres_per_unit(context.scene)
        self._collection = bpy.data.collections.new(_COLLECTION)
        self.count = 0

    def run(self, content):
        skipped = {}
        for entry in content.get("event", []):
            kind = entry.get("type")
            if kind in TYPES:
                self._add(entry, kind)
            else:
                skipped[kind] = skipped.get(kind, 0) + 1
        for kind, count in skipped.items():
            self._warnings.add(f"{count} events of the type {kind} have no empty and are skipped")
        self._add_settings(content.get("smoke", {}), content.get("grid", {}))
        self._scene.collection.children.link(self._collection)

    def undo(self):
        bpy.data.batch_remove(self._collection.objects)
        bpy.data.collections.remove(self._collection)

    def _point(self, values):
        return Vector(conversion.BRUME_FROM_BLENDER.T @ [float(value) for value in values] / self._metres)

    def _add(self, entry, kind):
        frame = self._scene.frame_start + entry["time"] * frames_per_second(self._scene)
        empty = add_event(self._scene, self._collection, TYPES[kind], frame)
        event = empty.brume_event
        for key, setting in EVENT_FIELDS[kind].numbers.items():
            if key in entry:
                value = math.radians(entry[key]) if setting.unit == "degrees" else entry[key]
                setattr(event, PROPERTIES[kind, key], value)
        for key in _PLAIN:
            if key in entry:
                setattr(event, key, entry[key])
        place = {
            ("from", "at"): self._place_throw,
            ("from", "toward"): self._place_shot,
            ("at",): self._place_here,
            (): self._place_door,
        }
        place[EVENT_FIELDS[kind].points](empty, event, entry)
        self.count += 1

    def _place_throw(self, empty, event, entry):
        empty.location = self._point(entry["at"])
        if entry["from"] != entry["at"]:
            event.thrown_from = self._helper("Brume thrower", entry["from"])

    def _helper(self, name, values):
        made = bpy.data.objects.new(name, None)
        made.location, made.empty_display_size = self._point(values), 0.15 / self._metres
        self._collection.objects.link(made)
        return made

    def _place_shot(self, empty, event, entry):
        start, target = self._point(entry["from"]), self._point(entry["toward"])
        empty.location = start
        empty.rotation_euler = (target - start).to_track_quat("Z", "Y").to_euler()
        event.aim = self._helper("Brume aim", entry["toward"])
        event.shape = entry.get("shape", "cylinder").upper()
        event.mask = self._file(entry.get("mask"))
        event.font = self._file(entry.get("font"))

    def _place_here(self, empty, _event, entry):
        empty.location = self._point(entry["at"])

    def _place_door(self, empty, event, entry):
        for thing in self._scene.objects:
            exported = names.safe(thing.name)
            if thing.brume.role == "DOOR" and entry["object"] in (exported, "door_" + exported):
                event.door = thing
                empty.location = thing.matrix_world.translation
                return
        self._warnings.add(f'no door of the scene is called "{entry["object"]}"; choose one for "{empty.name}"')

    def _file(self, name):
        return os.path.join(os.path.dirname(self._path), name) if name else ""

    def _add_settings(self, smoke, grid):
        """The size of smokes; a timeline omits defaults."""
        options = self._scene.brume
        settings = {"smoke_" + key: smoke.get(key) for key in ("voxels", "bloom", "hold", "dissolve", "extinction")}
        for name, value in {**settings, "voxel": grid.get("voxel")}.items():
            if value is None:
                options.property_unset(name)
            else:
                setattr(options, name, value)


class BRUME_OT_import_timeline(bpy.types.Operator, ImportHelper):
    """Import the events of a timeline, such as a recording of the viewer, as empties"""

    bl_idname = "brume.import_timeline"
    bl_label = "Import Brume Timeline"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".toml"
    filter_glob: StringProperty(default="*.toml", options={"HIDDEN"})

    def execute(self, context):
        warnings, path = Warnings(), bpy.path.abspath(self.filepath)
        try:
            content = _read(path)
            work = _Import(context, path, warnings)
            try:
                work.run(content)
            except (KeyError, TypeError, ValueError) as error:
                work.undo()
                raise BrumeError(f"{path}: an event is incomplete or wrong: {error}") from error
        except BrumeError as error:
            return fail(self, error, warnings.messages)
        markers.synchronize(context.scene)
        self.report({"INFO"}, f"{work.count} events imported")
        warnings.report(self)
        return {"FINISHED"}


def _menu(self, _context):
    self.layout.operator(BRUME_OT_import_timeline.bl_idname, text="Brume Timeline (.toml)")


def register():
    bpy.utils.register_class(BRUME_OT_import_timeline)
    bpy.types.TOPBAR_MT_file_import.append(_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(_menu)
    bpy.utils.unregister_class(BRUME_OT_import_timeline)
