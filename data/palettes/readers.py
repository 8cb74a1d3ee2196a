"""Readers of the collections of palettes: each takes the folder of a package and yields (name, kind, colours).

Kinds: "g", a gradient, whose colours are equally spaced; "q", colours without an order that interpolation would fill;
"p", colours of which neither is known. A colour is three numbers in [0, 255]."""
import ast
import json
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


def matplotlib(folder):
    tables = constants(folder / "matplotlib/_cm.py")
    for name, value in tables.items():
        plain = re.sub(r"^_|_data$", "", name)
        if is_table(value):
            yield plain, "q" if re.search(r"tab\d|Set|Pastel|Paired|Dark2|Accent", name) else "g", to_bytes(value)
        elif isinstance(value, dict) and set(value) >= {"red", "green", "blue"}:
            channels = []
            for key in ("red", "green", "blue"):
                if not isinstance(value[key], (list, tuple)):
                    break
                points = [p for x, y0, y1 in value[key] for p in ((x, (y0,)), (x, (y1,)))]
                channels.append([255 * c[0] for c in sampled(points, 257)])
            if len(channels) == 3:
                yield plain, "g", list(zip(*channels))
    for name, value in constants(folder / "matplotlib/_cm_listed.py").items():
        if is_table(value):
            yield re.sub(r"^_|_data$", "", name), "g", to_bytes(value)


def palettable_part(path, kind):
    def read(folder):
        yield from named_tables(folder / "palettable" / path, kind, r"_?[A-Z][A-Z0-9_]*")
    return read


def wes_anderson(folder):
    text = (folder / "palettable/wesanderson/wesanderson.py").read_text()
    for name, body in re.findall(r"'(\w+)': \{\s*'colors': \[([^\]]*)\]", text):
        yield name, "q", [tuple(map(int, c)) for c in re.findall(r"\((\d+), (\d+), (\d+)\)", body)]


def tableau(folder):
    found = constants(folder / "palettable/tableau/tableau.py")
    tables = next(v for v in found.values() if isinstance(v, list) and is_table(v[0]))
    for name, colors in zip(found["palette_names"], tables):
        yield name, "q", colors


def color_brewer(folder):
    schemes = json.loads((folder / "palettable/colorbrewer/data/colorbrewer_all_schemes.json").read_text())
    for kind, families in schemes.items():
        for name, sizes in families.items():
            largest = max(sizes, key=int)
            colors = sizes[largest]["Colors"] if "Colors" in sizes[largest] else sizes[largest]["colors"]
            yield name, "q" if kind.lower() == "qualitative" else "g", colors


def colorcet(folder):
    for name, value in constants(folder / "colorcet/__init__.py").items():
        if is_table(value) and not name.startswith(("m_", "b_")):
            yield name, "q" if "glasbey" in name else "g", to_bytes(value)


def seaborn(folder):
    for name, value in constants(folder / "seaborn/cm.py").items():
        if is_table(value):
            yield re.sub(r"^_|_lut$", "", name), "g", to_bytes(value)
    for name, body in re.findall(r"^ +(\w+)=\[([^\]]*)\]", (folder / "seaborn/palettes.py").read_text(), re.M):
        if len(hexes(body)) > 5:
            yield name, "q", hexes(body)


def plotly(folder):
    for part, kind in (("sequential", "g"), ("diverging", "g"), ("cyclical", "g"), ("qualitative", "q"),
                       ("plotlyjs", "g")):
        for name, value in constants(folder / f"_plotly_utils/colors/{part}.py").items():
            if isinstance(value, list) and len(value) > 1 and all(isinstance(c, str) for c in value):
                colors = [from_hex(c) if c.startswith("#") else tuple(map(float, re.findall(r"[\d.]+", c)[:3]))
                          for c in value]
                yield name, kind, colors


