"""Adds events: empties at the 3D cursor, at the current frame; moves them to the current frame."""

import bpy
from bpy.props import EnumProperty

from . import markers
from .conversion import metres_per_unit
from .kinds import KINDS
from .properties import EVENTS



def add_event(scene, collection, kind, frame):
    """Adds an empty that is an event, at the origin."""
    name, display, size = KINDS[kind].empty
    empty = bpy.data.objects.new(name, None)
    empty.empty_display_type, empty.empty_display_size = display, size / metres_per_unit(scene)
    empty.brume_event.type = kind
    empty.brume_event.frame = frame
    collection.objects.link(empty)
    return empty


class BRUME_OT_add_event(bpy.types.Operator):
    """Add an empty that marks an event at the current frame"""

    bl_idname = "brume.add_event"
    bl_label = "Add Brume Event"
    bl_options = {"REGISTER", "UNDO"}

    type: EnumProperty(items=EVENTS[1:], name="Event")

    def execute(self, context):
        scene, chosen = context.scene, context.active_object
        empty = add_event(scene, context.collection, self.type, scene.frame_current)
        empty.location = scene.cursor.location
        if self.type == "DOOR" and chosen and chosen.brume.role == "DOOR":
            empty.brume_event.door = chosen
        for thing in context.selected_objects:
            thing.select_set(False)
        empty.select_set(True)
        context.view_layer.objects.active = empty
        markers.synchronize(scene)
        return {"FINISHED"}


class BRUME_OT_event_to_frame(bpy.types.Operator):
    """Move the selected events to the current frame"""

    bl_idname = "brume.event_to_frame"
    bl_label = "Set to Current Frame"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.brume_event.type != "NONE"

    def execute(self, context):
        scene = context.scene
        for thing in {context.object, *context.selected_objects}:
            if thing.brume_event.type != "NONE":
                thing.brume_event.frame = scene.frame_current_final
        markers.synchronize(scene)
        return {"FINISHED"}


class BRUME_MT_add(bpy.types.Menu):
    bl_idname = "BRUME_MT_add"
    bl_label = "Brume"

    def draw(self, _context):
        for identifier, label, _, _ in EVENTS[1:]:
            self.layout.operator(BRUME_OT_add_event.bl_idname, text=label).type = identifier


def _menu(self, _context):
    self.layout.separator()
    self.layout.menu(BRUME_MT_add.bl_idname, icon="OUTLINER_OB_VOLUME")


_CLASSES = (BRUME_OT_add_event, BRUME_OT_event_to_frame, BRUME_MT_add)


def register():
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.VIEW3D_MT_add.append(_menu)


def unregister():
    bpy.types.VIEW3D_MT_add.remove(_menu)
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
