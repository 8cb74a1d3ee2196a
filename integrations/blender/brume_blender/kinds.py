"""Kinds of events that empties stand for: all that differs between them, besides how they are checked."""

from typing import NamedTuple

from .settings import EVENT_FIELDS

HOLE_TIMES = ("reach", "expand", "stay", "fade")
_HOLE_LABELS = {
    "reach": "Bore Time",
    "expand": "Open Time",
    "stay": "Stay Open",
    "fade": "Close Time",
}


class Kind(NamedTuple):
    label: str
    description: str
    number: int  # Stands for it in .blend files.
    name: str  # The type in timelines.
    color: tuple  # Lines in the 3D view have it.
    empty: tuple  # Name and display of a new empty, and its size [m].
    fields: tuple  # Properties in the panel, in order.
    labels: dict = {}  # What the panel calls its numbers.
    ball: str = ""  # Property of the radius of a ball around it.
    presets: dict = {}  # Settings that belong together, by name; a smoke's are the scene's, its radius in metres.


KINDS = {
    "SMOKE": Kind(
        "Smoke Grenade",
        "A grenade goes off here",
        1,
        "smoke",
        (0.75, 0.8, 0.85),
        ("Brume smoke", "SPHERE", 0.15),
        ("thrown_from",),
        presets={
            "Small Screen": {"radius": 1.5, "smoke_bloom": 0.8, "smoke_hold": 10.0, "smoke_extinction": 3.0},
            "Room": {"radius": 2.0, "smoke_bloom": 1.0, "smoke_hold": 18.0, "smoke_extinction": 3.0},
            "Wide Smoke": {"radius": 4.0, "smoke_bloom": 2.5, "smoke_hold": 25.0, "smoke_extinction": 3.0},
            "Thin Haze": {"radius": 4.0, "smoke_bloom": 4.0, "smoke_hold": 30.0, "smoke_extinction": 0.5},
        },
    ),
    "SHOT": Kind(
        "Shot",
        "A shot is fired from here along the arrow",
        2,
        "shot",
        (1.0, 0.75, 0.25),
        ("Brume shot", "SINGLE_ARROW", 0.5),
        ("aim", "shape", "shown_radius", "roll", "flash") + HOLE_TIMES,
        {"radius": "Radius", "roll": "Roll", "flash": "Flash (W/sr)"} | _HOLE_LABELS,
        presets={
            "Pistol": {"shape": "CYLINDER", "radius": 0.1, "reach": 0.25, "stay": 0.3, "flash": 12.0},
            "Rifle": {"shape": "CYLINDER", "radius": 0.25, "reach": 0.25, "stay": 0.6, "flash": 25.0},
            "Shotgun": {"shape": "CYLINDER", "radius": 0.6, "reach": 0.3, "stay": 1.0, "flash": 60.0},
            "Window": {"shape": "BOX", "radius": 0.7, "reach": 0.1, "stay": 5.0, "flash": 0.0},
        },
    ),
    "WORD": Kind(
        "Word",
        "Letters are shot from here along the arrow",
        3,
        "text",
        (1.0, 0.75, 0.25),
        ("Brume word", "SINGLE_ARROW", 0.5),
        ("text", "aim", "shown_size", "font", "spacing", "interval", "roll") + HOLE_TIMES,
        {"size": "Height", "spacing": "Spacing", "interval": "Interval", "roll": "Roll"} | _HOLE_LABELS,
        presets={
            "At Once": {"interval": 0.0, "stay": 2.0, "size": 0.5},
            "Letter by Letter": {"interval": 0.15, "stay": 3.0, "size": 0.5},
        },
    ),
    "BLAST": Kind(
        "Blast",
        "An explosion",
        4,
        "blast",
        (1.0, 0.4, 0.2),
        ("Brume blast", "SPHERE", 0.15),
        ("shown_blast_radius", "shown_speed", "blast_flash", "remaining", "refill_rim", "refill_middle"),
        {
            "radius": "Radius",
            "flash": "Flash (W/sr)",
            "speed": "Speed",
            "remaining": "Remaining",
            "refill_rim": "Rim Refills In",
            "refill_middle": "Middle Refills In",
        },
        ball="blast_radius",
        presets={
            "Flashbang": {"blast_radius": 2.0, "blast_flash": 800.0, "remaining": 0.3},
            "Grenade": {"blast_radius": 5.0, "blast_flash": 250.0, "remaining": 0.02},
            "Big Blast": {"blast_radius": 10.0, "blast_flash": 1500.0, "remaining": 0.0},
        },
    ),
    "DOOR": Kind(
        "Door Event",
        "A door opens or closes",
        5,
        "door",
        (0.4, 0.8, 1.0),
        ("Brume door", "PLAIN_AXES", 0.5),
        ("door", "open"),
    ),
}
# Identifiers by the types in timelines.
TYPES = {kind.name: identifier for identifier, kind in KINDS.items()}


def _properties():
    """The property of each number: {(type, key): name}. Kinds share those that have the same range and default."""
    names, taken = {}, {}
    for kind in KINDS.values():
        for key, setting in EVENT_FIELDS[kind.name].numbers.items():
            same = setting[:4]
            name = key if taken.get(key, same) == same else f"{kind.name}_{key}"
            taken[name] = same
            names[kind.name, key] = name
    return names


PROPERTIES = _properties()
