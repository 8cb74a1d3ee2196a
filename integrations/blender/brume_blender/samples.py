"""Smooth edges: images are rendered larger and reduced to the mean of their samples."""

import bpy
import numpy as np


def factor(scene):
    """Samples per pixel along each axis."""
    return int(scene.brume.samples)


def size(scene):
    """Width and height of the image [px], as Blender renders it."""
    render = scene.render
    return tuple(
        max(1, side * render.resolution_percentage // 100) for side in (render.resolution_x, render.resolution_y)
    )


def size_argument(scene):
    """The argument of `brume render --size`."""
    return "x".join(str(side * factor(scene)) for side in size(scene))


def reduce(path, count):
    """Replaces a PNG file by its mean over blocks of `count` x `count` pixels.

    The mean is that of displayed values, so that edges of light sources are as smooth as others.
    """
    if count == 1:
        return
    large = bpy.data.images.load(path)
    try:
        width, height = large.size[0] // count, large.size[1] // count
        pixels = np.empty(4 * large.size[0] * large.size[1], dtype=np.float32)
        large.pixels.foreach_get(pixels)
    finally:
        bpy.data.images.remove(large)
    blocks = pixels.reshape(height, count, width, count, 4)
    small = bpy.data.images.new("brume samples", width, height, alpha=False)
    try:
        small.pixels.foreach_set(blocks.mean(axis=(1, 3)).ravel())
        small.filepath_raw, small.file_format = path, "PNG"
        small.save()
    finally:
        bpy.data.images.remove(small)
