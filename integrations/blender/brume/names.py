"""Names that every format, file system and timeline takes."""

import re
import unicodedata

# What Windows does not let a file be called.
_RESERVED = {"con", "prn", "aux", "nul"} | {f"{port}{i}" for port in ("com", "lpt") for i in range(1, 10)}
_LONGEST = 60


def safe(name, otherwise="object"):
    """ASCII letters, digits, '_', '-' and '.': one word of a Scene.txt and a file name anywhere."""
    plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode()
    plain = re.sub(r"[^A-Za-z0-9_.-]+", "_", plain).lstrip(".-")[:_LONGEST].rstrip(".")
    if not plain.strip("_"):
        plain = otherwise
    if plain.split(".")[0].lower() in _RESERVED or plain == "LIGHT_SOURCE":
        plain = "_" + plain
    return plain


class UniqueNames:
    """Hands out each name once, letter case ignored: file systems differ in it."""

    def __init__(self, taken=()):
        self._taken = {name.lower() for name in taken}

    def take(self, wanted):
        name, number = wanted, 1
        while name.lower() in self._taken:
            number += 1
            name = f"{wanted}_{number}"
        self._taken.add(name.lower())
        return name
