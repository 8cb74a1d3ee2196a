"""The look of a volume: what Blender's Principled Volume does with grids, as settings of a timeline's [[volume]]."""

import math
from dataclasses import dataclass

import numpy as np

from .settings import SETTINGS

# A black body of T kelvin emits per Blender unit sigma / pi * 1e-6 * T^4 of W/(sr m^2) in Blender (Cycles, node
# Principled Volume), and 1 at 1,900 K for each unit of optical depth in Brume (docs/guides/volumes.md).
_GLOW = 5.670373e-8 * 1e-6 / math.pi * 1900.0**4
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
_VOLUME = SETTINGS["volume"]
_MOST_EMISSION = _VOLUME["emission"].high


@dataclass
class Look:
    """Without a material it is that of Blender's default for volumes."""

    extinction: float = 1.0  # Per Blender unit where the density is 1.
    albedo: tuple = (0.5, 0.5, 0.5)
    anisotropy: float = 0.0
    emission: float = 0.0  # Luminance per optical depth at 1,900 K.
    kelvin: float = 1000.0  # Where the grid of temperatures is 1.
    density: str = "density"  # Names of grids.
    temperature: str = "temperature"
    color: str = ""  # "": one colour.


class _Reader:
    """Reads the node of a volume shader; `warn` takes what cannot be taken along."""

    def __init__(self, node, warn):
        self._node, self._warn = node, warn

    def value(self, name):
        """A number, or an array of three: of the socket, or of a Value or RGB node that is linked to it."""
        socket = self._node.inputs[name]
        link = _source(socket)
        if link is not None and link.node.type in {"VALUE", "RGB"}:
            socket = link
        elif link is not None:
            self._warn(f"its {name} is linked to the node {link.node.name}; the value of the socket is exported")
        found = socket.default_value
        return float(found) if socket.type == "VALUE" else np.array(found[:3], dtype=float)

    def attribute(self, name):
        """The grid whose colours an Attribute node gives to a socket; "" without one."""
        link = _source(self._node.inputs[name])
        is_attribute = link is not None and link.node.type == "ATTRIBUTE" and link.identifier == "Color"
        return link.node.attribute_name if is_attribute else ""

    def text(self, name):
        socket = self._node.inputs[name]
        if _source(socket) is not None:
            self._warn(f"its {name} is linked; the name in the socket is exported")
        return socket.default_value

    def has(self, name):
        return name in self._node.inputs


def _source(socket):
    """The output that a socket is linked to, through reroutes; None without a link."""
    while socket.is_linked:
        socket = socket.links[0].from_socket
        if socket.node.type != "REROUTE":
            return socket
        socket = socket.node.inputs[0]
    return None


def _shader_nodes(tree_output):
    """The nodes that lead to the Volume socket of an output node, nearest first; of groups their contents."""
    found, waiting = [], [_source(tree_output)]
    while waiting:
        socket = waiting.pop(0)
        if socket is None or socket.node in found:
            continue
        found.append(socket.node)
        inputs = socket.node.inputs
        if socket.node.type == "GROUP" and socket.node.node_tree:
            inner = socket.node.node_tree.nodes
            ends = [node for node in inner if node.type == "GROUP_OUTPUT" and node.is_active_output]
            inputs = [end for node in ends for end in node.inputs if end.identifier == socket.identifier]
        waiting += [_source(entry) for entry in inputs if entry.type == "SHADER"]
    return found


def look_of(material, warn):
    """The look of a material; None if it has no volume shader, which Blender does not show."""
    if material is None:
        return Look()
    output = material.node_tree.get_output_node("ALL") if material.use_nodes and material.node_tree else None
    nodes = _shader_nodes(output.inputs["Volume"]) if output else []
    shaders = [node for node in nodes if node.type not in {"GROUP", "ADD_SHADER", "MIX_SHADER"}]
    if not shaders:
        return None
    for node in shaders:
        if node.type == "PRINCIPLED_VOLUME":
            if len(shaders) > 1:
                warn("of its shaders only the Principled Volume is exported")
            return _principled(_Reader(node, warn), warn)
    warn(f"its shader is no Principled Volume but {shaders[0].name}; it is exported as Blender's default volume")
    return Look()


def _principled(reader, warn):
    # Cycles scatters the colour and absorbs what it leaves of 1, but for the root of the absorption colour.
    grid = reader.attribute("Color")
    color = np.ones(3) if grid else np.maximum(reader.value("Color"), 0.0)
    absorption = np.sqrt(np.maximum(reader.value("Absorption Color"), 0.0))
    extinctions = color + np.maximum(1 - color, 0.0) * np.maximum(1 - absorption, 0.0)
    mean = float(extinctions.mean())
    if np.ptp(extinctions) > 0.01 * max(mean, 1e-6):
        warn("light of each colour goes through it by another length; Brume takes the mean")
    density = max(reader.value("Density"), 0.0)
    look = Look(extinction=density * mean, density=reader.text("Density Attribute"))
    look.color = grid or reader.text("Color Attribute")
    look.albedo = tuple(np.minimum(color / mean, 1.0)) if mean > 0 else (0.0, 0.0, 0.0)
    anisotropy = reader.value("Anisotropy")
    look.anisotropy = _VOLUME["anisotropy"].clamped(anisotropy)
    if look.anisotropy != anisotropy:
        warn(f"its Anisotropy {anisotropy:.2f} becomes {look.anisotropy:g}")
    if reader.value("Emission Strength") > 0 and max(reader.value("Emission Color")) > 0:
        warn("its Emission is not exported: in Brume only temperatures glow")
    _set_glow(look, reader, warn)
    return look


def _set_glow(look, reader, warn):
    blackbody = max(reader.value("Blackbody Intensity"), 0.0)
    if blackbody == 0:
        return
    look.temperature = reader.text("Temperature Attribute")
    look.kelvin = _VOLUME["kelvin"].clamped(reader.value("Temperature"))
    tint = np.maximum(reader.value("Blackbody Tint"), 0.0)
    if np.ptp(tint) > 0.01 * max(tint.max(), 1e-6):
        warn("its Blackbody Tint is not exported, but for its brightness")
    glow = blackbody * _GLOW * float(tint @ _LUMINANCE)
    # What glows without any density gets the least that Brume can make glow as much.
    look.extinction = max(look.extinction, glow / _MOST_EMISSION)
    if look.extinction > 0:
        look.emission = glow / look.extinction
