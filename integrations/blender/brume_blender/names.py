"""Names that are valid in every format, file system and timeline."""

import re
import unicodedata

# File names that Windows reserves.
_RESERVED = {"con", "prn", "aux", "nul"} | {f"{port}{i}" for port in ("com", "lpt") for i in range(1, 10)}
_LONGEST = 60


def safe(name, otherwise="object"):
    """Reduces a name to ASCII letters, digits, '_', '-' and '.': a word in Scene.txt and a portable file name."""
    plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode()
    plain = re.sub(r"[^A-Za-z0-9_.-]+", "_", plain).lstrip(".-")[:_LONGEST].rstrip(".")
    if not plain.strip("_"):
        plain = otherwise
    if plain.split(".")[0].lower() in _RESERVED or plain == "LIGHT_SOURCE":
        plain = "_" + plain
    return plain


class UniqueNames:
    """Makes names unique ignoring case, because some file systems do."""

    def __init__(self, taken=()):
        self._taken = {name.lower() for name in taken}

    def take(self, base):
        name, number = base, 1
        while name.lower() in self._taken:
            number += 1
            name = f"{base}_{number}"
        self._taken.add(name.lower())
        return name