def ncl(folder):
    """Not those that NCL took from GMT, ncview, MATLAB and cpt-city, whose licences are others."""
    for path in sorted(folder.rglob("*.rgb")):
        if path.name.startswith(("GMT_", "NCV_", "SVG_", "ncview", "testcmap", "example", "MPL_", "cmocean_", "matlab_")):
            continue
        rows = []
        for line in path.read_text(errors="replace").splitlines():
            numbers = re.findall(r"^\s*([\d.]+)[\s,]+([\d.]+)[\s,]+([\d.]+)", line)
            if numbers:
                rows.append(tuple(map(float, numbers[0])))
        if len(rows) > 1:
            yield path.stem, "g" if len(rows) > 40 else "p", to_bytes(rows)


CSS = {"black": (0, 0, 0), "white": (255, 255, 255), "red": (255, 0, 0)}


def magics(folder):
    """Of each family, NAME_5, NAME_6, ..., the one of most colours."""
    families = {}
    for name, entry in json.loads((folder / "palettes.json").read_text()).items():
        colors = []
        for text in entry["contour_shade_colour_list"]:
            text = text.strip().lower()
            numbers = re.fullmatch(r"rgb\(([^)]*)\)", text)
            if text in ("none", "transparent"):
                continue
            if text.startswith("#"):
                colors.append(from_hex(text))
            elif numbers:
                colors.append(tuple(255 * float(x) for x in numbers[1].split(",")))
            elif text in CSS:
                colors.append(CSS[text])
            else:
                break
        else:
            family = re.sub(r"^m_|^matplotlib_|_\d+$", "", name)
            if len(colors) > max(1, len(families.get(family, []))):
                families[family] = colors
    for family, colors in families.items():
        yield family, "g", colors


def mricron(folder):
    for path in sorted((folder / "lut").glob("*.lut")):
        data = path.read_bytes()
        if len(data) == 768:
            yield path.stem, "g", list(zip(data[:256], data[256:512], data[512:]))


def ginga(folder):
    """Not those that it took from IDL."""
    for name, value in constants(folder / "ginga/cmap.py").items():
        if name.startswith("cmap_") and "idl" not in name and is_table(value):
            yield name[5:], "g", to_bytes(value)


def vtk(folder):
    text = (folder / "Rendering/Core/ColorTransferFunction/ColorMaps.json.js").read_text()
    literal = re.search(r'JSON\.parse\(("(?:[^"\\]|\\.)*")\)', text)[1]
    for entry in json.loads(json.loads(literal)):
        if "RGBPoints" in entry:
            numbers = entry["RGBPoints"]
            points = [(numbers[i], tuple(255 * x for x in numbers[i + 1:i + 4])) for i in range(0, len(numbers), 4)]
            if len(points) > 1:
                yield entry["Name"], "g", sampled(points)
        elif "IndexedColors" in entry:
            numbers = entry["IndexedColors"]
            yield entry["Name"], "q", [tuple(255 * x for x in numbers[i:i + 3]) for i in range(0, len(numbers), 3)]


def kepler(folder):
    text = (folder / "dist/color-palettes.js").read_text()
    for name, kind, colors, more in re.findall(
            r"name: '([^']+)',[^{}]*?type: PALETTE_TYPES\.(\w+),[^{}]*?colors: \[([^\]]*)\](?:,\s*colors2: \[([^\]]*)\])?",
            text):
        yield name, "q" if kind == "QUA" else "g", hexes(colors + more)


def echarts(folder):
    for path in sorted((folder / "theme").glob("*.js")):
        found = re.search(r"(?:colorPalette = |color: )\[([^\]]*)\]", path.read_text())
        if found and len(hexes(found[1])) > 2:
            yield path.stem, "q", hexes(found[1])


def base16(folder):
    for path in sorted((folder / "styles/base16").glob("*.css")):
        text = path.read_text()
        colors = re.findall(r"^base0[0-9A-F]\s+#([0-9a-fA-F]{6})", text, re.M)
        if not path.name.endswith(".min.css") and "License: ~ MIT" in text and len(colors) == 16:
            yield path.stem, "q", [from_hex(c) for c in colors]


