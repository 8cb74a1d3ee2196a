"""Palettes on curves in HCL, polar CIELUV: Zeileis, Hornik, Murrell 2009, "Escaping RGBland"; computed here from their
parameters, of which the package colorspace has a table."""
import math

import rdata

WHITE = (95.047, 100.0, 108.883)  # D65
SAMPLES = 33


def srgb_of_hcl(hue, chroma, lightness):
    """CIE 15:2004 and IEC 61966-2-1; clipped to sRGB."""
    if lightness <= 0:
        return 0.0, 0.0, 0.0
    y = WHITE[1] * (((lightness + 16) / 116)**3 if lightness > 8 else lightness / 903.3)
    total = WHITE[0] + 15 * WHITE[1] + 3 * WHITE[2]
    u = chroma * math.cos(math.radians(hue)) / (13 * lightness) + 4 * WHITE[0] / total
    v = chroma * math.sin(math.radians(hue)) / (13 * lightness) + 9 * WHITE[1] / total
    x = 9 * y * u / (4 * v)
    z = 3 * y / v - 5 * y - x / 3
    x, y, z = x / 100, y / 100, z / 100
    linear = (3.240479 * x - 1.537150 * y - 0.498535 * z, -0.969256 * x + 1.875992 * y + 0.041556 * z,
              0.055648 * x - 0.204043 * y + 1.057311 * z)
    clipped = [min(max(c, 0), 1) for c in linear]
    return tuple(255 * (12.92 * c if c <= 0.0031308 else 1.055 * c**(1 / 2.4) - 0.055) for c in clipped)


def known(value, otherwise):
    return otherwise if math.isnan(value) else value


def chroma_at(i, first, last, highest):
    """Linear from `last` at 0 to `first` at 1, or over `highest` between them."""
    if math.isnan(highest) or highest in (first, last):
        return last - (last - first) * i
    peak = 1 / (1 + abs(highest - first) / abs(highest - last))
    if i <= peak:
        return last - (last - highest) * i / peak
    return highest - (highest - first) * (i - peak) / (1 - peak)


def sequential(h1, h2, c1, c2, l1, l2, p1, p2, highest, _):
    h2, c2, p2 = known(h2, h1), known(c2, 0), known(p2, p1)
    for step in range(SAMPLES):
        i = 1 - step / (SAMPLES - 1)
        yield srgb_of_hcl(h2 - (h2 - h1) * i, chroma_at(i**p1, c1, c2, highest), l2 - (l2 - l1) * i**p2)


def diverging(h1, h2, c1, _c2, l1, l2, p1, p2, highest, _):
    p2 = known(p2, p1)
    for step in range(SAMPLES):
        i = 1 - 2 * step / (SAMPLES - 1)
        yield srgb_of_hcl(h1 if i > 0 else h2, chroma_at(abs(i)**p1, c1, 0, highest), l2 - (l2 - l1) * abs(i)**p2)


def qualitative(h1, h2, c1, _c2, l1, *_):
    count = 8
    h2 = known(h2, h1 + 360 * (count - 1) / count)
    for step in range(count):
        yield srgb_of_hcl(h1 + (h2 - h1) * step / (count - 1), c1, l1)


def read(folder):
    tables = {"qual.pals": ("q", qualitative), "seqs.pals": ("g", sequential), "seqm.pals": ("g", sequential),
              "dive.pals": ("g", diverging)}
    found = rdata.objects(folder / "colorspace/R/colorspace", tables)
    for table, (kind, curve) in tables.items():
        for name, parameters in found[table].items():
            yield name, kind, list(curve(*parameters))
