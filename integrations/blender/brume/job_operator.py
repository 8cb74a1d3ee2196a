"""Base of operators that run brume: in the background of a window, or blocking in a script."""

import shutil
import tempfile

from . import program
from .messages import BrumeError, Warnings


class JobOperator:
    """An operator that exports the scene, runs brume and uses the result. A subclass defines:

    arguments(context, folder): exports into the temporary `folder` and returns the arguments of brume.
    finish(context, folder, out): uses the files in `folder` and the standard output of brume.
    """

    stopped_by_escape = True
    _timer = None

    def _start(self, context):
        self._warnings = Warnings()
        self._folder = tempfile.mkdtemp(prefix="brume_")
        try:
            command = [program.find(context)] + self.arguments(context, self._folder)
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
        self.report({"ERROR"}, str(error))
        return {"CANCELLED"}

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
        if self.stopped_by_escape:
            context.workspace.status_text_set(self.bl_label + ": Esc to stop")
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if self.stopped_by_escape and (event.type, event.value) == ("ESC", "PRESS"):
            self.cancel(context)
            return {"CANCELLED"}
        if event.type != "TIMER" or self._job.running():
            return {"PASS_THROUGH"}
        try:
            self._end(context)
        except BrumeError as error:
            return self._failed(error)
        return {"FINISHED"}

    def cancel(self, context):
        """Stops the program: called on Esc and when Blender closes."""
        self._job.stop()
        self._clean(context)
