"""The world as the sky of a timeline."""

import numpy as np

from . import image_pixels, nodes

_MOST = 1000.0  # Of the settings of a timeline.
# What a surface in the open gets from all directions, relative to `ambient` (docs/guides/timelines.md).
_MEAN_OF_AMBIENT = 0.75


def sky(scene, warnings):
    """Zenith, horizon and ambient of the timeline, linear colours; None: Brume's own daylight."""
    if scene.brume.sky != "WORLD":
        return None
    radiance = _radiance(scene.world, warnings)
    if radiance is None:
        return None
    shown = np.clip(radiance, 0, _MOST)
    return shown, shown, np.clip(radiance / _MEAN_OF_AMBIENT, 0, _MOST)


def _radiance(world, warnings):
    """The radiance of a world from all directions, or its mean; None if it is not known."""
    if world is None:
        return np.zeros(3)
    if not world.use_nodes or not world.node_tree:
        return np.array(world.color)
    output = nodes.active_output(world.node_tree, "OUTPUT_WORLD")
    if output is None:
        return np.zeros(3)
    if nodes.source(nodes.Input(output.inputs["Volume"])).output:
        warnings.add("the volume of the world is not exported")
    surface = nodes.Input(output.inputs["Surface"])
    found = nodes.source(surface)
    if found.output is None:
        return np.zeros(3)
    if found.node.type == "BACKGROUND":
        strength = nodes.constant(found.input("Strength"))
        color = nodes.constant(found.input("Color"))
        if strength is not None and color is None:
            color = _mean_of_environment(nodes.source(found.input("Color")), warnings)
        if strength is not None and color is not None:
            return color * strength
    named = " and ".join(nodes.labels(surface))
    warnings.add(f"the world is no plain colour but {named}, which is not exported: the sky is Brume's daylight")
    return None


def _mean_of_environment(found, warnings):
    """The mean of an image around the scene over all directions."""
    if found.node.type != "TEX_ENVIRONMENT" or not found.node.image:
        return None
    height = found.node.image.size[1]
    rows = np.cos(np.pi * ((np.arange(height) + 0.5) / max(height, 1) - 0.5))
    mean = image_pixels.mean(found.node.image, rows if found.node.projection == "EQUIRECTANGULAR" else None)
    if mean is None:
        return None
    warnings.add("the Environment Texture of the world is not exported: the sky has its mean colour")
    return mean[:3]
