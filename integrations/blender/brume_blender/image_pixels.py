"""The pixels of Blender's images as arrays."""

import numpy as np


def srgb(linear):
    """Encodes linear values as sRGB (IEC 61966-2-1)."""
    linear = np.clip(linear, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def linear(encoded):
    """The reverse of srgb()."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def read(image):
    """RGBA as Blender stores them, top row first: float images are linear, byte images encoded. None without pixels."""
    width, height = image.size
    if width == 0 or height == 0:
        return None
    values = np.empty(width * height * image.channels, dtype=np.float32)
    image.pixels.foreach_get(values)
    values = values.reshape(height, width, image.channels)[::-1]
    if image.channels == 4:
        return values
    rgba = np.ones((height, width, 4), dtype=np.float32)
    rgba[:, :, : image.channels] = values[:, :, :4]
    if image.channels == 1:
        rgba[:, :, :3] = values
    return rgba


def mean(image, weights=None):
    """The mean, linear RGB and alpha, with one weight per row; None if the image has no pixels."""
    rgba = read(image)
    if rgba is None:
        return None
    color = rgba[:, :, :3]
    if not image.is_float and image.colorspace_settings.name == "sRGB":
        color = linear(color)
    means = np.concatenate([color.mean(axis=1), rgba[:, :, 3:].mean(axis=1)], axis=1)
    return np.average(means.astype(float), axis=0, weights=weights)
