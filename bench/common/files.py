"""Writes files."""
import os
import pathlib
import tempfile


class CannotWrite(Exception):
    """One line for the user."""


def write_whole(path, text):
    """All of the file or nothing."""
    path = pathlib.Path(path)
    try:
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix="." + path.name, suffix=".tmp")
    except OSError as error:
        raise CannotWrite(f"{path}: {error.strerror}; expected a folder that can be written to") from error
    try:
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except OSError as error:
        os.unlink(temporary)
        raise CannotWrite(f"{path}: {error.strerror}; expected space and a file that can be replaced") from error
    except BaseException:
        os.unlink(temporary)
        raise