def niivue(folder):
    for path in sorted((folder / "src/cmaps").glob("*.json")):
        entry = json.loads(path.read_text())
        colors = list(zip(entry["R"], entry["G"], entry["B"]))
        if "labels" in entry or "I" not in entry or len(colors) > 128 or len(colors) < 2:
            continue
        if entry["I"] == sorted(set(entry["I"])):
            yield path.stem.strip("_"), "g", sampled(list(zip(entry["I"], colors)))


def ramps(found, prefix=""):
    """Colours (family, grade, hex) as a palette for each family, in the order of the grades."""
    families = {}
    for family, grade, color in found:
        families.setdefault(family, {}).setdefault(int(grade), from_hex(color))
    for family, grades in families.items():
        if len(grades) > 2:
            yield prefix + family, "g", [grades[grade] for grade in sorted(grades)]


def radix(folder):
    for path in sorted(folder.glob("*.css")):
        if "alpha" not in path.stem:
            found = re.findall(r"--([a-z]+)-(\d+): (#[0-9a-fA-F]{3,6});", path.read_text())
            for _, kind, colors in ramps(found):
                yield path.stem, kind, colors


def carbon(folder):
    return ramps(re.findall(r'const ([a-zA-Z]+?)(\d+) = "(#[0-9a-fA-F]{6})"', (folder / "lib/index.js").read_text()))


def ant_design(folder):
    for name, colors in re.findall(r"const (\w+) = exports\.\w+ = \[([^\]]*)\]", (folder / "lib/presets.js").read_text()):
        yield name, "g", hexes(colors)


def material(folder):
    for name, grades in json.loads((folder / "dist/colors.json").read_text()).items():
        if isinstance(grades, dict) and "500" in grades:
            yield name, "g", [from_hex(c) for grade, c in grades.items() if grade.isdigit()]
            accents = [from_hex(c) for grade, c in grades.items() if re.fullmatch(r"a\d+", grade)]
            if len(accents) > 2:
                yield name + "-accent", "g", accents


def tailwind(folder):
    text = (folder / "lib/public/colors.js").read_text()
    for name, body in re.findall(r"(\w+): \{([^{}]*)\}", text):
        if len(hexes(body)) > 4:
            yield name, "g", hexes(body)


def open_props(folder):
    for path in sorted((folder / "src").glob("props.*.css")):
        text = path.read_text()
        yield from ramps(re.findall(r"--([a-z]+)-(\d+): *(#[0-9a-fA-F]{3,6});", text))
        for number, body in re.findall(r"--(gradient-\d+): *linear-gradient\(([^;]*)\);", text):
            if len(hexes(body)) > 1:
                yield number, "g", hexes(body)


def uswds(folder):
    tokens = folder / "packages/uswds-core/src/styles/tokens/color"
    for path in sorted(tokens.glob("_*.scss")):
        plain, _, vivid = path.read_text().partition('"vivid"')
        for name, body in ((path.stem[1:], plain), (path.stem[1:] + "-vivid", vivid)):
            if len(hexes(body)) > 3:
                yield name, "g", hexes(body)


def spectrum(folder):
    found = {}
    for name, entry in json.loads((folder / "src/color-palette.json").read_text()).items():
        family = re.fullmatch(r"([a-z-]+)-(\d+)", name)
        if not family or "transparent" in name:
            continue
        for theme, value in entry.get("sets", {"light": entry}).items():
            numbers = re.fullmatch(r"rgb\((\d+), (\d+), (\d+)\)", value.get("value", ""))
            if numbers:
                found.setdefault((family[1], theme), {})[int(family[2])] = tuple(map(int, numbers.groups()))
    for (family, theme), grades in found.items():
        if len(grades) > 2:
            yield f"{family}-{theme}", "g", [grades[grade] for grade in sorted(grades)]


