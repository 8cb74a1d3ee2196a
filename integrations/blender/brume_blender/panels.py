"""The sidebar tab of the 3D view."""

import textwrap

import bpy

from . import checks, messages
from .kinds import KINDS
from .presets import PRESETS

_SMOKE_FIELDS = ("smoke_radius", "smoke_voxels", "smoke_bloom", "smoke_hold", "smoke_dissolve", "smoke_extinction")
_ICONS = {"ERROR": "CANCEL", "WARNING": "ERROR", "INFO": "INFO"}


def wrapped(text, width, scale):
    """Lines of a text that fit a width [px]; a letter is about 6.5 px wide at scale 1."""
    return textwrap.wrap(text, max(12, int(width / (6.5 * scale)) - 8))


def _draw_message(layout, context, message):
    column = layout.column(align=True)
    column.scale_y = 0.75
    scale = context.preferences.system.ui_scale
    for number, line in enumerate(wrapped(message.text, context.region.width, scale)):
        column.label(text=line, icon="BLANK1" if number else _ICONS[message.kind])


class _Panel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Brume"

    def begin(self):
        """Two columns, without dots for keyframes: nothing here is animated."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout


class BRUME_PT_level(_Panel, bpy.types.Panel):
    bl_idname = "BRUME_PT_level"
    bl_label = "Brume"

    def draw(self, context):
        options = context.scene.brume
        column = self.begin().column()
        column.operator("brume.render", icon="RENDER_STILL")
        column.operator("brume.film", icon="RENDER_ANIMATION")
        row = column.row(align=True)
        row.operator("brume.view", icon="VIEW_PERSPECTIVE").play = False
        row.operator("brume.view", text="Play", icon="PLAY").play = True
        column.operator("brume.check", icon="CHECKMARK")
        column.operator("brume.voxels", icon="VIEW3D")
        column.operator("brume.export_level", icon="EXPORT").format = options.format
        column.operator("brume.bake_slices", icon="MESH_GRID")
        column.operator("brume.bake_occlusion", icon="SHADING_RENDERED")


class BRUME_PT_object(_Panel, bpy.types.Panel):
    bl_idname = "BRUME_PT_object"
    bl_label = "Object"

    @classmethod
    def poll(cls, context):
        return context.object is not None

    def draw(self, context):
        layout, thing = self.begin(), context.object
        instancer = thing.type == "EMPTY" and thing.instance_type == "COLLECTION"
        if thing.type != "EMPTY" or instancer:
            layout.prop(thing.brume, "role")
            return
        event = thing.brume_event
        layout.prop(event, "type")
        if event.type == "NONE":
            return
        column = layout.column(align=True)
        column.prop(event, "frame")
        column.prop(event, "time")
        column.operator("brume.event_to_frame", icon="TIME")
        if event.type in PRESETS:
            layout.menu("BRUME_MT_presets")
        column = layout.column()
        for name in KINDS[event.type].fields:
            column.prop(event, name)
            if name == "shape" and event.shape == "MASK":
                column.prop(event, "mask")
        if event.type == "SMOKE":
            column.label(text="Size of all: panel Smoke")
        for message in messages.last():
            if message.thing == thing.name:
                _draw_message(layout, context, message)


class BRUME_PT_messages(_Panel, bpy.types.Panel):
    bl_idname = "BRUME_PT_messages"
    bl_label = "Messages"

    @classmethod
    def poll(cls, _context):
        return bool(messages.last())

    def draw(self, context):
        for message in messages.last():
            _draw_message(self.layout, context, message)


class BRUME_PT_smoke(_Panel, bpy.types.Panel):
    bl_idname = "BRUME_PT_smoke"
    bl_label = "Smoke"

    def draw(self, context):
        column = self.begin().column()
        for name in _SMOKE_FIELDS:
            column.prop(context.scene.brume, name)


class BRUME_PT_scene(_Panel, bpy.types.Panel):
    bl_idname = "BRUME_PT_scene"
    bl_label = "Scene"

    def draw(self, context):
        options = context.scene.brume
        layout = self.begin()
        column = layout.column()
        for name in ("sky", "tone", "samples", "march"):
            column.prop(options, name)
        column = layout.column()
        for name in ("format", "shown_voxel"):
            column.prop(options, name)
        column = layout.column(heading="Show")
        for name in ("gizmos", "markers"):
            column.prop(options, name)


_CLASSES = (BRUME_PT_level, BRUME_PT_object, BRUME_PT_messages, BRUME_PT_smoke, BRUME_PT_scene)


def register():
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    checks.ends.clear()
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
