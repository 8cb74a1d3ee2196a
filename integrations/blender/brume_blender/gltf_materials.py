"""Stand-ins for materials that Blender's glTF exporter cannot read: copies with one Principled shader that it can."""

from . import nodes, surfaces

# The setting of a surface and the names of its socket.
_SETTINGS = (
    ("color", surfaces.COLOR),
    ("roughness", surfaces.ROUGHNESS),
    ("metallic", surfaces.METALLIC),
    ("alpha", surfaces.ALPHA),
    ("transmission", surfaces.TRANSMISSION),
    ("emission", surfaces.EMISSION),
    ("strength", surfaces.STRENGTH),
)


def stand_in(material):
    """A copy of a material that looks to the exporter as the material does to Blender; None if it does so itself."""
    surface = surfaces.surface_of(material)
    if surface is None:
        return None
    blends = surface.alpha.image is not None or surface.alpha.value[0] < 1
    blends = blends and material.blend_method == "OPAQUE"
    changed = [setting for setting in _SETTINGS if _is_changed(surface, getattr(surface, setting[0]))]
    normal = _shader_normal(surface)
    rebends = normal is not None and normal.is_linked and (surface.normal is None or surface.normal.socket != normal)
    if surface.shader and not (changed or blends or rebends):
        return None

    copy = material.copy()
    if blends:
        copy.blend_method = "BLEND"
    tree = copy.node_tree
    if surface.shader:
        shader = tree.nodes[surface.shader.name]
    else:
        shader = tree.nodes.new("ShaderNodeBsdfPrincipled")
        output = tree.nodes[surfaces.output_of(material).name]
        tree.links.new(output.inputs["Surface"], shader.outputs[0])
    for name, sockets in changed:
        _set(tree, shader, sockets, getattr(surface, name))
    if rebends or not surface.shader:
        _set_normal(tree, shader, surface.normal)
    return copy


def _is_changed(surface, value):
    if surface.shader is None:
        return True
    return value.entry is not None and not value.is_read


def _shader_normal(surface):
    return surface.shader.inputs["Normal"] if surface.shader else None


def _unlink(tree, socket):
    for link in list(socket.links):
        tree.links.remove(link)


def _counterpart(tree, output):
    """The output in a copied tree that corresponds to one of the original."""
    return next(entry for entry in tree.nodes[output.node.name].outputs if entry.identifier == output.identifier)


def _set(tree, shader, names, value):
    socket = next((shader.inputs[name] for name in names if name in shader.inputs), None)
    if socket is None:
        return
    _unlink(tree, socket)
    if value.image is None:
        number = [float(part) for part in value.value]
        socket.default_value = (*number, 1.0) if socket.type == "RGBA" else number[0]
    elif value.is_read:
        tree.links.new(socket, _counterpart(tree, value.entry.socket.links[0].from_socket))
    else:
        image = tree.nodes.new("ShaderNodeTexImage")
        image.image = value.image.node.image
        channel = "Alpha" if value.image.output.name == "Alpha" else "Color"
        tree.links.new(socket, image.outputs[channel])


def _set_normal(tree, shader, entry):
    socket = shader.inputs["Normal"]
    _unlink(tree, socket)
    if entry is None:
        return
    if not entry.groups and entry.socket.is_linked and nodes.source(entry).is_at_top:
        tree.links.new(socket, _counterpart(tree, entry.socket.links[0].from_socket))
