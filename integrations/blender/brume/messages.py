"""What is said to the user: one line a fault, warnings gathered until the work is done."""


class BrumeError(Exception):
    """An expected failure, in one line: what is wrong, and the mend."""


class Warnings:
    """Gathers what could be mended. Each line is kept once."""

    def __init__(self):
        self.lines = []

    def add(self, line):
        if line not in self.lines:
            self.lines.append(line)

    def report(self, operator):
        """Says all on the console, and the first in Blender's status bar."""
        for line in self.lines:
            print("Brume: warning: " + line)
        if self.lines:
            more = len(self.lines) - 1
            tail = f" (and {more} more, on the console)" if more else ""
            operator.report({"WARNING"}, self.lines[0] + tail)
