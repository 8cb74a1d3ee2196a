"""Timeline export (TOML, docs/guides/timelines.md): volumes, events of empties, keys of the moving scene camera."""

import math
import os

import bpy
from mathutils import Vector

from . import conversion, files, names, world
from .clock import events_of, frames_per_second, moves
from .conversion import number
from .kinds import KINDS, PROPERTIES
from .messages import BrumeError
from .settings import EVENT_FIELDS, SETTINGS
from .toml_text import quoted, vector
from .volumes import Tables

_KEYS_PER_SECOND = 8
_TIMELINE, _CAMERA = SETTINGS["timeline"], SETTINGS["camera"]
_LONGEST = _TIMELINE["duration"].high
_AHEAD = 5.0  # Distance from the camera to its target [m].


# Events of one tick happen in this order.
_ORDER = ["DOOR"] + [kind for kind in KINDS if kind != "DOOR"]


def events(scene, level):
    """The events that Blender renders, in the order in which they happen."""
    found = [thing for thing in events_of(scene) if thing in level.rendered]
    return sorted(
        found, key=lambda thing: (thing.brume_event.frame, _ORDER.index(thing.brume_event.type), thing.name)
    )


def target_of(clock, thing, metres):
    """The world-space point that the shot or text of an empty passes through, in Blender's axes and units."""
    event = thing.brume_event
    time = clock.seconds(event.frame)
    if event.aim:
        return clock.matrix_at(event.aim, time).translation
    place = clock.matrix_at(thing, time)
    return place.translation + place.col[2].to_3d().normalized() * (10 / metres)


