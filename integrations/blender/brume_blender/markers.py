"""Events as markers of Blender's timeline. A marker has the name of its event; moving it moves the event."""

import bpy
from bpy.app.handlers import persistent

from .clock import events_of

_PREFIX = "Brume: "
# Custom property of an event: the frame of its marker after the last synchronization.
_KEY = "brume_marker"


def _name(thing):
    text = f' "{thing.brume_event.text}"' if thing.brume_event.type == "WORD" else ""
    return _PREFIX + thing.name + text


def synchronize(scene):
    """Moves events whose markers were moved; then adds, moves and removes markers to match the events."""
    own = {marker.name: marker for marker in scene.timeline_markers if marker.name.startswith(_PREFIX)}
    wanted = {_name(thing): thing for thing in events_of(scene)} if scene.brume.markers else {}
    for name, marker in own.items():
        if name not in wanted:
            scene.timeline_markers.remove(marker)
    for name, thing in wanted.items():
        event, marker = thing.brume_event, own.get(name)
        frame = round(event.frame)
        if marker is None:
            scene.timeline_markers.new(name, frame=frame)
        elif marker.frame != frame:
            if event.get(_KEY) == frame:  # The event is where the marker was: the marker has moved.
                event.frame = frame = marker.frame
            else:
                marker.frame = frame
        if event.get(_KEY) != frame:
            event[_KEY] = frame


@persistent
def _on_change(scene, *_):
    synchronize(scene)


_HANDLERS = ("depsgraph_update_post", "frame_change_post")


def register():
    for name in _HANDLERS:
        getattr(bpy.app.handlers, name).append(_on_change)


def unregister():
    for name in _HANDLERS:
        handlers = getattr(bpy.app.handlers, name)
        if _on_change in handlers:
            handlers.remove(_on_change)
