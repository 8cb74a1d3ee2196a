"""Atomic file output: a file appears under its name only when it is complete."""

import os

from .messages import BrumeError


def write(path, data):
    """Writes bytes or text, and creates the folder."""
    if isinstance(data, str):
        data = data.encode("utf-8")
    unfinished = path + ".unfinished"
    try:
        os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
        with open(unfinished, "wb") as file:
            file.write(data)
        os.replace(unfinished, path)
    except OSError as error:
        if os.path.exists(unfinished):
            os.remove(unfinished)
        raise BrumeError(f"{path}: cannot be written: {error.strerror or error}") from error


def remove(path):
    """Removes a file if it exists."""
    try:
        os.remove(path)
    except FileNotFoundError:
        pass
    except OSError as error:
        raise BrumeError(f"{path}: cannot be removed: {error.strerror or error}") from error
