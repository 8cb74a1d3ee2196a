"""Textures and plain colours of materials for Scene.txt, which has one texture and one roughness per material."""

import os
import struct
import zlib

import bpy
import numpy as np

from . import image_pixels, surfaces
from .image_pixels import srgb


def png_bytes(pixels):
    """Encodes rows of RGBA bytes, top row first, as PNG (W3C PNG, 2003: IHDR, IDAT, IEND, no filter)."""
    height, width, _ = pixels.shape

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    rows = np.zeros((height, 1 + 4 * width), dtype=np.uint8)
    rows[:, 1:] = pixels.reshape(height, 4 * width)
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    data = zlib.compress(rows.tobytes(), 6)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", data) + chunk(b"IEND", b"")


def plain_png(colors):
    """A PNG with a row of 16 x 16 texel tiles, one per linear colour."""
    tiles = [np.full((16, 16, 4), 255, dtype=np.uint8) for _ in colors]
    for tile, color in zip(tiles, colors):
        tile[:, :, :3] = np.rint(srgb(np.array(color[:3])) * 255)
    return png_bytes(np.concatenate(tiles, axis=1))


def _file_kind(data):
    if data.startswith(b"\x89PNG\r\n\x1a\n"):
        return ".png"
    return ".jpg" if data.startswith(b"\xff\xd8\xff") else None


def _stored_bytes(image):
    """The bytes of the file that an image was loaded from; empty if the image was modified or the file is gone."""
    if image.is_dirty or image.source != "FILE":
        return b""
    if image.packed_file:
        return bytes(image.packed_file.data)
    path = bpy.path.abspath(image.filepath, library=image.library)
    if not os.path.isfile(path):
        return b""
    with open(path, "rb") as file:
        return file.read()


def _pixels(image):
    """sRGB-encoded RGBA bytes, top row first; None if the image has no pixels."""
    rgba = image_pixels.read(image)
    if rgba is None:
        return None
    if image.is_float:
        rgba = np.concatenate([srgb(rgba[:, :, :3]), rgba[:, :, 3:]], axis=2)
    return np.rint(np.clip(rgba, 0, 1) * 255).astype(np.uint8)


def image_file(image):
    """(extension, bytes) of an image as PNG or JPEG, or None if it has no pixels."""
    data = _stored_bytes(image)
    if _file_kind(data):
        return _file_kind(data), data
    found = _pixels(image)
    return None if found is None else (".png", png_bytes(found))


class Look:
    """A material as Scene.txt represents it: a linear colour or an image, a roughness, and whether it is glass."""

    def __init__(self, color=(0.8, 0.8, 0.8), roughness=0.5, image=None, is_glass=False):
        self.color, self.roughness, self.image = tuple(color)[:3], roughness, image
        self.is_glass = is_glass

    def mean_color(self):
        """The mean colour of the image if there is one, else the plain colour."""
        found = _pixels(self.image) if self.image else None
        if found is None:
            return self.color
        return tuple(image_pixels.linear(found[:, :, :3].reshape(-1, 3) / 255.0).mean(axis=0))


def look_of(material):
    """The look of a material: that of its surface, else of the viewport settings."""
    if material is None:
        return Look()
    surface = surfaces.surface_of(material)
    if surface is None:
        return Look(material.diffuse_color, material.roughness)
    image = surface.color.image.node.image if surface.color.image else None
    return Look(surface.color.value, float(surface.roughness.value[0]), image, surface.is_glass)
