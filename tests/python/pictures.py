"""Reads the pictures that the program writes, with nothing but NumPy."""

import struct
import zlib
from pathlib import Path

import numpy as np


def read_png(path):
    """A PNG of 8-bit RGB: (height, width, 3)."""
    data = Path(path).read_bytes()
    at, compressed = 8, b""
    while at < len(data):
        (length,), kind = struct.unpack(">I", data[at:at + 4]), data[at + 4:at + 8]
        if kind == b"IHDR":
            width, height, bits, color = struct.unpack(">IIBB", data[at + 8:at + 18])
            assert (bits, color) == (8, 2)
        if kind == b"IDAT":
            compressed += data[at + 8:at + 8 + length]
        at += 12 + length
    rows = np.frombuffer(zlib.decompress(compressed), np.uint8).reshape(height, 1 + 3 * width)
    result = np.zeros((height + 1, width + 1, 3), int)  # With a row above and a column before of zeros.
    for y in range(height):
        kind, row = rows[y, 0], rows[y, 1:].reshape(width, 3).astype(int)
        above = result[y]
        for x in range(width):
            a, b, c = result[y + 1, x], above[x + 1], above[x]
            if kind == 4:
                p = a + b - c
                pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
                add = np.where((pa <= pb) & (pa <= pc), a, np.where(pb <= pc, b, c))
            else:
                add = (0, a, b, (a + b) // 2)[kind]
            result[y + 1, x + 1] = (row[x] + add) & 255
    return result[1:, 1:].astype(np.uint8)


def read_exr(path):
    """The channels of an OpenEXR file compressed by ZIP, by name: (height, width)."""
    data, at, header = Path(path).read_bytes(), 8, {}
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)
        (size,) = struct.unpack("<i", rest[:4])
        header[name.decode()] = rest[4:4 + size]
        at += len(name) + len(kind) + 6 + size
    assert header["compression"][0] == 3  # ZIP: blocks of 16 lines.
    _, _, right, bottom = struct.unpack("<4i", header["dataWindow"])
    width, height, channels, listed = right + 1, bottom + 1, {}, header["channels"]
    while listed[0]:
        name, rest = listed.split(b"\0", 1)
        channels[name.decode()] = np.dtype(("<u4", "<f2", "<f4")[struct.unpack("<i", rest[:4])[0]])
        listed = rest[16:]
    result = {name: np.zeros((height, width), dtype) for name, dtype in channels.items()}
    blocks = (height + 15) // 16
    for (offset,) in struct.iter_unpack("<Q", data[at + 1:at + 1 + 8 * blocks]):
        first, size = struct.unpack("<ii", data[offset:offset + 8])
        packed = data[offset + 8:offset + 8 + size]
        rows = min(16, height - first)
        plain = rows * width * sum(dtype.itemsize for dtype in channels.values())
        if size < plain:  # Differences, of all first halves of the bytes before all second halves.
            deltas = np.frombuffer(zlib.decompress(packed), np.uint8).astype(np.int64)
            deltas[1:] -= 128
            values = (np.cumsum(deltas) & 255).astype(np.uint8)
            both = np.empty(plain, np.uint8)
            both[::2], both[1::2] = values[:(plain + 1) // 2], values[(plain + 1) // 2:]
            packed = both.tobytes()
        place = 0
        for row in range(first, first + rows):
            for name in sorted(channels):
                bytes_ = width * channels[name].itemsize
                result[name][row] = np.frombuffer(packed[place:place + bytes_], channels[name])
                place += bytes_
    return result
