"""Runs programs and measures what they took, with those that they started."""
import os
import subprocess
import time


class Run:
    """What a program printed and took: `cpu` and `wall` seconds, and its peak of memory in MB."""

    def __init__(self, out, wall, usage):
        self.out, self.wall = out, wall
        self.cpu, self.memory = usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


class Failed(Exception):
    """A program that did not end with code 0, in one line."""


def run(words, folder, environment=None):
    """Runs a program in a folder, its output kept in FOLDER/log.txt."""
    words = [str(word) for word in words]
    with open(folder / "log.txt", "a+b") as log:
        begin, at = time.monotonic(), log.seek(0, os.SEEK_END)
        process = subprocess.Popen(words, cwd=folder, stdin=subprocess.DEVNULL, stdout=log,
                                   stderr=subprocess.STDOUT, env={**os.environ, **(environment or {})})
        # What the process took, and its children that ended; of memory the largest.
        try:
            _, status, usage = os.wait4(process.pid, 0)
        except BaseException:
            process.kill()
            process.wait()
            raise
        process.returncode = os.waitstatus_to_exitcode(status)
        wall = time.monotonic() - begin
        log.seek(at)
        out = log.read().decode(errors="replace")
    if process.returncode:
        last = (out.strip().splitlines() or ["no output"])[-1]
        raise Failed(f"{words[0]} ended with code {process.returncode}: {last}")
    return Run(out, wall, usage)


LONG = 20  # CPU seconds from which on a run is not repeated


def median_run(words, folder, times, environment=None):
    """Runs a program several times; that of the median of processor time."""
    runs = [run(words, folder, environment)]
    while len(runs) < times and runs[0].cpu < LONG:
        runs.append(run(words, folder, environment))
    return sorted(runs, key=lambda one: one.cpu)[(len(runs) - 1) // 2]
