"""Frames of the scene and seconds of a timeline, and objects at a time."""

import math


def frames_per_second(scene):
    return scene.render.fps / scene.render.fps_base


def events_of(scene):
    """The empties of the scene that are events."""
    return [thing for thing in scene.objects if thing.type == "EMPTY" and thing.brume_event.type != "NONE"]


def moves(thing):
    """Whether the transform or the lens of an object may change over time."""
    while thing is not None:
        for block in (thing, thing.data):
            animation = getattr(block, "animation_data", None)
            if animation and (animation.action or animation.nla_tracks or animation.drivers):
                return True
        if thing.constraints:
            return True
        thing = thing.parent
    return False


class Clock:
    """Converts between frames and seconds; evaluates objects, and restores the frame of the scene on exit.

    Second 0 of the timeline is the first frame of the scene, or the earliest of `frames`: those of events, and the one
    to render.
    """

    def __init__(self, context, frames):
        self._context, self._scene = context, context.scene
        self._before = self._scene.frame_current, self._scene.frame_subframe
        self._origin = math.floor(min([self._scene.frame_start, *frames]))
        self._rate = frames_per_second(self._scene)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._set(*self._before)

    def _set(self, frame, subframe):
        if (self._scene.frame_current, self._scene.frame_subframe) != (frame, subframe):
            self._scene.frame_set(frame, subframe=subframe)

    def seconds(self, frame):
        """The time of a frame in the timeline [s], without the rounding error of a float32 frame."""
        return round((frame - self._origin) / self._rate, 6)

    def frame(self, time):
        return self._origin + time * self._rate

    def matrix_at(self, thing, time):
        """world_from_object at a time [s]."""
        return self.evaluated_at(thing, time).matrix_world.copy()

    def evaluated_at(self, thing, time):
        if moves(thing):
            frame = self.frame(time)
            self._set(math.floor(frame), frame - math.floor(frame))
        return thing.evaluated_get(self._context.evaluated_depsgraph_get())
