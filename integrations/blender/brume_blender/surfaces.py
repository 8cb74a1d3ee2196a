"""The surface of a material as both formats carry it: one shader with constants, images, and means of the rest."""

from dataclasses import dataclass, field

import numpy as np

from . import nodes

# Names of sockets, before and since Blender 4.0.
COLOR, ROUGHNESS, METALLIC, ALPHA = ("Base Color",), ("Roughness",), ("Metallic",), ("Alpha",)
TRANSMISSION = ("Transmission", "Transmission Weight")
EMISSION, STRENGTH = ("Emission", "Emission Color"), ("Emission Strength",)
NORMAL = ("Normal",)
_SUBSURFACE = ("Subsurface", "Subsurface Weight")

_SEE_THROUGH, _GLASS = {"BSDF_TRANSPARENT"}, {"BSDF_GLASS", "BSDF_REFRACTION"}
_KNOWN = _SEE_THROUGH | _GLASS | {"BSDF_PRINCIPLED", "BSDF_DIFFUSE", "BSDF_GLOSSY", "BSDF_ANISOTROPIC", "EMISSION"}
_LEAST = 1e-3  # Weight of a shader that is not dropped.
_FACING = 0.05  # What mixes by angle give to their second shader where a surface faces the eye.


@dataclass
class Value:
    """A setting: three numbers, or an image that they multiply."""

    value: np.ndarray
    entry: nodes.Input = None  # Where it is read.
    image: nodes.Source = None
    is_read: bool = True  # Whether Blender's exporter reads it from where it is.

    @classmethod
    def of(cls, *numbers):
        return cls(np.broadcast_to(np.array(numbers, dtype=float), 3).copy(), is_read=False)


@dataclass
class Surface:
    shader: object = None  # The Principled shader that is all there is, outside of groups; None: there are others.
    color: Value = field(default_factory=lambda: Value.of(0.8))
    roughness: Value = field(default_factory=lambda: Value.of(0.5))
    metallic: Value = field(default_factory=lambda: Value.of(0))
    alpha: Value = field(default_factory=lambda: Value.of(1))
    transmission: Value = field(default_factory=lambda: Value.of(0))
    emission: Value = field(default_factory=lambda: Value.of(0))
    strength: Value = field(default_factory=lambda: Value.of(1))
    normal: nodes.Input = None  # The input of a normal map; None: the mesh's own.
    has_bump: bool = False  # Its normals are bumped by other nodes.
    lost: list = field(default_factory=list)  # What textures become that are not exported.
    kinds: set = field(default_factory=set)  # Of what else is not exported.

    @property
    def is_glass(self):
        faint = self.alpha.image is None and self.alpha.value[0] < 0.5
        return faint or self.transmission.value[0] >= 0.5


@dataclass
class _Leaf:
    found: nodes.Source
    weight: float

    @property
    def type(self):
        return self.found.node.type

    def entry(self, names):
        """Its input with the first of these names; None without one."""
        name = next((name for name in names if name in self.found.node.inputs), None)
        return self.found.input(name) if name else None


def output_of(material):
    """The output node of a material; None if it has none."""
    if material is None or not material.use_nodes or not material.node_tree:
        return None
    return nodes.active_output(material.node_tree, "OUTPUT_MATERIAL")


def is_linked(material, name):
    """Whether something leads to an input of the output node: Surface, Volume, Displacement."""
    output = output_of(material)
    return output is not None and nodes.source(nodes.Input(output.inputs[name])).output is not None


def surface_of(material):
    """The surface of a material; None if no shader leads to its output."""
    output = output_of(material)
    if output is None:
        return None
    surface = Surface()
    leaves = _leaves(nodes.Input(output.inputs["Surface"]), 1.0, surface)
    if not leaves:
        return None
    if len(leaves) == 1 and leaves[0].type == "BSDF_PRINCIPLED":
        _read_principled(surface, leaves[0])
        surface.shader = leaves[0].found.node if leaves[0].found.is_at_top else None
    else:
        _mix(surface, leaves)
    transmitted = surface.transmission.value[0]
    if 0 < transmitted < 0.5:
        surface.kinds.add("FAINT")
    if surface.has_bump:
        surface.kinds.add("BUMP")
    return surface


# Trees of shaders.


def _leaves(entry, weight, surface, depth=16):
    """The shaders that lead to an input, with their weights; sets the alpha of a surface that an image cuts out."""
    found = nodes.source(entry)
    if found.output is None or weight < _LEAST or depth == 0:
        return []
    if found.node.type == "ADD_SHADER":
        return [leaf for i in (0, 1) for leaf in _leaves(found.input(i), weight, surface, depth - 1)]
    if found.node.type != "MIX_SHADER":
        return [_Leaf(found, weight)]
    image = nodes.image_node(found.input(0))
    if image and depth == 16 and _is_clear(found.input(1)):
        surface.alpha = _read(surface, found.input(0), "Fac", 1)
        return _leaves(found.input(2), weight, surface, depth - 1)
    factor = _factor(found.input(0))
    return _leaves(found.input(1), weight * (1 - factor), surface, depth - 1) + _leaves(
        found.input(2), weight * factor, surface, depth - 1
    )


