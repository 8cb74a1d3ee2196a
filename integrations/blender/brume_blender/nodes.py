"""Reads node trees: what a socket is linked to, through reroutes, muted nodes and groups; constants, images, means."""

from dataclasses import dataclass

import bpy
import numpy as np

from . import image_pixels

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


@dataclass(frozen=True)
class Input:
    """An input of a node; `groups` has the group nodes around it, the innermost last."""

    socket: bpy.types.NodeSocket
    groups: tuple = ()


@dataclass(frozen=True)
class Source:
    """What an input comes from: `output` of a node, or without one the value of the unlinked `end`."""

    end: Input
    output: bpy.types.NodeSocket = None

    @property
    def node(self):
        return self.output.node if self.output else None

    @property
    def is_at_top(self):
        """Whether it is outside of all groups."""
        return not self.end.groups

    def input(self, key):
        """An input of the node, by name or number."""
        return Input(self.node.inputs[key], self.end.groups)


def active_output(tree, kind):
    """The output node of a tree; None if it has none."""
    return next((node for node in tree.nodes if node.type == kind and node.is_active_output), None)


def source(entry):
    for _ in range(1000):  # Blender allows no cycles; files that are broken may have them.
        if not entry.socket.is_linked or not entry.socket.links:
            break
        output = entry.socket.links[0].from_socket
        behind = _through(output, entry.groups)
        if behind is None:
            return Source(entry, output)
        entry = behind
    return Source(entry)


def _through(output, groups):
    """The input that an output passes on; None if its node makes something of its own."""
    node = output.node
    if node.type == "REROUTE":
        return Input(node.inputs[0], groups)
    if node.mute:
        passed = [link.from_socket for link in node.internal_links if link.to_socket == output]
        return Input(passed[0], groups) if passed else None
    if node.type == "GROUP" and node.node_tree:
        ends = [end for end in node.node_tree.nodes if end.type == "GROUP_OUTPUT" and end.is_active_output]
        found = [entry for end in ends for entry in end.inputs if entry.identifier == output.identifier]
        return Input(found[0], (*groups, node)) if found else None
    if node.type == "GROUP_INPUT" and groups:
        found = [entry for entry in groups[-1].inputs if entry.identifier == output.identifier]
        return Input(found[0], groups[:-1]) if found else None
    return None


def _as_color(value):
    """Three numbers of a value of any socket."""
    try:
        return np.array(value[:3], dtype=float)
    except TypeError:
        return np.full(3, float(value))


def constant(entry):
    """Three numbers, equal for a number; None if they depend on the place."""
    found = source(entry)
    if found.output is None:
        return _as_color(found.end.socket.default_value) if hasattr(found.end.socket, "default_value") else None
    return _as_color(found.output.default_value) if found.node.type in {"RGB", "VALUE"} else None


def image_node(entry, depth=16):
    """The first node with an image that leads to an input, as a Source; None if there is none."""
    found = source(entry)
    if found.output is None or depth == 0:
        return None
    if found.node.type == "TEX_IMAGE":
        return found if found.node.image else None
    for socket in found.node.inputs:
        behind = image_node(Input(socket, found.end.groups), depth - 1)
        if behind:
            return behind
    return None


def labels(entry):
    """What the nodes that lead to an input are called: those that give a colour; without one, the nearest."""
    nearest = source(entry).node
    found, waiting = [], [(entry, 16)]
    while waiting:
        at, depth = waiting.pop(0)
        behind = source(at)
        if behind.output is None or depth == 0:
            continue
        if behind.node.type.startswith("TEX_") and behind.node.type != "TEX_COORD":
            found.append(behind.node.bl_label)
            continue
        waiting += [(Input(socket, behind.end.groups), depth - 1) for socket in behind.node.inputs]
    return list(dict.fromkeys(found)) or ([nearest.bl_label] if nearest else [])


# Means.


def mean(entry, depth=16):
    """The mean over all places, three numbers; None if it is not known. Nodes that mix give what they make of means."""
    value = constant(entry)
    if value is not None or depth == 0:
        return value
    found = source(entry)
    make = _MEANS.get(found.node.type)
    if make is None:
        return None
    value = make(found, lambda key: mean(found.input(key), depth - 1))
    # A number that takes a colour is its luminance.
    if value is not None and entry.socket.type == "VALUE" and found.output.type == "RGBA":
        value = np.full(3, float(value @ LUMINANCE))
    return value


def _half(found, of):
    return np.full(3, 0.5)


def _checker(found, of):
    if found.output.name != "Color":
        return np.full(3, 0.5)
    first, second = of("Color1"), of("Color2")
    return None if first is None or second is None else (first + second) / 2


def _image(found, of):
    if not found.node.image:
        return None
    color = image_pixels.mean(found.node.image)
    if color is None:
        return None
    return np.full(3, color[3]) if found.output.name == "Alpha" else color[:3]


def _ramp(found, of):
    factor, ramp = constant(found.input("Fac")), found.node.color_ramp
    places = np.linspace(0, 1, 65) if factor is None else [float(factor[0])]
    values = np.mean([ramp.evaluate(place) for place in places], axis=0)
    return np.full(3, values[3]) if found.output.name == "Alpha" else values[:3]


def _mixed(node, factor, first, second):
    if factor is None or first is None or second is None:
        return None
    factor = np.clip(factor, 0, 1)
    made = {"MIX": second, "MULTIPLY": first * second, "ADD": first + second, "SUBTRACT": first - second}
    made = made.get(node.blend_type)
    return None if made is None else (1 - factor) * first + factor * made


def _mix_rgb(found, of):
    return _mixed(found.node, of("Fac"), of("Color1"), of("Color2"))


def _mix(found, of):
    """The node Mix has one socket for each type, of which it shows those in use."""
    if found.node.data_type != "RGBA" or found.node.factor_mode != "UNIFORM":
        return None
    return _mixed(found.node, of(0), of(6), of(7))


def _invert(found, of):
    factor, color = of("Fac"), of("Color")
    return None if factor is None or color is None else (1 - factor) * color + factor * (1 - color)


_MEANS = {
    "TEX_CHECKER": _checker,
    "TEX_BRICK": _checker,
    "TEX_NOISE": _half,
    "TEX_WHITE_NOISE": _half,
    "TEX_WAVE": _half,
    "TEX_MAGIC": _half,
    "TEX_IMAGE": _image,
    "VALTORGB": _ramp,
    "MIX_RGB": _mix_rgb,
    "MIX": _mix,
    "INVERT": _invert,
}
