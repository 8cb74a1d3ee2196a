"""Values as TOML text."""

from .conversion import number


def quoted(text):
    """Quotes text as a TOML basic string."""
    result = ""
    for character in text:
        if character in '"\\':
            result += "\\" + character
        elif ord(character) < 0x20 or ord(character) == 0x7F:
            result += f"\\u{ord(character):04x}"
        else:
            result += character
    return f'"{result}"'


def vector(values):
    return "[" + ", ".join(number(value) for value in values) + "]"
