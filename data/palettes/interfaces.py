"""Readers (colors.py) of ramps of design systems, and of themes of user interfaces."""
import json
import re

from colors import from_hex, hexes, ramps, srgb_of_oklch


def radix(folder):
    for path in sorted(folder.glob("*.css")):
        if "alpha" not in path.stem:
            found = re.findall(r"--([a-z]+)-(\d+): (#[0-9a-fA-F]{3,6});", path.read_text())
            for _, kind, colors in ramps(found):
                yield path.stem, kind, colors


def carbon(folder):
    return ramps(re.findall(r'const ([a-zA-Z]+?)(\d+) = "(#[0-9a-fA-F]{6})"', (folder / "lib/index.js").read_text()))


def ant_design(folder):
    text = (folder / "lib/presets.js").read_text()
    for name, colors in re.findall(r"const (\w+) = exports\.\w+ = \[([^\]]*)\]", text):
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


def ui_gradients(folder):
    for name, ends in json.loads((folder / "src/gradient_list.json").read_text()).items():
        yield name, "g", [from_hex(ends["start"]), from_hex(ends["end"])]


def bootswatch(folder):
    """The colours of each theme without its greys."""
    for path in sorted((folder / "dist").glob("*/_variables.scss")):
        found = re.findall(r"^\$(?:blue|indigo|purple|pink|red|orange|yellow|green|teal|cyan): +(#[0-9a-fA-F]{3,6}) ",
                           path.read_text(), re.M)
        colors = list(dict.fromkeys(from_hex(c) for c in found))
        if len(colors) > 4:
            yield path.parent.name, "q", colors


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
    text = (folder / "scss/colors/_index.scss").read_text()
    return ramps(re.findall(r"^\$([a-z]+)-(\d+): (#[0-9a-fA-F]{3,6});", text, re.M))
