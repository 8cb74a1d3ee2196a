"""Of bench/peers/regions.py and bench/common/images.py, which script/compare-cycles decides by."""
import math
import pathlib
import struct
import sys
import tempfile
import unittest
import zlib

import numpy

BENCH = pathlib.Path(__file__).resolve().parent.parent.parent / "bench"
sys.path[:0] = [str(BENCH / "peers"), str(BENCH / "common")]
import images  # noqa: E402
import regions  # noqa: E402


def estimate(value, error, dark_part=None):
    """Of a picture of 32x24 pixels, a part of which may be darker."""
    picture = numpy.full((24, 32), float(value))
    if dark_part:
        picture[:8, :8] = dark_part
    found = regions.of_errors(picture, numpy.zeros(picture.shape))
    found.whole_error, found.errors = error, [error] * len(found.means)
    return found


def judged(brume, cycles):
    rows = regions.compare(brume, cycles)
    return regions.summary(rows, brume, cycles)


class RegionsTest(unittest.TestCase):
    def test_parts_cover_each_pixel_once(self):
        for width, height in ((4, 3), (17, 13), (33, 16)):
            numbers = numpy.arange(width * height, dtype=numpy.float64).reshape(height, width)
            parts = regions._parts(numbers)
            self.assertEqual(len(parts), 12)
            self.assertEqual(sorted(numpy.concatenate([part.ravel() for part in parts])), list(range(width * height)))

    def test_errors_of_pixels_are_independent(self):
        found = regions.of_errors(numpy.full((24, 32), 2.0), numpy.full((24, 32), 0.5))
        self.assertAlmostEqual(found.whole, 2)
        self.assertAlmostEqual(found.whole_error, 0.5 / math.sqrt(24 * 32))
        for mean, error in zip(found.means, found.errors):
            self.assertAlmostEqual(mean, 2)
            self.assertAlmostEqual(error, 0.5 / 8)

    def test_errors_of_seeds_are_their_spread(self):
        # What all pixels of a picture have in common does not average out.
        found = regions.of_seeds([numpy.full((24, 32), value) for value in (1.0, 2.0, 6.0)])
        self.assertAlmostEqual(found.whole, 3)
        self.assertAlmostEqual(found.whole_error, math.sqrt((4 + 1 + 9) / (3 * 2)))
        self.assertEqual((found.means[5], found.errors[5]), (found.whole, found.whole_error))

    def test_one_percent_and_three_errors_are_allowed(self):
        # Both errors count: 5e-3 of 3e-3 and 4e-3.
        for difference, agrees in ((0.0249, True), (0.0251, False), (-0.0249, True), (-0.0251, False)):
            found = judged(estimate(1 + difference, 3e-3), estimate(1, 4e-3))
            self.assertEqual((found["agrees"], found["off"]), (agrees, 0 if agrees else 12), difference)
            self.assertAlmostEqual(found["whole"], difference)
            self.assertAlmostEqual(found["largest_error"], 5e-3)

    def test_a_part_that_is_off_fails(self):
        found = judged(estimate(1, 1e-3, dark_part=0.9), estimate(1, 1e-3))
        self.assertEqual((found["off"], found["at"], found["agrees"]), (1, [0, 0], False))
        self.assertAlmostEqual(found["largest"], -0.1)

    def test_the_whole_picture_fails_where_parts_are_too_noisy(self):
        brume, cycles = estimate(1.05, 0.1), estimate(1, 0.1)
        self.assertTrue(judged(brume, cycles)["agrees"])
        brume.whole_error = cycles.whole_error = 1e-3
        found = judged(brume, cycles)
        self.assertEqual((found["off"], found["agrees"]), (0, False))

    def test_dark_parts_are_not_judged(self):
        found = judged(estimate(1, 1e-4, dark_part=0.01), estimate(1, 1e-4, dark_part=0.015))
        self.assertEqual((found["parts"], found["off"], found["agrees"]), (11, 0, True))


def exr(compression, blocks, window, channels):
    """An OpenEXR file of blocks, each the number of its first row and its bytes."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iiii", kind, 0, 1, 1) for name, kind in channels) + b"\0"
    head = (struct.pack("<II", 20000630, 2) + attribute("channels", "chlist", listed) +
            attribute("compression", "compression", bytes([compression])) +
            attribute("dataWindow", "box2i", struct.pack("<4i", *window)) + b"\0")
    at, offsets, body = len(head) + 8 * len(blocks), b"", b""
    for y, data in blocks:
        offsets += struct.pack("<Q", at + len(body))
        body += struct.pack("<ii", y, len(data)) + data
    return head + offsets + body


def zipped(plain):
    mixed = plain[0::2] + plain[1::2]
    return zlib.compress(bytes([mixed[0]] + [(b - a + 128) & 255 for a, b in zip(mixed, mixed[1:])]))


class ImagesTest(unittest.TestCase):
    def read(self, data):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "picture.exr"
            path.write_bytes(data)
            return images.read_exr(path)

    def test_reads_each_kind_of_block(self):
        # 41 x 18 pixels that begin at (3, -2); halves and floats.
        random = numpy.random.default_rng(1)
        halves = (random.integers(0, 3, (18, 41)) / 3).astype("<f2")
        floats = (random.integers(0, 3, (18, 41)) / 3).astype("<f4")
        rows = [halves[y].tobytes() + floats[y].tobytes() for y in range(18)]
        for compression, most in ((0, 1), (2, 1), (3, 16)):
            blocks = [(y - 2, b"".join(rows[y:y + most])) for y in range(0, 18, most)]
            if compression:
                # What deflate does not make smaller is stored as it is.
                blocks = [(y, data if y == 14 else zipped(data)) for y, data in blocks]
            found = self.read(exr(compression, blocks, (3, -2, 43, 15), (("A", 1), ("Z", 2))))
            self.assertEqual(list(found), ["A", "Z"])
            self.assertTrue((found["A"] == halves).all() and (found["Z"] == floats).all(), compression)

    def test_refuses_others(self):
        plain = [(0, bytes(4))]
        for compression, kind in ((1, 2), (0, 0)):
            with self.assertRaises(ValueError):
                self.read(exr(compression, plain, (0, 0, 0, 0), (("R", kind),)))
        with self.assertRaises(ValueError):
            self.read(b"PNG " + bytes(64))


unittest.main()
