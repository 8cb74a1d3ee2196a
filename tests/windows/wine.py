"""Runs programs for Windows under Wine, with a display and a prefix of their own."""
import os
import pathlib
import shutil
import subprocess

LAVAPIPE = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json"


def program(name):
    """A program of Wine, which Debian's package does not put on the PATH; None: it is not installed."""
    return shutil.which(name, path=os.environ["PATH"] + ":/usr/lib/wine")


def missing():
    """Why nothing can run; empty if it can."""
    for name, package in (("wine64", "wine64"), ("wineserver64", "wine64"), ("Xvfb", "xvfb")):
        if not program(name):
            return f"{name} is not installed; script/bootstrap windows installs {package}"
    return ""


class Wine:
    """A display and a Wine server. The server chooses its Vulkan driver when it starts: one that was started without
    a display has none until it ends."""

    def __init__(self, prefix):
        self.environment = {**os.environ, "WINEPREFIX": str(prefix), "WINEDEBUG": "-all", "VK_DRIVER_FILES": LAVAPIPE}
        pathlib.Path(prefix).mkdir(parents=True, exist_ok=True)
        ready, tells = os.pipe()
        self.display = subprocess.Popen(
            ["Xvfb", "-displayfd", str(tells), "-screen", "0", "1024x768x24", "-nolisten", "tcp"],
            pass_fds=[tells], stderr=subprocess.DEVNULL)
        os.close(tells)
        with os.fdopen(ready) as numbers:
            self.environment["DISPLAY"] = ":" + numbers.readline().strip()
        self._end_server()
        boot = subprocess.run([program("wine64"), "wineboot", "--init"], env=self.environment, capture_output=True)
        if boot.returncode != 0:
            raise RuntimeError(f"wineboot: {boot.stderr.decode(errors='replace')}")

    def _end_server(self):
        for option in ("-k", "-w"):
            subprocess.run([program("wineserver64"), option], env=self.environment, capture_output=True)

    def close(self):
        self._end_server()
        self.display.terminate()
        self.display.wait()

    def run(self, command, folder, **variables):
        """The exit code, standard output and standard error of a command, as bytes."""
        ended = subprocess.run([program("wine64"), *map(str, command)], cwd=folder, capture_output=True,
                               env={**self.environment, **variables}, stdin=subprocess.DEVNULL, timeout=1200)
        return ended.returncode, ended.stdout, ended.stderr