def primer(folder):
    for path in sorted((folder / "dist/figma/scales").glob("*.json")):
        found = {}
        for entry in json.loads(path.read_text()):
            family = re.fullmatch(r"(?:base|display)/color/(?:scale/)?([a-z]+)/(?:scale/)?(\d+)", entry["name"])
            if family and isinstance(entry["value"], dict) and entry["value"].get("a", 1) == 1:
                color = tuple(255 * entry["value"][c] for c in "rgb")
                group = "display-" if entry["name"].startswith("display") else ""
                found.setdefault(group + family[1], {})[int(family[2])] = color
        for family, grades in found.items():
            if len(grades) > 2:
                yield f"{family}-{path.stem}", "g", [grades[grade] for grade in sorted(grades)]


def daisy(folder):
    text = (folder / "src/theming/themes.js").read_text()
    for name, body in re.findall(r"^  \"?([\w-]+)\"?: \{(.*?)^  \}", text, re.M | re.S):
        colors = []
        for value in re.findall(r': "(#[0-9a-fA-F]{3,6}|oklch\([^)]*\))"', body):
            if value.startswith("#"):
                colors.append(from_hex(value))
            else:
                l, c, h = re.findall(r"[\d.]+", value)[:3]
                colors.append(srgb_of_oklch(float(l) / (100 if "%" in value else 1), float(c), float(h)))
        if len(colors) > 3:
            yield name, "q", list(dict.fromkeys(colors))


def editor_themes(folder):
    """The colours of terminals of those that their notice puts under a permissive licence."""
    allowed, files = set(), []
    for line in (folder / "NOTICE").read_text().splitlines():
        if line.startswith("Files:"):
            files = re.findall(r"([\w-]+)\.json", line)
        elif line.startswith("SPDX:") and line.split()[1] in ("MIT", "Apache-2.0"):
            allowed.update(files)
    for path in sorted((folder / "themes").glob("*.json")):
        if path.stem not in allowed:
            continue
        colors = json.loads(path.read_text()).get("colors", {})
        keys = [f"terminal.ansi{bright}{color}" for bright in ("", "Bright")
                for color in ("Black", "Red", "Green", "Yellow", "Blue", "Magenta", "Cyan", "White")]
        found = [from_hex(colors[key][:7]) for key in keys if HEX.match(colors.get(key, "")[:7])]
        if len(set(found)) > 5:
            yield path.stem, "q", list(dict.fromkeys(found))


def chromotome(folder):
    text = (folder / "dist/index.esm.js").read_text()
    for name, body in re.findall(r"name: '([^']+)',(.*?)(?=name: '|\Z)", text, re.S):
        colors = re.search(r"colors: \[([^\]]*)\]", body)
        if colors and len(hexes(colors[1])) > 1:
            yield name, "q", hexes(colors[1])


def wada(folder):
    combinations = {}
    for color in json.loads((folder / "colors.json").read_text()):
        for number in color["combinations"]:
            combinations.setdefault(number, []).append(from_hex(color["hex"]))
    for number in sorted(combinations):
        yield f"wada-{number:03}", "q", combinations[number]


def ui_gradients(folder):
    for name, ends in json.loads((folder / "src/gradient_list.json").read_text()).items():
        yield name, "g", [from_hex(ends["start"]), from_hex(ends["end"])]


def color_map_js(folder):
    text = (folder / "colorScale.js").read_text()
    for name, body in re.findall(r'"([\w-]+)":\s*\[((?:\{.*?\},?\s*)+)\]', text):
        points = [(float(at), tuple(map(float, rgb.split(","))))
                  for at, rgb in re.findall(r'"index":\s*([\d.]+),\s*"rgb":\s*\[([\d., ]+)\]', body)]
        if len(points) > 1:
            yield name, "g", sampled([(at, rgb[:3]) for at, rgb in points])


def name_list(file):
    def read(folder):
        colors = [from_hex(c["hex"]) for c in json.loads((folder / f"lib/colors/{file}.json").read_text())]
        yield file, "q", colors
    return read


