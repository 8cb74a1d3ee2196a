"""Image files as numpy arrays of rows from the top: OpenEXR in, PNG out."""
import struct
import zlib

import numpy

ROWS = {0: 1, 2: 1, 3: 16}  # of a block, by compression: none, ZIPS, ZIP


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _header(data):
    """The attributes of a file of one part, and where they end."""
    at, found = 8, {}
    while data[at]:
        name, at = _text(data, at)
        _, at = _text(data, at)
        size, = struct.unpack_from("<i", data, at)
        found[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return found, at + 1


def _channels(data):
    """Names and types in the file's order: 1 half, 2 float."""
    at, found = 0, []
    while data[at]:
        name, at = _text(data, at)
        kind, _, across, down = struct.unpack_from("<iiii", data, at)
        if kind not in (1, 2) or (across, down) != (1, 1):
            raise ValueError(f"channel {name}: expected half floats or floats for every pixel")
        found.append((name, "<f2" if kind == 1 else "<f4"))
        at += 16
    return found


def _unzip(block, length):
    """Undoes OpenEXR's ZIP compression: deflate, differences of bytes, and even and odd bytes apart."""
    if len(block) == length:
        return block
    coded = numpy.frombuffer(zlib.decompress(block), numpy.uint8)
    # Modulo 256, where -128 is 128.
    plain = numpy.cumsum(coded, dtype=numpy.uint8) + (128 * numpy.arange(length)).astype(numpy.uint8)
    mixed = numpy.empty(length, numpy.uint8)
    mixed[0::2], mixed[1::2] = plain[:(length + 1) // 2], plain[(length + 1) // 2:]
    return mixed.tobytes()


def read_exr(path):
    """All layers by name, of scan lines, plain or ZIP compressed (the format's specification, "OpenEXR File Layout");
    `brume render`, Cycles and vdb_render write such files."""
    data = path.read_bytes()
    magic, version = struct.unpack_from("<II", data, 0)
    if magic != 20000630 or version & ~0x400 != 2:
        raise ValueError(f"{path}: expected an OpenEXR file of scan lines")
    header, at = _header(data)
    most_rows = ROWS.get(header["compression"][0])
    if most_rows is None:
        raise ValueError(f"{path}: expected no compression, or ZIP")
    left, top, right, bottom = struct.unpack("<iiii", header["dataWindow"])
    width, height, channels = right - left + 1, bottom - top + 1, _channels(header["channels"])
    row = numpy.dtype([(name, kind, (width,)) for name, kind in channels])
    layers = {name: numpy.empty((height, width)) for name, _ in channels}
    for offset in struct.unpack_from(f"<{-(-height // most_rows)}Q", data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        rows = min(most_rows, bottom - y + 1)
        block = _unzip(data[offset + 8:offset + 8 + size], rows * row.itemsize)
        values = numpy.frombuffer(block, row, rows)
        for name, _ in channels:
            layers[name][y - top:y - top + rows] = values[name]
    return layers


def radiance(layers, prefix=""):
    """R, G and B of layers; the infinite ones of half floats are the largest half float."""
    return numpy.minimum(numpy.stack([layers[prefix + c] for c in "RGB"], axis=-1), 65504.0)


def srgb(linear):
    """8 bits of what a screen shows, of values from 0 to 1; those beyond are clipped."""
    c = numpy.clip(linear, 0, 1)
    encoded = numpy.where(c <= 0.0031308, 12.92 * c, 1.055 * numpy.maximum(c, 1e-9)**(1 / 2.4) - 0.055)
    return numpy.rint(255 * encoded).astype(numpy.uint8)


def _chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def _write(path, shape, kind, rows, palette=b""):
    path.write_bytes(b"\x89PNG\r\n\x1a\n" +
                     _chunk(b"IHDR", struct.pack(">2I5B", shape[1], shape[0], 8, kind, 0, 0, 0)) + palette +
                     _chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)) + _chunk(b"IEND", b""))


def write_png(path, rgb):
    """8 bits per channel."""
    plain = rgb.reshape(rgb.shape[0], -1)
    rows = numpy.concatenate([numpy.zeros((rgb.shape[0], 1), numpy.uint8), plain], axis=1)
    # Each row as differences from the one above: smooth pictures become smaller.
    rows[1:, 1:] -= plain[:-1]
    rows[1:, 0] = 2
    _write(path, rgb.shape, 2, rows)


def _palette(colours, counts):
    """Up to 256 colours and the number of each given one's, by median cut (Heckbert 1982)."""
    boxes = [numpy.arange(len(colours))]

    def size(box):
        return numpy.ptp(colours[box], axis=0).max() * counts[box].sum()**0.25
    sizes = [size(boxes[0])]
    while len(boxes) < 256 and max(sizes) > 0:
        i = int(numpy.argmax(sizes))
        box = boxes[i]
        box = box[numpy.argsort(colours[box, int(numpy.argmax(numpy.ptp(colours[box], axis=0)))], kind="stable")]
        sums = numpy.cumsum(counts[box])
        cut = min(max(int(numpy.searchsorted(sums, sums[-1] / 2)), 1), len(box) - 1)
        boxes[i:i + 1] = box[:cut], box[cut:]
        sizes[i:i + 1] = size(box[:cut]), size(box[cut:])
    number = numpy.zeros(len(colours), numpy.uint8)
    for i, box in enumerate(boxes):
        number[box] = i
    return numpy.rint([numpy.average(colours[box], axis=0, weights=counts[box]) for box in boxes]), number


def write_palette_png(path, rgb):
    """Of at most 256 colours, so that the noise of path tracing costs less."""
    colours, of_pixel, counts = numpy.unique(rgb.reshape(-1, 3), axis=0, return_inverse=True, return_counts=True)
    palette, number = _palette(colours.astype(numpy.float64), counts)
    rows = number[of_pixel].reshape(rgb.shape[:2])
    rows = numpy.concatenate([numpy.zeros((rows.shape[0], 1), numpy.uint8), rows], axis=1)
    _write(path, rgb.shape, 3, rows, _chunk(b"PLTE", palette.astype(numpy.uint8).tobytes()))
