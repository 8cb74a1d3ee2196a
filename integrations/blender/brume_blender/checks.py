"""Checks the scene for what its image would not show as expected: where grenades land and shots end, units, lights."""

import math

import numpy as np
from mathutils import Vector

from . import conversion, look_checks, timeline
from .kinds import KINDS
from .settings import EVENT_FIELDS

_SMALLEST_LEVEL = 1.0  # [m]
_GRENADE_SPEED = 20.0  # [m/s], docs/guides/timelines.md.
_RANGE = 4096.0  # [m]
_LARGEST_GRID = 4096  # Voxels along an axis.

# What the last check found: name of an event: (its matrix, its end point), in Blender's axes and units.
ends = {}


def check_level(level, solids, warnings):
    """Warns of a wrong unit scale; notes what Brume renders differently from Blender."""
    extent = solids.high - solids.low
    if level.things and extent.max() < _SMALLEST_LEVEL:
        warnings.add(
            f"the level is only {extent.max():.2g} m wide; check the unit scale (Scene Properties > Units)"
        )
    look_checks.check(level, warnings)


def _metres(length):
    return f"{length:.1f} m"


class _Smoke:
    """A smoke where its grenade goes off."""

    def __init__(self, point, begin, options):
        self.point, self.begin = point, begin
        self.end = begin + options.smoke_bloom + options.smoke_hold + options.smoke_dissolve
        self.radius = conversion.radius_of_voxels(options.smoke_voxels, options.voxel)


