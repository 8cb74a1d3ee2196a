"""Runs the brume program as a child process."""

import os
import shutil
import subprocess
import tempfile

import bpy

from .messages import BrumeError
from .preferences import program_path


def find(context):
    """The program set in the preferences, else the one on PATH."""
    chosen = program_path(context)
    if chosen:
        path = bpy.path.abspath(chosen)
        if os.path.isfile(path) and os.access(path, os.X_OK):
            return path
        raise BrumeError(f"{path} is not executable; set the path of brume in Preferences > Add-ons > Brume")
    path = shutil.which("brume")
    if path is None:
        raise BrumeError("brume is not on PATH; set its path in Preferences > Add-ons > Brume")
    return path


class Job:
    """A running program. Its output goes to files, so that it never blocks on a full pipe."""

    def __init__(self, arguments, folder):
        self._out, self._error = tempfile.TemporaryFile(), tempfile.TemporaryFile()
        try:
            self._child = subprocess.Popen(
                arguments,
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=self._out,
                stderr=self._error,
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            )
        except OSError as error:
            raise BrumeError(f"{arguments[0]} does not start: {error.strerror}") from error

    def running(self):
        return self._child.poll() is None

    def stop(self):
        self._child.terminate()
        try:
            self._child.wait(5)
        except subprocess.TimeoutExpired:
            self._child.kill()
            self._child.wait()

    def wait(self):
        self._child.wait()

    def result(self, warnings):
        """Returns the standard output. Adds its warnings to `warnings`; raises BrumeError if it failed."""
        lines = [line for line in _text(self._error).splitlines() if line.strip()]
        prefix = "brume: warning: "
        for line in lines:
            # The author of a scene knows that it has no grenade of its own.
            if line.startswith(prefix) and not line.endswith("a built-in one is thrown"):
                warnings.add(line[len(prefix) :])
        if self._child.returncode != 0:
            errors = [line for line in lines if not line.startswith(prefix)]
            raise BrumeError(errors[-1] if errors else f"brume ended with code {self._child.returncode}")
        return _text(self._out)


def _text(file):
    file.seek(0)
    return file.read().decode("utf-8", "replace")
