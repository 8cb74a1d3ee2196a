"""Readers (colors.py) of colour maps of plots, maps and images of measurements."""
import json
import re

from colors import constants, from_hex, hexes, is_table, named_tables, sampled, to_bytes


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
        if path.name.startswith(("GMT_", "NCV_", "SVG_", "ncview", "testcmap", "example", "MPL_", "cmocean_",
                                 "matlab_")):
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
            r"name: '([^']+)',[^{}]*?type: PALETTE_TYPES\.(\w+),[^{}]*?colors: \[([^\]]*)\]"
            r"(?:,\s*colors2: \[([^\]]*)\])?",
            text):
        yield name, "q" if kind == "QUA" else "g", hexes(colors + more)


def echarts(folder):
    for path in sorted((folder / "theme").glob("*.js")):
        found = re.search(r"(?:colorPalette = |color: )\[([^\]]*)\]", path.read_text())
        if found and len(hexes(found[1])) > 2:
            yield path.stem, "q", hexes(found[1])


def niivue(folder):
    for path in sorted((folder / "src/cmaps").glob("*.json")):
        entry = json.loads(path.read_text())
        colors = list(zip(entry["R"], entry["G"], entry["B"]))
        if "labels" in entry or "I" not in entry or len(colors) > 128 or len(colors) < 2:
            continue
        if entry["I"] == sorted(set(entry["I"])):
            yield path.stem.strip("_"), "g", sampled(list(zip(entry["I"], colors)))


def color_map_js(folder):
    text = (folder / "colorScale.js").read_text()
    for name, body in re.findall(r'"([\w-]+)":\s*\[((?:\{.*?\},?\s*)+)\]', text):
        points = [(float(at), tuple(map(float, rgb.split(","))))
                  for at, rgb in re.findall(r'"index":\s*([\d.]+),\s*"rgb":\s*\[([\d., ]+)\]', body)]
        if len(points) > 1:
            yield name, "g", sampled([(at, rgb[:3]) for at, rgb in points])


def bokeh(folder):
    largest = {}
    text = (folder / "build/js/lib/api/palettes.js").read_text()
    for name, body in re.findall(r"export const (\w+) = \[([^\]]*)\]", text):
        colors = [from_hex(f"{int(c, 16) >> 8:06x}") for c in re.findall(r"0x[0-9a-fA-F]{8}", body)]
        family = re.sub(r"_?\d+$", "", name)
        if len(colors) > len(largest.get(family, [])):
            largest[family] = colors
    for family, colors in largest.items():
        if len(colors) > 1:
            named = re.search(r"Category|Set|Colorblind|Bright|Contrast|Vibrant|Muted|Light|Accent", family)
            yield family, "q" if named else "g", colors
