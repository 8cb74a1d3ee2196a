"""Messages to the user: one-line errors, warnings and notes. The sidebar lists those of the last operator."""

from dataclasses import dataclass

import bpy


class BrumeError(Exception):
    """An expected failure; the message is one line that names the problem and the fix."""


@dataclass(frozen=True)
class Message:
    kind: str  # ERROR, WARNING, or INFO.
    text: str
    thing: str = ""  # Name of the event that it is about.


_last = []


def last():
    """The messages of the last operator, worst first."""
    return list(_last)


def show(messages):
    """Replaces the messages of the sidebar."""
    _last[:] = sorted(messages, key=lambda message: ("ERROR", "WARNING", "INFO").index(message.kind))
    manager = bpy.context.window_manager
    for window in manager.windows if manager else ():
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def fail(operator, error, messages=()):
    """Reports an error as the result of an operator."""
    operator.report({"ERROR"}, str(error))
    show([*messages, Message("ERROR", str(error))])
    return {"CANCELLED"}


class Warnings:
    """Collects warnings and notes without duplicates."""

    def __init__(self):
        self.messages = []

    def add(self, text, thing=""):
        self._add(Message("WARNING", text, thing))

    def note(self, text, thing=""):
        """A remark that only the sidebar shows."""
        self._add(Message("INFO", text, thing))

    def _add(self, message):
        if message not in self.messages:
            self.messages.append(message)

    def report(self, operator):
        """Shows all in the sidebar, prints the warnings to the console, and the first to Blender's status bar."""
        show(self.messages)
        lines = [message.text for message in self.messages if message.kind == "WARNING"]
        for line in lines:
            print("Brume: warning: " + line)
        if lines:
            more = len(lines) - 1
            tail = f" (and {more} more in the sidebar, tab Brume)" if more else ""
            operator.report({"WARNING"}, lines[0] + tail)
