"""Shows the viewport as Blender renders the scene: camera icons instead of eyes, render settings of modifiers."""


class AsRendered:
    """`with AsRendered(context, data):` the depsgraph holds what Blender renders; restores all settings on exit. Given
    `chosen` objects, what is visible stays as it is, and these have the shape of the render.

    Blender has no depsgraph of a render outside of a renderer, so the settings of the viewport take the values of those
    of the render.
    """

    def __init__(self, context, data, chosen=None):
        self._context, self._data, self._chosen = context, data, chosen
        self._changed, self._hidden = [], []

    def __enter__(self):
        try:
            self._enter(self._context.view_layer)
        except BaseException:
            self.__exit__()
            raise
        return self

    def _enter(self, view_layer):
        self._active = view_layer.objects.active
        self._selected = [thing for thing in view_layer.objects if thing.select_get(view_layer=view_layer)]
        if self._chosen is not None:
            for thing in self._chosen:
                self._set_shape(thing)
            view_layer.update()
            return
        self._hidden = [thing for thing in view_layer.objects if thing.hide_get(view_layer=view_layer)]
        self._show_layers(view_layer.layer_collection)
        for collection in self._data.collections:
            self._set(collection, "hide_viewport", collection.hide_render)
        for thing in self._data.objects:
            self._set(thing, "hide_viewport", thing.hide_render)
            self._set(thing, "show_instancer_for_viewport", thing.show_instancer_for_render)
            if not thing.hide_render:
                self._set_shape(thing)
        for thing in self._hidden:
            thing.hide_set(False, view_layer=view_layer)
        view_layer.update()

    def __exit__(self, *_):
        view_layer = self._context.view_layer
        for owner, setting, value in reversed(self._changed):
            setattr(owner, setting, value)
        for thing in self._hidden:
            thing.hide_set(True, view_layer=view_layer)
        # Blender deselects what is hidden.
        view_layer.update()
        for thing in self._selected:
            thing.select_set(True, view_layer=view_layer)
        view_layer.objects.active = self._active

    def _set(self, owner, setting, value):
        before = getattr(owner, setting)
        if before != value:
            setattr(owner, setting, value)
            self._changed.append((owner, setting, before))

    def _show_layers(self, layer):
        # The eye of the outliner; the tick, exclude, also applies to renders.
        self._set(layer, "hide_viewport", False)
        for child in layer.children:
            self._show_layers(child)

    def _set_shape(self, thing):
        """Modifiers, subdivision levels and resolutions of the render."""
        for modifier in thing.modifiers:
            self._set(modifier, "show_viewport", modifier.show_render)
            if modifier.type in {"SUBSURF", "MULTIRES"}:
                self._set(modifier, "levels", modifier.render_levels)
        for particles in thing.particle_systems:
            self._set(particles.settings, "display_percentage", 100)
        if thing.type in {"CURVE", "SURFACE", "FONT"}:
            for axis in ("u", "v"):
                resolution = getattr(thing.data, "render_resolution_" + axis)
                if resolution:  # 0: that of the viewport.
                    self._set(thing.data, "resolution_" + axis, resolution)
        elif thing.type == "META":
            self._set(thing.data, "resolution", thing.data.render_resolution)