class Writer:
    """Writes a timeline. `level` has the names of doors in the scene file."""

    def __init__(self, context, level, clock, folder, warnings):
        self._scene, self._level, self._clock = context.scene, level, clock
        self._folder, self._warnings = folder, warnings
        self._copied = names.UniqueNames()

    def write(self, path, scene_file, tone=None):
        """`tone` is omitted for a program that has only one."""
        tables = Tables(self._level, self._clock, frames_per_second(self._scene), self._folder, self._warnings)
        lines = self._head(scene_file, tone) + tables.lines() + self._camera()
        for thing in events(self._scene, self._level):
            lines += self._event(thing, thing.brume_event)
        files.write(path, "\n".join(lines) + "\n")

    def _head(self, scene_file, tone):
        scene, options = self._scene, self._scene.brume
        duration = self._clock.seconds(scene.frame_end + 1)
        least, most = _TIMELINE["duration"].low, _TIMELINE["duration"].high
        if not least <= duration <= most:
            raise BrumeError(
                f"the scene lasts {duration:g} s, expected {least:g} to {most:g} s; change its frame range"
            )
        exposure = _TIMELINE["exposure"].clamped(scene.view_settings.exposure)
        lines = ["version = 1", f"scene = {quoted(scene_file)}"]
        lines += [f"duration = {number(duration)}", f"exposure = {number(exposure)}"]
        lines += [f"tone = {quoted(tone)}"] if tone else []
        lines += ["", "[grid]", f"voxel = {number(options.voxel)}"]
        lines += ["", "[smoke]", f"voxels = {options.smoke_voxels}"]
        lines += [f"{key} = {number(getattr(options, 'smoke_' + key))}" for key in ("bloom", "hold", "dissolve")]
        lines += [f"extinction = {number(options.smoke_extinction)}"]
        sky = world.sky(scene, self._warnings)
        if sky:
            lines += ["", "[sky]"]
            lines += [f"{key} = {vector(color)}" for key, color in zip(("zenith", "horizon", "ambient"), sky)]
        return lines

    def _camera(self):
        camera, scene = self._scene.camera, self._scene
        if camera is None or camera.type != "CAMERA":
            self._warnings.add("the scene has no camera; Brume uses one with everything in view")
            return []
        if camera.data.type != "PERSP":
            self._warnings.add(f'the camera "{camera.name}" is not a perspective camera and is not exported')
            return []
        if any(marker.camera for marker in scene.timeline_markers):
            self._warnings.add("markers that switch cameras are not exported")
        times = [0.0]
        if moves(camera):
            last = self._clock.seconds(scene.frame_end)
            count = max(1, math.ceil(last * _KEYS_PER_SECOND))
            times = sorted({last * i / count for i in range(count + 1)})
        keys = [(time, self._camera_key(camera, time)) for time in times]
        if all(key == keys[0][1] for _, key in keys):
            keys = keys[:1]
        lines = []
        for time, (position, target, fov, lens) in keys:
            lines += ["", "[[camera]]", f"time = {number(time)}"]
            lines += [f"position = {position}", f"target = {target}", f"fov = {number(fov)}"]
            lines += [f"{key} = {number(value)}" for key, value in lens.items()]
        return lines

    def _camera_key(self, camera, time):
        evaluated = self._clock.evaluated_at(camera, time)
        matrix = evaluated.matrix_world
        metres = self._level.metres
        forward = -matrix.col[2].to_3d().normalized()
        # Position, target and field of view cannot represent a roll or a lens shift.
        if abs(matrix.col[0].to_3d().normalized().z) > 0.01:
            self._warnings.add(f'the camera "{camera.name}" is rolled; Brume keeps its horizon level')
        if evaluated.data.shift_x or evaluated.data.shift_y:
            self._warnings.add(f'the lens shift of the camera "{camera.name}" is not exported')
        position = matrix.translation
        target = position + forward * (_AHEAD / metres)
        return (
            vector(conversion.point(position, metres)),
            vector(conversion.point(target, metres)),
            _CAMERA["fov"].clamped(math.degrees(vertical_fov(evaluated.data, self._scene))),
            self._lens(evaluated, time) | self._shutter(),
        )

    def _shutter(self):
        """How long the shutter is open, if the scene has motion blur; else nothing."""
        render = self._scene.render
        if not render.use_motion_blur:
            return {}
        return {"shutter": _CAMERA["shutter"].clamped(render.motion_blur_shutter * render.fps_base / render.fps)}

    def _lens(self, camera, time):
        """Aperture, focus and blades of a camera with depth of field; without, nothing."""
        data, settings = camera.data, camera.data.dof
        if not settings.use_dof:
            return {}
        metres = self._level.metres
        distance = settings.focus_distance
        if settings.focus_object is not None:
            aim = self._clock.matrix_at(settings.focus_object, time).translation
            distance = abs((camera.matrix_world.inverted() @ aim).z)
        # The focal length is in millimetres; the f-number divides it into the diameter of the opening.
        lens = {
            "aperture": _CAMERA["aperture"].clamped(data.lens / 1000 / (2 * settings.aperture_fstop)),
            "focus": _CAMERA["focus"].clamped(distance * metres),
        }
        if settings.aperture_blades >= 3:
            lens["blades"] = settings.aperture_blades
        return lens

    def _event(self, thing, event):
        time = self._clock.seconds(event.frame)
        if time > _LONGEST:
            raise BrumeError(f'the event "{thing.name}" is at {time:g} s, timelines last 3600 s; move it')
        if event.type == "DOOR":
            return self._door(thing, event, time)
        here = self._clock.matrix_at(thing, time).translation
        kind = KINDS[event.type].name
        keys = {"type": quoted(kind), "time": number(time)}
        if event.type == "SMOKE":
            start = self._clock.matrix_at(event.thrown_from, time).translation if event.thrown_from else here
            keys |= {"from": self._point(thing, start), "at": self._point(thing, here)}
        elif EVENT_FIELDS[kind].points == ("at",):
            keys["at"] = self._point(thing, here)
        else:
            keys |= self._aimed(thing, event, here)
        keys |= _numbers(event, kind)
        return ["", "[[event]]"] + [f"{key} = {value}" for key, value in keys.items()]

    def _point(self, thing, blender_point):
        values = conversion.point(blender_point, self._level.metres)
        if abs(values).max() > 16384:
            raise BrumeError(f'the event "{thing.name}" is farther than 16384 m from the origin; move it closer')
        return vector(values)

    def _aimed(self, thing, event, here):
        """The keys of a shot or a text: fired from the empty along its z axis, or at its target."""
        toward = target_of(self._clock, thing, self._level.metres)
        if (Vector(toward) - here).length < 1e-6:
            raise BrumeError(f'the event "{thing.name}" aims at its own position; move it or its target')
        keys = {"from": self._point(thing, here), "toward": self._point(thing, toward)}
        for key, least, most in EVENT_FIELDS[KINDS[event.type].name].bytes:
            text = getattr(event, key)
            if not least <= len(text.encode("utf-8")) <= most:
                raise BrumeError(f'the {key} of "{thing.name}" must be {least} to {most} bytes long')
            keys[key] = quoted(text)
        if event.type == "WORD":
            if event.font:
                keys["font"] = self._copy_of(thing, event.font, "Fonts")
            return keys
        keys["shape"] = quoted(event.shape.lower())
        if event.shape == "MASK":
            if not event.mask:
                raise BrumeError(f'the shape of "{thing.name}" is Mask, but it names no image; choose one')
            keys["mask"] = self._copy_of(thing, event.mask, "Masks")
        return keys

    def _copy_of(self, thing, file, kind):
        """Copies a file into a folder next to the timeline, because timelines may not refer to files elsewhere."""
        path = bpy.path.abspath(file)
        try:
            with open(path, "rb") as source:
                data = source.read()
        except OSError as error:
            raise BrumeError(f'the event "{thing.name}" names {path}: {error.strerror}; choose another file') from error
        stem, extension = os.path.splitext(os.path.basename(path))
        name = f"{kind}/{self._copied.take(names.safe(stem, 'file'))}{names.safe(extension, '')}"
        files.write(os.path.join(self._folder, name), data)
        return quoted(name)

    def _door(self, thing, event, time):
        door = event.door
        found = self._level.door_names.get(door.name, []) if door else []
        if not found:
            what = f'"{door.name}" does not have the role Door' if door else "it has no door"
            self._warnings.add(f'the door event "{thing.name}" is not exported: {what}')
        lines = []
        for name in found:
            lines += ["", "[[event]]", 'type = "door"', f"time = {number(time)}"]
            lines += [f"object = {quoted(name)}", f"open = {'true' if event.open else 'false'}"]
        return lines


def _numbers(event, kind):
    """The keys of the numbers of an event, in the units of timelines."""
    values = {}
    for key, setting in EVENT_FIELDS[kind].numbers.items():
        value = getattr(event, PROPERTIES[kind, key])
        values[key] = math.degrees(value) if setting.unit == "degrees" else value
    for rule, key, other in EVENT_FIELDS[kind].rules:
        if rule == "at_least":
            values[key] = max(values[key], values[other])
    return {key: number(value) for key, value in values.items()}


def vertical_fov(camera, scene):
    """The vertical field of view [radians]."""
    frame = camera.view_frame(scene=scene)
    height = max(corner.y for corner in frame) - min(corner.y for corner in frame)
    return 2 * math.atan(height / 2 / -frame[0].z)
