"""The sidebar tab of the 3D view, and Add > Brume."""

import bpy
from bpy.props import EnumProperty

from .properties import EVENTS, HOLE_TIMES

_FIELDS = {
    "SMOKE": ("thrown_from",),
    "SHOT": ("aim", "shape", "radius", "roll", "flash") + HOLE_TIMES,
    "TEXT": ("text", "aim", "size", "font", "spacing", "interval", "roll") + HOLE_TIMES,
    "BLAST": ("blast_radius", "speed", "blast_flash", "remaining", "refill_rim", "refill_middle"),
    "DOOR": ("door", "open"),
}
_DISPLAY = {
    "SMOKE": "SPHERE",
    "SHOT": "SINGLE_ARROW",
    "TEXT": "SINGLE_ARROW",
    "BLAST": "SPHERE",
    "DOOR": "PLAIN_AXES",
}


class BRUME_OT_add_event(bpy.types.Operator):
    """Add an empty that marks an event"""

    bl_idname = "brume.add_event"
    bl_label = "Add Brume Event"
    bl_options = {"REGISTER", "UNDO"}

    type: EnumProperty(items=EVENTS[1:], name="Event")

    def execute(self, context):
        label = next(item[1] for item in EVENTS if item[0] == self.type)
        empty = bpy.data.objects.new(label, None)
        empty.empty_display_type = _DISPLAY[self.type]
        empty.empty_display_size = 0.5
        empty.location = context.scene.cursor.location
        empty.brume_event.type = self.type
        chosen = context.active_object
        if self.type == "DOOR" and chosen and chosen.brume.role == "DOOR":
            empty.brume_event.door = chosen
        context.collection.objects.link(empty)
        for thing in context.selected_objects:
            thing.select_set(False)
        empty.select_set(True)
        context.view_layer.objects.active = empty
        return {"FINISHED"}


class BRUME_MT_add(bpy.types.Menu):
    bl_idname = "BRUME_MT_add"
    bl_label = "Brume"

    def draw(self, _context):
        for identifier, label, _ in EVENTS[1:]:
            self.layout.operator(BRUME_OT_add_event.bl_idname, text=label).type = identifier


class _Panel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Brume"


class BRUME_PT_level(_Panel, bpy.types.Panel):
    bl_idname = "BRUME_PT_level"
    bl_label = "Level"

    def draw(self, context):
        layout, options = self.layout, context.scene.brume
        layout.use_property_split = True
        column = layout.column()
        for name in ("format", "voxel", "sky", "march"):
            column.prop(options, name)
        column = layout.column()
        for name in ("voxels", "bloom", "hold", "dissolve", "extinction"):
            column.prop(options, "smoke_" + name)
        column = layout.column()
        column.operator("brume.render", icon="RENDER_STILL")
        row = column.row(align=True)
        row.operator("brume.view", icon="VIEW_PERSPECTIVE").play = False
        row.operator("brume.view", text="Play", icon="PLAY").play = True
        column.operator("brume.voxels", icon="VIEW3D")
        column.operator("brume.export_level", icon="EXPORT").format = options.format


class BRUME_PT_object(_Panel, bpy.types.Panel):
    bl_idname = "BRUME_PT_object"
    bl_label = "Object"

    @classmethod
    def poll(cls, context):
        return context.object is not None

    def draw(self, context):
        layout, thing = self.layout, context.object
        layout.use_property_split = True
        instancer = thing.type == "EMPTY" and thing.instance_type == "COLLECTION"
        if thing.type != "EMPTY" or instancer:
            layout.prop(thing.brume, "role")
            return
        event = thing.brume_event
        layout.prop(event, "type")
        if event.type == "NONE":
            return
        layout.prop(event, "time")
        column = layout.column()
        for name in _FIELDS[event.type]:
            column.prop(event, name)
            if name == "shape" and event.shape == "MASK":
                column.prop(event, "mask")


def _menu(self, _context):
    self.layout.separator()
    self.layout.menu(BRUME_MT_add.bl_idname, icon="OUTLINER_OB_VOLUME")


_CLASSES = (BRUME_OT_add_event, BRUME_MT_add, BRUME_PT_level, BRUME_PT_object)


def register():
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.VIEW3D_MT_add.append(_menu)


def unregister():
    bpy.types.VIEW3D_MT_add.remove(_menu)
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
