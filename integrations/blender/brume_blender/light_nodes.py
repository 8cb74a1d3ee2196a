"""Nodes of lights."""

import numpy as np

from . import nodes


def factor_of(light):
    """What the nodes of a light multiply its colour by, and the names of those that are not exported."""
    if not light.use_nodes or not light.node_tree:
        return np.ones(3), []
    output = nodes.active_output(light.node_tree, "OUTPUT_LIGHT")
    if output is None:
        return np.ones(3), []
    surface = nodes.Input(output.inputs["Surface"])
    found = nodes.source(surface)
    if found.output is None:
        return np.zeros(3), []
    lost = []
    factor = np.ones(3)
    if found.node.type != "EMISSION":
        return factor, [found.node.bl_label]
    for name in ("Color", "Strength"):
        value = nodes.constant(found.input(name))
        if value is None:
            lost += nodes.labels(found.input(name))
        else:
            factor = factor * value
    return factor, lost