class _EventCheck:
    def __init__(self, scene, level, solids, clock, warnings):
        self._scene, self._level, self._clock, self._warnings = scene, level, clock, warnings
        self._options, self._solids = scene.brume, solids
        self._open_doors, self._smokes = set(), []
        self._low, self._high = solids.low, solids.high  # What the grid covers, without its margin.

    def run(self):
        ends.clear()
        for thing in timeline.events(self._scene, self._level):
            points = EVENT_FIELDS[KINDS[thing.brume_event.type].name].points
            self._checks[points](self, thing, self._clock.seconds(thing.brume_event.frame))

    def _point(self, thing, time):
        place = self._clock.matrix_at(thing, time).translation
        return Vector(conversion.point(place, self._level.metres))

    def _set_end(self, thing, point):
        blender = np.array(point) @ conversion.BRUME_FROM_BLENDER / self._level.metres
        ends[thing.name] = (thing.matrix_world.copy(), Vector(blender))

    def _cast(self, start, direction, far=_RANGE):
        return self._solids.cast(start, direction, far, self._open_doors)

    def _check_door(self, thing, _time):
        event = thing.brume_event
        names = self._level.door_names.get(event.door.name, []) if event.door else []
        if event.open:
            self._open_doors.update(names)
        else:
            self._open_doors.difference_update(names)

    def _margin(self):
        """The air around a level that smoke may fill [m]: that of src/scenario/scenario.cpp."""
        options = self._options
        return options.voxel * (2 + math.floor((options.smoke_voxels * 0.75 / math.pi) ** (1 / 3) * 1.2))

    def _cover(self, point):
        """Extends the grid to a smoke, as src/scenario/scenario.cpp does; whether a grid can be as large as that."""
        voxel = self._options.voxel
        low, high = np.minimum(self._low, point), np.maximum(self._high, point)
        across = np.ceil(high / voxel) - np.floor(low / voxel) + 2 * self._margin() / voxel
        if across.max() > _LARGEST_GRID:
            return False
        self._low, self._high = low, high
        return True

    def _is_placed_well(self, thing, point):
        outside = self._solids.distance_outside(np.array(point))
        is_smoke = thing.brume_event.type == "SMOKE"
        if outside > self._margin() and not (is_smoke and self._cover(np.array(point))):
            self._warnings.add(f'"{thing.name}" is {_metres(outside)} outside the level: no smoke there', thing.name)
            return False
        # The smoke of a closed mesh with room for half of it is in that room.
        voxel, around = self._options.voxel, self._solids.around(point, self._open_doors)
        if around and around[1] < self._options.smoke_voxels / 2 * voxel**3:
            self._warnings.add(f'"{thing.name}" is inside "{around[0]}": move it out', thing.name)
            return False
        if self._solids.is_free(point, voxel, self._open_doors):
            return True
        what = f'is inside "{around[0]}"' if around else "lies in something solid"
        self._warnings.add(f'"{thing.name}" {what}: move it out', thing.name)
        return False

    def _check_smoke(self, thing, time):
        event, at = thing.brume_event, self._point(thing, time)
        start = self._point(event.thrown_from, time) if event.thrown_from else at
        flight = (at - start).length
        if flight < 1e-3:
            self._land(thing, at, time, self._is_placed_well(thing, at))
            return
        hit = self._cast(start, (at - start) / flight)
        if hit is None:
            # It goes off at the empty, in the air.
            self._land(thing, at, time + flight / _GRENADE_SPEED, self._is_placed_well(thing, at))
            return
        distance, label = hit
        voxel = self._options.voxel
        landed = start + (at - start) / flight * max(0.0, distance - voxel)
        if distance < flight - 2 * voxel:
            self._warnings.add(
                f'"{thing.name}" hits "{label}" after {_metres(distance)} and goes off there, not at its empty',
                thing.name,
            )
        elif distance > flight + 2 * voxel:
            far = _metres(distance - flight)
            self._warnings.note(f'"{thing.name}" flies {far} past its empty, to "{label}"', thing.name)
        self._land(thing, landed, time + distance / _GRENADE_SPEED, True)

    def _land(self, thing, point, time, fills):
        self._set_end(thing, point)
        if fills:
            self._smokes.append(_Smoke(point, time, self._options))

    def _check_shot(self, thing, time):
        start = self._point(thing, time)
        target = timeline.target_of(self._clock, thing, self._level.metres)
        along = Vector(conversion.point(target, self._level.metres)) - start
        if along.length < 1e-6:
            return  # The timeline reports it.
        along.normalize()
        # A shot leaves the solid voxel that it starts in.
        voxel = self._options.voxel
        hit = self._cast(start + along * voxel, along)
        hit = (hit[0] + voxel, hit[1]) if hit else None
        length = hit[0] if hit else self._reach(start)
        self._set_end(thing, start + along * length)
        end = f'hits "{hit[1]}" at {_metres(hit[0])}' if hit else "leaves the level"
        out = [smoke for smoke in self._smokes if smoke.begin <= time <= smoke.end]
        if not out:
            self._warnings.add(f'"{thing.name}" {end}; no smoke is out at that time', thing.name)
            return
        gap = min(_gap(start, along, length, smoke) for smoke in out)
        if gap > 0:
            self._warnings.add(f'"{thing.name}" {end}, {_metres(gap)} from the nearest smoke', thing.name)
        else:
            self._warnings.note(f'"{thing.name}" {end}', thing.name)

    def _reach(self, start):
        """A distance beyond the far side of the level [m]."""
        far = np.maximum(np.abs(self._solids.low - start), np.abs(self._solids.high - start))
        return float(np.linalg.norm(far)) + self._margin()

    def _check_ball(self, thing, time):
        """Of what clears the smoke in a ball around it."""
        at = self._point(thing, time)
        self._set_end(thing, at)
        if not self._is_placed_well(thing, at):
            return
        reach = getattr(thing.brume_event, KINDS[thing.brume_event.type].ball)
        out = [smoke for smoke in self._smokes if smoke.begin <= time <= smoke.end]
        gaps = [(smoke.point - at).length - smoke.radius - reach for smoke in out]
        if not gaps:
            self._warnings.add(f'"{thing.name}" clears nothing: no smoke is out at that time', thing.name)
        elif min(gaps) > 0:
            self._warnings.add(f'"{thing.name}" is {_metres(min(gaps))} short of the nearest smoke', thing.name)

    # By the points that an event has.
    _checks = {("from", "at"): _check_smoke, ("from", "toward"): _check_shot, ("at",): _check_ball, (): _check_door}


def _gap(start, along, length, smoke):
    """The distance of a path from a smoke [m]; 0 where it may pass through: walls make a smoke half as wide again."""
    nearest = start + along * min(max((smoke.point - start).dot(along), 0.0), length)
    return max(0.0, (nearest - smoke.point).length - 1.5 * smoke.radius)


def check_events(scene, level, solids, clock, warnings):
    """Warns of grenades inside walls or beside the level, and of events that reach no smoke."""
    _EventCheck(scene, level, solids, clock, warnings).run()
