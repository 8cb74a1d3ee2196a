"""Messages to the user: one-line errors, and warnings that are reported when the work is done."""


class BrumeError(Exception):
    """An expected failure; the message is one line that names the problem and the fix."""


class Warnings:
    """Collects warnings without duplicates."""

    def __init__(self):
        self.lines = []

    def add(self, line):
        if line not in self.lines:
            self.lines.append(line)

    def report(self, operator):
        """Prints all to the console, and the first to Blender's status bar."""
        for line in self.lines:
            print("Brume: warning: " + line)
        if self.lines:
            more = len(self.lines) - 1
            tail = f" (and {more} more, on the console)" if more else ""
            operator.report({"WARNING"}, self.lines[0] + tail)
