"""What the scripts that compare renderers have in common: programs, options, and the name of the machine."""
import argparse
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def find(script, given, *others):
    """The programs `brume` and others, named by their paths below the build folder, whose file names are also the
    names of their targets. They lie in the folder `given` as they are; None: builds build/release."""
    if not given:
        commands = [["script/bootstrap", "demo"], ["script/build", "release", "--program"]]
        if others:
            targets = [pathlib.Path(other).name for other in others]
            commands.append(["cmake", "--build", "--preset", "release", "--target", *targets])
        for command in commands:
            if subprocess.run(command, cwd=ROOT, stdout=sys.stderr).returncode:
                sys.exit(f"{script}: {' '.join(command)} failed")
    folder = pathlib.Path(given or ROOT / "build/release").resolve()
    found = [folder / name for name in ("brume", *others)]
    for program in found:
        if not os.access(program, os.X_OK):
            sys.exit(f"{script}: {program} is missing; build it, or remove --build")
    return found


def size_of(least, most):
    """Reads WIDTHxHEIGHT, each from `least` to `most`, for argparse."""
    def read(text):
        match = re.fullmatch(r"([0-9]{1,5})x([0-9]{1,5})", text)
        if not match or not all(least <= int(edge) <= most for edge in match.groups()):
            raise argparse.ArgumentTypeError(f"expected WIDTHxHEIGHT, each from {least} to {most}")
        return int(match[1]), int(match[2])
    return read


def machine():
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return f"{model[1] if model else 'unknown processor'}, {len(os.sched_getaffinity(0))} cores"


def blender_version(program):
    shown = subprocess.run([program, "--version"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout.decode()
    return shown.split("\n")[0].replace("Blender ", "").strip()
