"""Textures and plain colours of materials for Scene.txt, which has one texture and one roughness per material."""

import os
import struct
import zlib

import bpy
import numpy as np


def srgb(linear):
    """Encodes linear values as sRGB (IEC 61966-2-1)."""
    linear = np.clip(linear, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


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
    width, height = image.size
    if width == 0 or height == 0:
        return None
    values = np.empty(width * height * image.channels, dtype=np.float32)
    image.pixels.foreach_get(values)
    values = values.reshape(height, width, image.channels)[::-1]
    rgba = np.ones((height, width, 4), dtype=np.float32)
    rgba[:, :, : image.channels] = values[:, :, :4]
    if image.channels == 1:
        rgba[:, :, :3] = values
    if image.is_float:  # Float images are linear in memory, byte images encoded.
        rgba[:, :, :3] = srgb(rgba[:, :, :3])
    return np.rint(np.clip(rgba, 0, 1) * 255).astype(np.uint8)


def image_file(image):
    """(extension, bytes) of an image as PNG or JPEG, or None if it has no pixels."""
    data = _stored_bytes(image)
    if _file_kind(data):
        return _file_kind(data), data
    pixels = _pixels(image)
    return None if pixels is None else (".png", png_bytes(pixels))


class Look:
    """A material as Scene.txt represents it: a linear colour or an image, and a roughness."""

    def __init__(self, color=(0.8, 0.8, 0.8), roughness=0.5, image=None):
        self.color, self.roughness, self.image = tuple(color)[:3], roughness, image

    def mean_color(self):
        """The mean colour of the image if there is one, else the plain colour."""
        pixels = _pixels(self.image) if self.image else None
        if pixels is None:
            return self.color
        encoded = pixels[:, :, :3].reshape(-1, 3) / 255.0
        linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
        return tuple(linear.mean(axis=0))


def _image_behind(socket, depth=16):
    """The first image texture that is connected to a socket, directly or through other nodes."""
    if depth == 0:
        return None
    for link in socket.links:
        node = link.from_node
        if node.type == "TEX_IMAGE" and node.image:
            return node.image
        for entry in node.inputs:
            found = _image_behind(entry, depth - 1) if entry.is_linked else None
            if found:
                return found
    return None


def _surface_node(material):
    for node in material.node_tree.nodes:
        if node.type == "OUTPUT_MATERIAL" and node.is_active_output:
            links = node.inputs["Surface"].links
            return links[0].from_node if links else None
    return None


def look_of(material):
    """The look of a material: from its Principled node, else from a surface node with a colour, else from the
    viewport settings."""
    if material is None:
        return Look()
    node = _surface_node(material) if material.use_nodes and material.node_tree else None
    inputs = node.inputs if node else {}
    color = next((inputs[name] for name in ("Base Color", "Color") if name in inputs), None)
    if color is None:
        return Look(material.diffuse_color, material.roughness)
    roughness = inputs["Roughness"].default_value if "Roughness" in inputs else 0.5
    return Look(color.default_value, roughness, _image_behind(color))
