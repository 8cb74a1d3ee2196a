"""Runs the brume program as a child process."""

import functools
import os
import shutil
import signal
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


@functools.lru_cache(maxsize=8)
def _render_help(path, _changed):
    """The help of `brume render`; empty if the program fails."""
    try:
        run = subprocess.run(
            [path, "render", "--help"],
            cwd=tempfile.gettempdir(),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=3,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return run.stdout.decode("utf-8", "replace") if run.returncode == 0 else ""


def render_has(path, option):
    """Whether `brume render` of this program has an option, such as "--tone"."""
    return option in _render_help(path, os.stat(path).st_mtime_ns).split()


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
                start_new_session=os.name == "posix",
            )
        except OSError as error:
            raise BrumeError(f"{arguments[0]} does not start: {error.strerror}") from error

    def running(self):
        return self._child.poll() is None

    def kill(self):
        """Ends the program and its children at once; running() reports when it has ended."""
        if not self.running():
            return
        if os.name == "posix":
            os.killpg(self._child.pid, signal.SIGKILL)
        else:
            self._child.kill()

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
