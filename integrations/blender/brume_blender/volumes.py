"""Volume objects as [[volume]] tables of a timeline: their files, places, sequences and looks."""

import os
import re

import bpy
import numpy as np

from . import files, names, volume_look
from .conversion import number
from .settings import SETTINGS
from .toml_text import quoted, vector

_VOLUME = SETTINGS["volume"]
_MOST = 32  # Volumes of a frame.
_FARTHEST = 1e6  # [m]
_LAST_FRAME = 1_000_000_000
_LATEST = _VOLUME["start"].high  # [s]
_COLORS = ("Cd", "color", "colour")  # Usual names of grids of colours.
# What Brume takes for the number of a frame in the name of a file.
_NUMBER = re.compile(r"%0?\d*d")


class _Skipped(Exception):
    """Why a volume is not exported."""


def _pattern_of(path):
    """The name of a sequence with %04d for its number, which Blender looks for before the suffix; None: no number."""
    stem, suffix = os.path.splitext(path)
    digits = re.search(r"\d+$", os.path.basename(stem))
    if not digits:
        return None
    return stem[: -len(digits[0])] + f"%0{len(digits[0])}d" + suffix


def _grids_of(path):
    """The names of the grids in a file. Raises _Skipped."""
    data = bpy.data.volumes.new("brume grids")
    try:
        data.filepath = path
        if not data.grids.load():
            raise _Skipped(f"{path} cannot be read: {data.grids.error_message or 'it is no OpenVDB file'}")
        return {grid.name for grid in data.grids}
    finally:
        bpy.data.volumes.remove(data)


class Tables:
    """Makes the tables of all volumes of a level. Files stay where they are; what has none is written to Volumes."""

    def __init__(self, level, clock, frames_per_second, folder, warnings):
        self._level, self._clock, self._rate = level, clock, frames_per_second
        self._folder, self._warnings = folder, warnings
        self._names, self._written = names.UniqueNames(), {}

    def lines(self):
        lines, count = [], 0
        for volume in self._level.volumes:
            try:
                if count == _MOST:
                    raise _Skipped(f"Brume shows {_MOST} volumes")
                keys = self._keys(volume)
            except _Skipped as reason:
                self._warnings.add(f'the volume "{volume.label}" is not exported: {reason}')
                continue
            lines += ["", "[[volume]]"] + [f"{key} = {value}" for key, value in keys.items()]
            count += 1
        return lines

    def _keys(self, volume):
        def warn(what):
            self._warnings.add(f'the volume "{volume.label}": {what}')

        if volume.moves:
            warn("it moves; it is exported where it is at the current frame")
        look = volume_look.look_of(volume.material, warn)
        if look is None:
            raise _Skipped("its material has no volume shader, so that Blender does not show it either")
        keys, first_file = self._file_keys(volume, warn)
        keys |= _place_keys(volume)
        return keys | self._look_keys(volume, look, _grids_of(first_file), warn)

    def _file_keys(self, volume, warn):
        """The keys of a file or a sequence, and the first file. Raises _Skipped."""
        data = volume.data
        if volume.evaluated_file:
            if data.is_sequence:
                warn("it has modifiers; its sequence is exported as it is at the current frame")
            name = f"Volumes/{self._names.take(names.safe(volume.label, 'volume'))}.vdb"
            path = os.path.join(self._folder, name)
            with open(volume.evaluated_file, "rb") as file:
                files.write(path, file.read())
            return {"file": quoted(name)}, path
        if not data.filepath:
            raise _Skipped("it names no file")
        path = bpy.path.abspath(data.filepath, library=data.library)
        if data.is_sequence and _pattern_of(path):
            return self._sequence_keys(data, os.path.normpath(path))
        if data.packed_file:
            return {"file": quoted(self._unpacked(data))}, os.path.join(self._folder, self._unpacked(data))
        path = os.path.normpath(path)
        if not os.path.isfile(path):
            raise _Skipped(f"{path} does not exist; choose another file")
        if _NUMBER.search(os.path.basename(path)):
            raise _Skipped(f'the name of {path} has a "%d", which would be the number of a frame; rename it')
        return {"file": quoted(self._reference(path))}, path

    def _unpacked(self, data):
        """Writes a packed file once; returns its name in the folder."""
        if data.name_full not in self._written:
            name = f"Volumes/{self._names.take(names.safe(data.name, 'volume'))}.vdb"
            files.write(os.path.join(self._folder, name), bytes(data.packed_file.data))
            self._written[data.name_full] = name
        return self._written[data.name_full]

    def _reference(self, path):
        """A file in or below the folder of the timeline by its relative path, any other by its whole one."""
        try:
            inside = os.path.commonpath([os.path.abspath(self._folder), path]) == os.path.abspath(self._folder)
        except ValueError:  # Another drive.
            inside = False
        return (os.path.relpath(path, self._folder) if inside else path).replace(os.sep, "/")

    def _sequence_keys(self, data, path):
        """Blender shows the file of number offset + 1 at its first frame, whatever the number in the path."""
        pattern = _pattern_of(path)
        if _NUMBER.search(os.path.basename(path)):
            raise _Skipped(f'the name of {path} has a "%d" beside the number of the frame; rename it')
        first, last = data.frame_offset + 1, data.frame_offset + data.frame_duration
        if data.frame_duration < 1:
            raise _Skipped("its sequence has no frames")
        if not 0 <= first <= last <= _LAST_FRAME:
            raise _Skipped(f"its frames {first} to {last} are not from 0 to {_LAST_FRAME}")
        found = _first_file(pattern, first, last)
        if found is None:
            raise _Skipped(f"no file from {pattern % first} to {os.path.basename(pattern % last)} exists")
        start = self._clock.seconds(data.frame_start)
        if abs(start) > _LATEST:
            raise _Skipped(f"its sequence begins at {start:g} s, more than {_LATEST:g} s away")
        keys = {"file": quoted(self._reference(pattern)), "first": first, "last": last}
        keys |= {"start": number(start), "frame_rate": number(self._rate)}
        key = {"CLIP": "clip", "REPEAT": "loop", "PING_PONG": "ping_pong"}.get(data.sequence_mode)
        return keys | ({key: "true"} if key else {}), found

    def _look_keys(self, volume, look, grids, warn):
        density, emission = look.density, look.emission
        if density and density not in grids:
            raise _Skipped(f'its file has no grid "{density}", the Density Attribute of its material')
        if not density:
            warn("its material has no Density Attribute; the grid that is usually the density is exported")
        if emission > 0 and look.temperature not in grids:
            warn(f'its file has no grid "{look.temperature}", so that it does not glow')
            emission = 0.0
        # Blender's unit of the density is 1 / unit; with the space Object, 1 / unit of the object.
        scale = 1.0
        if volume.data.render.space == "OBJECT":
            diagonal = volume.world_from_file[:3, :3] @ np.full(3, 3**-0.5)
            scale = self._level.metres / max(float(np.linalg.norm(diagonal)), 1e-30)
        keys = {"density": quoted(density)} if density else {}
        keys |= {"heat": quoted(look.temperature)} if emission > 0 else {}
        keys |= self._color_keys(look.color, grids, warn)
        keys["extinction"] = number(_VOLUME["extinction"].clamped(look.extinction * scale / self._level.metres))
        keys["albedo"] = vector(look.albedo)
        keys["anisotropy"] = number(look.anisotropy)
        keys["emission"] = number(_VOLUME["emission"].clamped(emission))
        if emission > 0:
            keys["kelvin"] = number(look.kelvin)
        return keys

    def _color_keys(self, name, grids, warn):
        """Brume finds colours by itself where a file has grids of the usual names; Blender does not."""
        if name and not _has_colors(grids, name):
            warn(f'its file has no grid "{name}", the Color Attribute of its material')
        elif name:
            return {"color": quoted(name)}
        return {"color": quoted("none")} if any(_has_colors(grids, usual) for usual in _COLORS) else {}