def _is_clear(entry):
    node = nodes.source(entry).node
    return node is not None and node.type in _SEE_THROUGH


def _factor(entry):
    """The weight of the second shader of a mix: its mean, or what the camera sees of a surface that faces it."""
    value = nodes.mean(entry)
    if value is not None:
        return float(np.clip(value[0], 0, 1))
    types = {}
    waiting = [nodes.source(entry)]
    while waiting and len(types) < 1000:
        found = waiting.pop()
        if found.output is None or found.node.type in types:
            continue
        types[found.node.type] = found.output.name
        waiting += [nodes.source(nodes.Input(socket, found.end.groups)) for socket in found.node.inputs]
    if "LIGHT_PATH" in types:
        return 1.0 if types["LIGHT_PATH"] == "Is Camera Ray" else 0.0
    return _FACING if types.keys() & {"FRESNEL", "LAYER_WEIGHT"} else 0.5


# Single settings.


def _describe(value):
    return f"{float(value[0]):.2g}"


def _read(surface, entry, name, otherwise, is_color=False):
    """A setting of a shader; adds to surface.lost what of it is no constant and no image."""
    if entry is None:
        return Value.of(otherwise)
    found, value = nodes.source(entry), nodes.constant(entry)
    if value is not None:
        plain = found.output is None or found.node.type == ("RGB" if is_color else "VALUE")
        return Value(value, entry, is_read=plain and found.is_at_top and not entry.groups)
    if is_color and found.node.type in {"VERTEX_COLOR", "ATTRIBUTE"}:
        return Value(np.ones(3), entry, is_read=False)  # The mesh has them.
    named = " and ".join(nodes.labels(entry))
    image = nodes.image_node(entry)
    if image:
        if not _is_plain_image(found, image):
            surface.lost.append(f"{name} ({named}, {found.node.bl_label}) becomes its image alone")
        if not _is_placed_by_uv(image):
            surface.kinds.add("PLACED")
        at_top = image.is_at_top and found.is_at_top and not entry.groups
        return Value(np.ones(3), entry, image, is_read=at_top)
    value = nodes.mean(entry)
    if is_color:
        surface.lost.append(f"{name} ({named}) becomes {'white' if value is None else 'its mean colour'}")
    else:
        value = np.full(3, otherwise) if value is None else value
        surface.lost.append(f"{name} ({named}) becomes {_describe(value)}")
    return Value(np.ones(3) if value is None else np.maximum(value, 0), entry, is_read=False)


def _is_plain_image(found, image):
    """Whether nothing but a channel or a constant factor is between a source and its image."""
    if found.node == image.node:
        return True
    node = found.node
    if node.type in {"SEPRGB", "SEPARATE_COLOR"}:
        return nodes.source(found.input(0)).node == image.node
    if node.type == "MIX" and node.data_type == "RGBA" and node.blend_type == "MULTIPLY":
        return _is_times_image(found, (6, 7), image)
    if node.type == "MATH" and node.operation == "MULTIPLY":
        return _is_times_image(found, (0, 1), image)
    return False


def _is_times_image(found, keys, image):
    constants = [key for key in keys if nodes.constant(found.input(key)) is not None]
    return len(constants) == 1 and any(nodes.source(found.input(key)).node == image.node for key in keys)


def _is_placed_by_uv(image):
    if image.node.projection != "FLAT":
        return False
    found = nodes.source(image.input("Vector"))
    if found.output is not None and found.node.type == "MAPPING":
        found = nodes.source(found.input("Vector"))
    if found.output is None:
        return True
    return found.node.type == "UVMAP" or (found.node.type == "TEX_COORD" and found.output.name == "UV")


def _read_normal(surface, entry):
    """Takes the normal map behind a bump, which exporters would take for one."""
    while entry is not None:
        found = nodes.source(entry)
        if found.output is None:
            return
        if found.node.type != "BUMP":
            surface.has_bump = surface.has_bump or found.node.type != "NORMAL_MAP" or not nodes.image_node(entry)
            surface.normal = entry if found.node.type == "NORMAL_MAP" else None
            return
        surface.has_bump = True
        entry = found.input("Normal")


