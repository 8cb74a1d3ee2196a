"""The scenes of script/fidelity, and timelines that are derived from theirs."""
import os
import pathlib
import re
import tomllib

FOLDER = pathlib.Path(__file__).resolve().parent.parent.parent / "scenes/fidelity"

# Name, title, time of the picture [s].
SCENES = (("one_light", "room, one light", 2.0), ("five_lights", "room, five lights", 2.0),
          ("light_inside", "light inside of smoke", 2.0), ("shot", "shot, a light behind", 2.2),
          ("word", "word", 3.1), ("doorway", "doorway", 2.0), ("wall_edge", "edge of a wall", 2.0),
          ("blast", "blast", 2.5), ("dusk", "sun through boards", 3.0), ("fire", "fire", 0.5),
          ("cloud", "pyroclastic cloud", 0.5), ("yard", "yard by day", 3.2))

# What `brume bake` makes for them.
VOLUMES = {
    "cloud": ("cloud.brv", ["pyroclastic", "--edge", "96", "--voxel", "0.05", "--radius", "1.35", "--seed", "3"]),
    "fire": ("fire.brv", ["pyroclastic", "--edge", "64", "--voxel", "0.03", "--radius", "0.5", "--edge-softness", "0.5",
                          "--amplitude", "0.9", "--seed", "11"]),
}

# Single scattering: what stands in for further bounces is off.
SINGLE = [("smoke", "multiple_scattering", 0.0), ("volume", "multiple_scattering", 0.0), ("sky", "bounce", 0.0)]


def edited(text, table, key, value):
    """A timeline with another value of a key in all tables of that name; "": at its top."""
    line = f"{key} = {value}\n"
    parts = re.split(r"(?m)^(?=\[)", text)
    for i, part in enumerate(parts):
        head = re.match(r"\[+([\w.]+)\]+", part)
        if (head.group(1) if head else "") != table:
            continue
        rest = re.sub(rf"(?m)^{key} = .*\n", "", part)
        parts[i] = (f"{line}{rest}" if head is None else rest.replace("\n", "\n" + line, 1))
    return "".join(parts)


def timeline(name, folder, edits=()):
    """The timeline of a scene for a folder that its volumes are in, with edits."""
    text = (FOLDER / f"{name}.toml").read_text()
    for table, key, value in edits:
        text = edited(text, table, key, value)
    scene = tomllib.loads(text)["scene"]
    return edited(text, "", "scene", f'"{os.path.relpath(FOLDER / scene, folder)}"')


def look(name, edits=()):
    """Exposure and tone curve."""
    text = (FOLDER / f"{name}.toml").read_text()
    for table, key, value in edits:
        text = edited(text, table, key, value)
    settings = tomllib.loads(text)
    return settings.get("exposure", 0.0), settings.get("tone", "neutral")


def painted(name, folder, factor):
    """A copy of a scene of boxes whose colours are multiplied by a factor; its path relative to the folder."""
    place = folder / f"painted_{factor}"
    (place / "Meshes").mkdir(parents=True, exist_ok=True)
    for mesh in (FOLDER / "Meshes").glob("*.obj"):
        lines = [line.split() for line in mesh.read_text().splitlines()]
        for words in lines:
            # Colours of vertices are sRGB: about the power 2.2.
            if words[0] == "v":
                words[4:] = [f"{float(c) * factor**(1 / 2.2):.5f}" for c in words[4:]]
        (place / "Meshes" / mesh.name).write_text("".join(" ".join(words) + "\n" for words in lines))
    (place / f"{name}.txt").write_text((FOLDER / f"{name}.txt").read_text())
    return f"{place.name}/{name}.txt"
