"""Colours from texts, tables and points, for readers of collections of palettes: plots, interfaces, editors and art.

A reader takes the folder of a package and yields (name, kind, colours). Kinds: "g", a gradient, whose colours are
equally spaced; "q", colours without an order that interpolation would fill; "p", colours of which neither is known. A
colour is three numbers in [0, 255]."""
import ast
import math
import re

HEX = re.compile(r"#([0-9a-fA-F]{6})\b")
CONTROL_SAMPLES = 129  # of gradients that have points at any positions


def from_hex(text):
    digits = text.lstrip("#")
    if len(digits) == 3:
        digits = "".join(d + d for d in digits)
    return tuple(int(digits[i:i + 2], 16) for i in (0, 2, 4))


def hexes(text):
    return [from_hex(found) for found in HEX.findall(text)]


def constants(path):
    """The literals that a Python file assigns to names, without running it."""
    found = {}
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
            try:
                found[node.targets[0].id] = ast.literal_eval(node.value)
            except (ValueError, TypeError):
                pass
    return found


def is_table(value):
    return (isinstance(value, (list, tuple)) and len(value) > 1 and
            all(isinstance(c, (list, tuple)) and len(c) in (3, 4) and
                all(isinstance(x, (int, float)) for x in c[:3]) for c in value))


def to_bytes(table):
    """Colours of [0, 1] or [0, 255] as the latter."""
    is_unit = all(0 <= x <= 1 for color in table for x in color[:3])
    return [tuple(x * (255 if is_unit else 1) for x in color[:3]) for color in table]


def sampled(points, count=CONTROL_SAMPLES):
    """Colours at equal distances on the lines between points (position, colour), ascending."""
    low, high = points[0][0], points[-1][0]
    result, at = [], 0
    for i in range(count):
        x = low + (high - low) * i / (count - 1)
        while at + 2 < len(points) and points[at + 1][0] <= x:
            at += 1
        (x0, c0), (x1, c1) = points[at], points[at + 1]
        t = 0 if x1 <= x0 else min(max((x - x0) / (x1 - x0), 0), 1)
        result.append(tuple(a + (b - a) * t for a, b in zip(c0, c1)))
    return result


def srgb_of_oklch(lightness, chroma, hue):
    """Bjoern Ottosson 2020, clipped to sRGB."""
    a, b = chroma * math.cos(math.radians(hue)), chroma * math.sin(math.radians(hue))
    l = (lightness + 0.3963377774 * a + 0.2158037573 * b)**3
    m = (lightness - 0.1055613458 * a - 0.0638541728 * b)**3
    s = (lightness - 0.0894841775 * a - 1.2914855480 * b)**3
    linear = (4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
              -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
              -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)
    clipped = [min(max(x, 0), 1) for x in linear]
    return tuple(255 * (12.92 * x if x <= 0.0031308 else 1.055 * x**(1 / 2.4) - 0.055) for x in clipped)


def named_tables(path, kind, pattern=r"[A-Za-z]\w*"):
    for name, value in constants(path).items():
        if re.fullmatch(pattern, name) and is_table(value):
            yield re.sub(r"_\d+$", "", name.strip("_")), kind, to_bytes(value)


def ramps(found, prefix=""):
    """Colours (family, grade, hex) as a palette for each family, in the order of the grades."""
    families = {}
    for family, grade, color in found:
        families.setdefault(family, {}).setdefault(int(grade), from_hex(color))
    for family, grades in families.items():
        if len(grades) > 2:
            yield prefix + family, "g", [grades[grade] for grade in sorted(grades)]