def _read_principled(surface, leaf):
    def read(names, otherwise, is_color=False):
        return _read(surface, leaf.entry(names), names[0], otherwise, is_color)

    surface.color, surface.roughness = read(COLOR, 0.8, True), read(ROUGHNESS, 0.5)
    surface.metallic, surface.transmission = read(METALLIC, 0), read(TRANSMISSION, 0)
    if surface.transmission.image:
        value = nodes.mean(leaf.entry(TRANSMISSION))
        surface.transmission = Value.of(0 if value is None else value[0])
        surface.lost.append(f"{TRANSMISSION[0]} (Image Texture) becomes {_describe(surface.transmission.value)}")
    if surface.alpha.image is None:
        surface.alpha = read(ALPHA, 1)
    surface.strength = read(STRENGTH, 1)
    if surface.strength.image:
        value = nodes.mean(leaf.entry(STRENGTH))
        surface.strength = Value.of(1 if value is None else value[0])
        surface.lost.append(f"{STRENGTH[0]} (Image Texture) becomes {_describe(surface.strength.value)}")
    if surface.strength.value[0] > 0:
        surface.emission = read(EMISSION, 0, True)
    _read_normal(surface, leaf.entry(NORMAL))
    subsurface = leaf.entry(_SUBSURFACE)
    if subsurface and (subsurface.socket.is_linked or subsurface.socket.default_value > 0):
        surface.kinds.add("SUBSURFACE")


def _one(leaf, into):
    """The surface of a single shader."""
    own = Surface()
    if leaf.type == "BSDF_PRINCIPLED":
        _read_principled(own, leaf)
    else:
        own.color = _read(own, leaf.entry(("Color", "Base Color", "Diffuse Color")), "Color", 0.8, True)
        otherwise = 0 if leaf.type in _GLASS | _SEE_THROUGH else 0.5
        own.roughness = _read(own, leaf.entry(ROUGHNESS), "Roughness", otherwise)
        _read_normal(own, leaf.entry(NORMAL))
        if leaf.type == "BSDF_DIFFUSE":
            own.roughness = Value.of(1)
        own.metallic = Value.of(leaf.type in {"BSDF_GLOSSY", "BSDF_ANISOTROPIC"})
        own.transmission = Value.of(leaf.type in _GLASS)
    if leaf.type == "SUBSURFACE_SCATTERING":
        into.kinds.add("SUBSURFACE")
    elif leaf.type not in _KNOWN:
        into.kinds.add("SHADER " + leaf.found.node.bl_label)
    return own


def _emitted(into, leaf):
    color = _read(into, leaf.entry(("Color",)), "Color", 1, True)
    strength = _read(into, leaf.entry(("Strength",)), "Strength", 1)
    return color, strength


def _mix(surface, leaves):
    """One surface for several shaders, or for one that is not Principled."""
    glowing = [leaf for leaf in leaves if leaf.type == "EMISSION"]
    clear = [leaf for leaf in leaves if leaf.type in _SEE_THROUGH]
    others = sorted((leaf for leaf in leaves if leaf not in glowing + clear), key=lambda leaf: -leaf.weight)
    owns = [(_one(leaf, surface), leaf.weight) for leaf in others]
    if len(others) > 1:
        surface.kinds.add("MIX")
    seen, weight = sum(leaf.weight for leaf in clear), sum(leaf.weight for leaf in others)
    tints = [(_one(leaf, surface), leaf.weight) for leaf in clear]
    surface.lost += [text for own, _ in tints for text in own.lost]
    tint = sum(own.color.value * part for own, part in tints)

    if owns:
        _take_mean(surface, owns, weight)
        transmitted = surface.transmission.value[0]
        if clear and transmitted >= 0.5:
            # Both are seen through: one tint.
            mean = (tint + surface.color.value * weight) / (seen + weight)
            surface.color = Value(mean, is_read=False)
            surface.transmission = Value.of((transmitted * weight + seen) / (seen + weight))
        elif clear:
            surface.alpha = Value.of(surface.alpha.value[0] * weight / (seen + weight))
    elif clear:
        surface.color, surface.transmission = Value(tint / seen, is_read=False), Value.of(1)
        surface.roughness = Value.of(0)
    else:
        surface.color = Value.of(0)
    _add_glow(surface, glowing)


def _take_mean(surface, owns, weight):
    """The mean of surfaces, with the images of the one that has most weight."""
    first = owns[0][0]
    surface.color, surface.normal, surface.has_bump = first.color, first.normal, first.has_bump
    surface.emission, surface.strength = first.emission, first.strength
    if surface.alpha.image is None:
        surface.alpha = first.alpha
    for own, _ in owns:
        surface.lost += [text for text in own.lost if text not in surface.lost]
        surface.kinds |= own.kinds
    for name in ("color", "roughness", "metallic", "transmission"):
        value = getattr(first, name)
        if len(owns) > 1 and value.image is None:
            value = Value(sum(getattr(own, name).value * part for own, part in owns) / weight, is_read=False)
        setattr(surface, name, value)


def _add_glow(surface, glowing):
    if not glowing:
        return
    parts = [(*_emitted(surface, leaf), leaf.weight) for leaf in glowing]
    if len(parts) == 1:
        color, strength, weight = parts[0]
        surface.emission, surface.strength = color, Value.of(strength.value[0] * weight)
        return
    total = sum(color.value * strength.value[0] * weight for color, strength, weight in parts)
    most = max(float(total.max()), 1e-6)
    surface.emission, surface.strength = Value(total / most, is_read=False), Value.of(most)
