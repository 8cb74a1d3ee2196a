"""Base of operators that run brume: in the background of a window, or blocking in a script."""

import shutil
import tempfile
import time

from . import program
from .messages import BrumeError, Message, Warnings, fail, show


class JobOperator:
    """An operator that exports the scene, runs brume and uses the result. A subclass defines:

    arguments(context, folder): exports into the temporary `folder` and returns the arguments of brume.
    finish(context, folder, out): uses the files in `folder` and the standard output of brume.

    and may define:

    progress(folder): called while the program runs; returns what the status bar shows.
    stopped(folder): called when Esc has stopped the program, before `folder` is removed; returns the message.
    """

    stopped_by_escape = True
    _timer = None
    _stopping = False

    def progress(self, _folder):
        return f"{time.monotonic() - self._begin:.0f} s"

    def stopped(self, _folder):
        return self.bl_label + ": stopped"

    def _start(self, context):
        self._warnings = Warnings()
        self._begin = time.monotonic()
        self._folder = tempfile.mkdtemp(prefix="brume_")
        try:
            command = [program.find(context)] + self.arguments(context, self._folder)
            show(self._warnings.messages)
            self._job = program.Job(command, self._folder)
        except BaseException:
            self._clean(context)
            raise

    def _end(self, context):
        try:
            self.finish(context, self._folder, self._job.result(self._warnings))
            self._warnings.report(self)
        finally:
            self._clean(context)

    def _clean(self, context):
        if self._timer:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
            if self.stopped_by_escape:
                context.workspace.status_text_set(None)
        shutil.rmtree(self._folder, ignore_errors=True)

    def _failed(self, error):
        return fail(self, error, self._warnings.messages)

    def execute(self, context):
        """Blocks until the program ends: for scripts and tests."""
        try:
            self._start(context)
            self._job.wait()
            self._end(context)
        except BrumeError as error:
            return self._failed(error)
        return {"FINISHED"}

    def invoke(self, context, _event):
        """Starts the program and polls it ten times per second."""
        try:
            self._start(context)
        except BrumeError as error:
            return self._failed(error)
        manager = context.window_manager
        self._timer = manager.event_timer_add(0.1, window=context.window)
        self._show_progress(context)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if self.stopped_by_escape and (event.type, event.value) == ("ESC", "PRESS") and not self._stopping:
            # The process ends when the system has released its memory; the timer waits for it.
            self._stopping = True
            self._job.kill()
            context.workspace.status_text_set(self.bl_label + ": stopping")
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        try:
            if self._job.running():
                if not self._stopping:
                    self._show_progress(context)
                return {"PASS_THROUGH"}
            if self._stopping:
                return self._stopped(context)
            self._end(context)
        except BrumeError as error:
            self.cancel(context)
            return self._failed(error)
        return {"FINISHED"}

    def _show_progress(self, context):
        if self.stopped_by_escape:
            context.workspace.status_text_set(f"{self.bl_label}: {self.progress(self._folder)}. Esc to stop")

    def _stopped(self, context):
        text = self.stopped(self._folder)
        self._clean(context)
        show([*self._warnings.messages, Message("INFO", text)])
        self.report({"INFO"}, text)
        return {"CANCELLED"}

    def cancel(self, context):
        """Stops the program: called after an error, and when Blender closes."""
        self._job.kill()
        self._job.wait()
        self._clean(context)
