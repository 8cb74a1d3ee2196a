"""Pictures as numpy arrays of rows from the top: OpenEXR in, what a screen shows and PNG out, and what differs."""
import struct
import zlib

import numpy

LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _header(data):
    at, found = 8, {}
    while data[at]:
        name, at = _text(data, at)
        _, at = _text(data, at)
        size, = struct.unpack_from("<i", data, at)
        found[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return found, at + 1


def _channels(data):
    at, found = 0, []
    while data[at]:
        name, at = _text(data, at)
        kind, = struct.unpack_from("<i", data, at)
        found.append((name, {1: "<f2", 2: "<f4"}[kind]))
        at += 16
    return found


def _unzip(block, length):
    """Undoes OpenEXR's ZIP compression: deflate, differences of bytes, and even and odd bytes apart."""
    if len(block) == length:
        return block
    coded = numpy.frombuffer(zlib.decompress(block), numpy.uint8)
    plain = (numpy.cumsum(coded.astype(numpy.int64)) - 128 * numpy.arange(length)).astype(numpy.uint8)
    mixed = numpy.empty(length, numpy.uint8)
    mixed[0::2], mixed[1::2] = plain[:(length + 1) // 2], plain[(length + 1) // 2:]
    return mixed.tobytes()


def read_exr(path):
    """Layers by name: those of `brume render`, scan lines with ZIP compression (docs/exr.md)."""
    data = path.read_bytes()
    header, at = _header(data)
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height, channels = x1 - x0 + 1, y1 - y0 + 1, _channels(header["channels"])
    layers = {name: numpy.empty((height, width), numpy.float64) for name, _ in channels}
    row_bytes = width * sum(numpy.dtype(kind).itemsize for _, kind in channels)
    offsets = struct.unpack_from(f"<{-(-height // 16)}Q", data, at)
    for offset in offsets:
        y, size = struct.unpack_from("<ii", data, offset)
        y -= y0
        rows = min(16, height - y)
        block, place = _unzip(data[offset + 8:offset + 8 + size], rows * row_bytes), 0
        for row in range(y, y + rows):
            for name, kind in channels:
                layers[name][row] = numpy.frombuffer(block, kind, width, place)
                place += width * numpy.dtype(kind).itemsize
    return layers


def radiance(layers, prefix=""):
    """R, G and B of layers; the infinite ones of half floats are the largest half float."""
    return numpy.minimum(numpy.stack([layers[prefix + c] for c in "RGB"], axis=-1), 65504.0)


def averaged(values, times):
    """Means over squares of so many pixels."""
    height, width = values.shape[0] // times, values.shape[1] // times
    return values.reshape(height, times, width, times, *values.shape[2:]).mean(axis=(1, 3))


def _neutral(c):
    """Khronos PBR Neutral (shaders/shared/tone.h)."""
    x = c.min(axis=-1, keepdims=True)
    c = c - numpy.where(x < 0.08, x - 6.25 * x * x, 0.04)
    peak = c.max(axis=-1, keepdims=True)
    start, d = 0.76, 0.24
    new_peak = 1 - d * d / (numpy.maximum(peak, start) + d - start)
    bleach = 1 - 1 / (0.15 * (peak - new_peak) + 1)
    scaled = c * (new_peak / numpy.maximum(peak, 1e-9))
    return numpy.where(peak < start, c, scaled + (new_peak - scaled) * bleach)


def shown(linear, exposure, tone):
    """What a screen shows: 8 bits, without dither."""
    c = linear * 2.0**exposure
    c = numpy.clip(_neutral(c) if tone == "neutral" else c, 0, 1)
    encoded = numpy.where(c <= 0.0031308, 12.92 * c, 1.055 * numpy.maximum(c, 1e-9)**(1 / 2.4) - 0.055)
    return numpy.rint(255 * encoded).astype(numpy.uint8)


def _chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def _write(path, shape, kind, rows, palette=b""):
    path.write_bytes(b"\x89PNG\r\n\x1a\n" +
                     _chunk(b"IHDR", struct.pack(">2I5B", shape[1], shape[0], 8, kind, 0, 0, 0)) + palette +
                     _chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)) + _chunk(b"IEND", b""))


def write_png(path, rgb):
    plain = rgb.reshape(rgb.shape[0], -1)
    rows = numpy.concatenate([numpy.zeros((rgb.shape[0], 1), numpy.uint8), plain], axis=1)
    # Each row as differences from the one above: smooth pictures become smaller.
    rows[1:, 1:] -= plain[:-1]
    rows[1:, 0] = 2
    _write(path, rgb.shape, 2, rows)


def signed_map(test, reference, exposure):
    """Differences of luminance at the exposure: red where `test` is brighter, blue where it is darker; full at 0.5."""
    d = ((test - reference) @ LUMINANCE) * 2.0**exposure / 0.5
    d = numpy.clip(d, -1, 1)[..., None]
    red, blue = numpy.array([1.0, 0.25, 0.1]), numpy.array([0.15, 0.45, 1.0])
    return numpy.rint(255 * (numpy.sqrt(numpy.maximum(d, 0)) * red + numpy.sqrt(numpy.maximum(-d, 0)) * blue)
                      ).astype(numpy.uint8)


def bias(test, reference, error, where):
    """Relative difference of the means of luminance over some pixels, and its standard error; None: no pixels."""
    if not where.any():
        return None, None
    truth = (reference @ LUMINANCE)[where]
    mean = truth.mean()
    uncertain = numpy.sqrt((error[where]**2).sum()) / truth.size / mean
    return float((test @ LUMINANCE)[where].mean() / mean - 1), float(uncertain)


def noisy(reference, error, seed=1):
    """The reference with as much more noise as it has."""
    luminance = reference @ LUMINANCE
    offset = numpy.random.default_rng(seed).standard_normal(error.shape) * error
    return reference * numpy.maximum(1 + offset / numpy.maximum(luminance, 1e-9), 0)[..., None]


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