def bokeh(folder):
    largest = {}
    for name, body in re.findall(r"export const (\w+) = \[([^\]]*)\]", (folder / "build/js/lib/api/palettes.js").read_text()):
        colors = [from_hex(f"{int(c, 16) >> 8:06x}") for c in re.findall(r"0x[0-9a-fA-F]{8}", body)]
        family = re.sub(r"_?\d+$", "", name)
        if len(colors) > len(largest.get(family, [])):
            largest[family] = colors
    for family, colors in largest.items():
        if len(colors) > 1:
            yield family, "q" if re.search(r"Category|Set|Colorblind|Bright|Contrast|Vibrant|Muted|Light|Accent", family) \
                else "g", colors


def highlight_styles(folder):
    for path in sorted((folder / "styles").glob("*.css")):
        text = path.read_text()
        licence = re.search(r"^\s*\*?\s*Licen[sc]e: *(.*)$", text, re.M | re.I)
        if path.name.endswith(".min.css") or (licence and not re.search("MIT|BSD|CC0|Apache|public domain", licence[1])):
            continue
        colors = list(dict.fromkeys(from_hex(c) for c in re.findall(r"(?:color|background): *(#[0-9a-fA-F]{3,6})\b", text)))
        if len(colors) > 4:
            yield path.stem, "q", colors


def code_mirror(folder):
    for path in sorted((folder / "theme").glob("*.css")):
        text = path.read_text()
        found = re.findall(r"(?:color|background): *(#[0-9a-fA-F]{6}|#[0-9a-fA-F]{3})\b", text)
        colors = list(dict.fromkeys(from_hex(c) for c in found))
        if len(colors) > 4:
            yield path.stem, "q", colors


def bootswatch(folder):
    """The colours of each theme without its greys."""
    for path in sorted((folder / "dist").glob("*/_variables.scss")):
        found = re.findall(r"^\$(?:blue|indigo|purple|pink|red|orange|yellow|green|teal|cyan): +(#[0-9a-fA-F]{3,6}) ",
                           path.read_text(), re.M)
        colors = list(dict.fromkeys(from_hex(c) for c in found))
        if len(colors) > 4:
            yield path.parent.name, "q", colors


def pygments(folder):
    for path in sorted((folder / "pygments/styles").glob("*.py")):
        colors = list(dict.fromkeys(hexes(path.read_text())))
        if len(colors) > 4:
            yield path.stem, "q", colors


def airline(folder):
    """Not those that it makes of base16."""
    for path in sorted(folder.rglob("autoload/airline/themes/*.vim")):
        colors = list(dict.fromkeys(hexes(re.sub(r'^\s*".*$', "", path.read_text(errors="replace"), flags=re.M))))
        if not path.name.startswith("base16") and len(colors) > 4:
            yield path.stem, "q", colors


def skeleton(folder):
    for path in sorted((folder / "src/themes").glob("*.css")):
        found = {}
        for family, grade, l, percent, c, h in re.findall(
                r"--color-(\w+)-(\d+): oklch\(([\d.]+)(%?) ([\d.]+) ([\d.]+)", path.read_text()):
            color = srgb_of_oklch(float(l) / (100 if percent else 1), float(c), float(h))
            found.setdefault(family, {})[int(grade)] = color
        for family, grades in found.items():
            if len(grades) > 5:
                yield f"{path.stem}-{family}", "g", [grades[grade] for grade in sorted(grades)]


def web_awesome(folder):
    for path in sorted((folder / "dist/styles/color/palettes").glob("*.css")):
        found = re.findall(r"--wa-color-([a-z]+)-(\d+): (#[0-9a-fA-F]{3,6})\b", path.read_text())
        for family, kind, colors in ramps(found):
            yield f"{family}-{path.stem}", kind, colors


def fluent(folder):
    text = (folder / "lib/global/colors.js").read_text() + (folder / "lib/global/brandColors.js").read_text()
    for name, body in re.findall(r"export const (\w+) = \{([^}]*)\}", text):
        if len(hexes(body)) > 5:
            yield name, "g", hexes(body)


def pico(folder):
    return ramps(re.findall(r"^\$([a-z]+)-(\d+): (#[0-9a-fA-F]{3,6});", (folder / "scss/colors/_index.scss").read_text(),
                            re.M))
