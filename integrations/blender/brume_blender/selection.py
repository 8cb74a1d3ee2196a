"""The selected objects as a level: what is baked."""

from .level import Gathered, Thing
from .messages import BrumeError
from .names import UniqueNames, safe


def selected(context):
    """The selected objects in the order of their names. Raises BrumeError without any."""
    if not context.selected_objects:
        raise BrumeError("nothing is selected; select the meshes to bake")
    return sorted(context.selected_objects, key=lambda thing: thing.name)


class Selected(Gathered):
    """`with Selected(context, warnings) as level`: each selected object is one thing, with its modifiers and instances
    as rendered, whatever its role and camera icon. Raises BrumeError if no object has faces."""

    def __init__(self, context, warnings):
        super().__init__(context, warnings)
        self._chosen = selected(context)
        # Brume takes an object of this name for the model of a grenade, which is not baked.
        self._names = UniqueNames(taken=("Grenade",))

    def _add_all(self):
        things = {}
        for source in self._chosen:
            things[source] = Thing(self._names.take(safe(source.name)), "SOLID", source.name)
        depsgraph = self._context.evaluated_depsgraph_get()
        depsgraph.update()
        for instance in depsgraph.object_instances:
            owner = (instance.parent if instance.is_instance else instance.object).original
            if owner not in things or instance.object.type != "MESH" or not instance.show_self:
                continue
            piece = self._piece(instance)
            if piece:
                things[owner].pieces.append(piece)
        self._level.things = [thing for thing in things.values() if thing.pieces]
        empty = ", ".join(f'"{thing.label}"' for thing in things.values() if not thing.pieces)
        if not self._level.things:
            raise BrumeError(f"the selection has no faces ({empty}); select the meshes to bake")
        if empty:
            self._warnings.add(f"{empty}: without faces; not baked")
