"""Images of numbers: reads OpenEXR and PFM files, compares them, and writes PNG files. Standard library only."""
import itertools
import math
import struct
import zlib


class Picture:
    """Grey values, rows from the top."""

    def __init__(self, width, height, values):
        self.width, self.height, self.values = width, height, values


def read_pfm(path):
    """A PFM file of one channel."""
    with open(path, "rb") as file:
        kind, size, scale = (file.readline().strip() for _ in range(3))
        width, height = map(int, size.split())
        if kind != b"Pf" or float(scale) >= 0:
            raise ValueError(f"{path}: expected a little-endian PFM file of one channel")
        values = struct.unpack(f"<{width * height}f", file.read())
    rows = [values[y * width:(y + 1) * width] for y in range(height)]
    return Picture(width, height, [v for row in reversed(rows) for v in row])


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _attributes(data):
    """The attributes of the header of a file of one part, and where it ends."""
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
        found.append((name, "e" if kind == 1 else "f", 2 if kind == 1 else 4))
        at += 16
    return found


def _unzip(block, length):
    """Undoes OpenEXR's ZIP compression: deflate, differences of bytes, and even and odd bytes apart."""
    if len(block) == length:
        return block
    coded = zlib.decompress(block)
    plain = bytes(value & 255 for value in itertools.accumulate(coded, lambda a, b: a + b - 128))
    half = (length + 1) // 2
    mixed = bytearray(length)
    mixed[0::2], mixed[1::2] = plain[:half], plain[half:]
    return bytes(mixed)


def read_exr(path, channels=("R", "G", "B")):
    """The mean of channels of an OpenEXR file of scan lines, plain or ZIP compressed (the format's specification,
    "OpenEXR File Layout")."""
    with open(path, "rb") as file:
        data = file.read()
    magic, version = struct.unpack_from("<II", data, 0)
    if magic != 20000630 or version & ~0x400 != 2:
        raise ValueError(f"{path}: expected an OpenEXR file of scan lines")
    header, at = _attributes(data)
    lines = {0: 1, 2: 1, 3: 16}.get(header["compression"][0])
    if lines is None:
        raise ValueError(f"{path}: expected no compression, or ZIP")
    left, top, right, bottom = struct.unpack("<iiii", header["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    stored = _channels(header["channels"])
    row_bytes = width * sum(size for _, _, size in stored)
    blocks = (height + lines - 1) // lines
    values = [0.0] * (width * height)
    for offset in struct.unpack_from(f"<{blocks}Q", data, at):
        first, size = struct.unpack_from("<ii", data, offset)
        count = min(lines, bottom - first + 1)
        plain = _unzip(data[offset + 8:offset + 8 + size], row_bytes * count)
        position = 0
        for y in range(first - top, first - top + count):
            sums = [0.0] * width
            for name, kind, size in stored:
                if name in channels:
                    sums = list(map(sum, zip(sums, struct.unpack_from(f"<{width}{kind}", plain, position))))
                position += width * size
            values[y * width:(y + 1) * width] = [value / len(channels) for value in sums]
    return Picture(width, height, values)


def compare(picture, reference):
    """Differences in percent of the reference's mean over the pixels that the volume covers: `rmse` over all pixels,
    `mean` with its sign, and `largest`; `ratio`: the picture's sum by that of the reference."""
    if (picture.width, picture.height) != (reference.width, reference.height):
        raise ValueError(f"expected {reference.width}x{reference.height} pixels, found {picture.width}x"
                         f"{picture.height}")
    covered = [value for value in reference.values if value > 0]
    if not covered:
        raise ValueError("the reference is black")
    unit = math.fsum(covered) / len(covered) / 100
    apart = [a - b for a, b in zip(picture.values, reference.values)]
    count = len(apart)
    return {"rmse": math.sqrt(math.fsum(d * d for d in apart) / count) / unit,
            "mean": math.fsum(apart) / count / unit,
            "largest": max(map(abs, apart)) / unit,
            "ratio": math.fsum(picture.values) / math.fsum(reference.values)}


def offset(picture, reference):
    """By how much the picture lies beside the reference [pixels right, pixels down]: the least squares fit of its
    difference to the reference's slopes, and to its brightness. Meaningful below a pixel."""
    width, height = reference.width, reference.height
    # Normal equations of difference = a slope_x + b slope_y + c value.
    sums = [[0.0] * 4 for _ in range(3)]
    for y in range(1, height - 1):
        for x in range(1, width - 1):
            i = y * width + x
            v = reference.values
            row = ((v[i + 1] - v[i - 1]) / 2, (v[i + width] - v[i - width]) / 2, v[i],
                   picture.values[i] - v[i])
            if row[0] or row[1]:
                for k in range(3):
                    for n in range(4):
                        sums[k][n] += row[k] * row[n]
    for k in range(3):
        pivot = sums[k][k] or 1.0
        sums[k] = [value / pivot for value in sums[k]]
        for other in range(3):
            if other != k:
                factor = sums[other][k]
                sums[other] = [a - factor * b for a, b in zip(sums[other], sums[k])]
    # A picture moved to the right is darker where the reference rises to the right.
    return -sums[0][3], -sums[1][3]


def write_png(path, width, height, rgb):
    """8 bits per channel."""
    def chunk(name, data):
        body = name + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    rows = b"".join(b"\0" + rgb[3 * width * y:3 * width * (y + 1)] for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) +
                   chunk(b"IEND", b""))


def srgb_pixels(picture, white):
    """What an eye sees: radiance `white` is white."""
    table = [round(255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055))
             for v in (i / 4095 for i in range(4096))]
    grey = (table[round(4095 * min(max(value / white, 0), 1))] for value in picture.values)
    return bytes(itertools.chain.from_iterable((g, g, g) for g in grey))


def difference_pixels(picture, reference, most):
    """White: equal; red: brighter than the reference by `most` or more; blue: darker."""
    def colour(apart):
        faded = round(255 * (1 - min(abs(apart) / most, 1)))
        return (255, faded, faded) if apart > 0 else (faded, faded, 255)

    apart = (a - b for a, b in zip(picture.values, reference.values))
    return bytes(itertools.chain.from_iterable(map(colour, apart)))


def side_by_side(tiles, width):
    """Joins rows of tiles of pixels, all of one size."""
    row = 3 * width
    return b"".join(tile[y:y + row] for line in tiles for y in range(0, len(line[0]), row) for tile in line)
