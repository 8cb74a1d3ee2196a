"""Readers (colors.py) of themes of editors and terminals, and of styles of program texts."""
import json
import re

from colors import HEX, from_hex, hexes


def base16(folder):
    for path in sorted((folder / "styles/base16").glob("*.css")):
        text = path.read_text()
        colors = re.findall(r"^base0[0-9A-F]\s+#([0-9a-fA-F]{6})", text, re.M)
        if not path.name.endswith(".min.css") and "License: ~ MIT" in text and len(colors) == 16:
            yield path.stem, "q", [from_hex(c) for c in colors]


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


def highlight_styles(folder):
    for path in sorted((folder / "styles").glob("*.css")):
        text = path.read_text()
        licence = re.search(r"^\s*\*?\s*Licen[sc]e: *(.*)$", text, re.M | re.I)
        is_other = licence and not re.search("MIT|BSD|CC0|Apache|public domain", licence[1])
        if path.name.endswith(".min.css") or is_other:
            continue
        found = re.findall(r"(?:color|background): *(#[0-9a-fA-F]{3,6})\b", text)
        colors = list(dict.fromkeys(from_hex(c) for c in found))
        if len(colors) > 4:
            yield path.stem, "q", colors


def code_mirror(folder):
    for path in sorted((folder / "theme").glob("*.css")):
        text = path.read_text()
        found = re.findall(r"(?:color|background): *(#[0-9a-fA-F]{6}|#[0-9a-fA-F]{3})\b", text)
        colors = list(dict.fromkeys(from_hex(c) for c in found))
        if len(colors) > 4:
            yield path.stem, "q", colors


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