def _has_colors(grids, name):
    """Whether a file has a grid of colours, or one for each channel as Mantaflow saves them."""
    return name in grids or all(f"{name}_{channel}" in grids for channel in "rgb")


def _first_file(pattern, first, last):
    """The file of the lowest number from first to last that exists, or None."""
    before, after = _NUMBER.split(os.path.basename(pattern))
    folder, lowest = os.path.dirname(pattern), None
    try:
        entries = os.listdir(folder)
    except OSError as error:
        raise _Skipped(f"{folder} cannot be read: {error.strerror}") from error
    for name in entries:
        digits = name[len(before) : len(name) - len(after)]
        if name.startswith(before) and name.endswith(after) and digits.isascii() and digits.isdigit():
            if first <= int(digits) <= last and (lowest is None or int(digits) < lowest[0]):
                lowest = (int(digits), os.path.join(folder, name))
    return lowest and lowest[1]


def _place_keys(volume):
    matrix = volume.world_from_file
    position, axes = matrix[:3, 3], matrix[:3, :3]
    if not np.isfinite(matrix).all():
        raise _Skipped("its transform is not finite")
    if np.abs(position).max() > _FARTHEST or np.abs(axes).max() > _VOLUME["x_axis"].high:
        raise _Skipped(f"it is farther than {_FARTHEST:g} m from the origin, or larger than Brume shows")
    if abs(np.linalg.det(axes)) <= 1e-8 * np.prod(np.linalg.norm(axes, axis=0)):
        raise _Skipped("it is scaled to nothing along an axis")
    keys = {"position": vector(position)}
    return keys | {name: vector(axes[:, i]) for i, name in enumerate(("x_axis", "y_axis", "z_axis"))}
