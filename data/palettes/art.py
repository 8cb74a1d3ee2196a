"""Readers (colors.py) of colours of art, films and surveys."""
import json
import re

from colors import from_hex, hexes


def wes_anderson(folder):
    text = (folder / "palettable/wesanderson/wesanderson.py").read_text()
    for name, body in re.findall(r"'(\w+)': \{\s*'colors': \[([^\]]*)\]", text):
        yield name, "q", [tuple(map(int, c)) for c in re.findall(r"\((\d+), (\d+), (\d+)\)", body)]


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


def name_list(file):
    def read(folder):
        colors = [from_hex(c["hex"]) for c in json.loads((folder / f"lib/colors/{file}.json").read_text())]
        yield file, "q", colors
    return read
