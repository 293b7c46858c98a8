"""Long work of an operator in steps, so that Blender's window shows how far it is, and Esc ends it."""

import threading
import time

# Seconds of work at a time, between which Blender draws; a window feels slow from a tenth of a second on.
SLICE = 0.05
# Seconds from step to step.
PAUSE = 0.02


class Cancelled(Exception):
    """The user has ended the work."""


class Job:
    """Runs a generator that yields the part that is done, from 0 to 1. `result` is what it returns."""

    def __init__(self, work):
        self._work = work
        self.part = 0.0
        self.result = None

    def step(self):
        """Works for a moment. Returns True once the work is done; raises what the work raises."""
        until = time.monotonic() + SLICE
        try:
            while time.monotonic() < until:
                self.part = next(self._work)
        except StopIteration as end:
            self.part, self.result = 1.0, end.value
            return True
        return False

    def cancel(self):
        """Ends the work, which puts back what it has changed."""
        self._work.close()


def in_thread(function):
    """Runs `function(progress)` in a thread, and yields the part that it reports. A generator that is closed lets the thread end at its next report."""
    state = {"part": 0.0, "cancelled": False}

    def progress(part):
        if state["cancelled"]:
            raise Cancelled("cancelled")
        state["part"] = part

    def run():
        try:
            state["result"] = function(progress)
        except BaseException as error:
            state["error"] = error

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    try:
        while thread.is_alive():
            yield state["part"]
            thread.join(PAUSE)
    finally:
        state["cancelled"] = True
        thread.join()
    if "error" in state:
        raise state["error"]
    return state["result"]


class Modal:
    """An operator that runs a job: `work(context)` is its generator, `finished(context, result)` returns a message."""

    def start(self, context):
        """Begins; `modal` goes on."""
        manager = context.window_manager
        self.job = Job(self.work(context))
        self.timer = manager.event_timer_add(PAUSE, window=context.window)
        manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """A step at each tick of the timer. Other events wait: the scene is the job's until it ends."""
        if event.type == "ESC":
            self.job.cancel()
            self.report({"WARNING"}, "cancelled: nothing was written")
            return self.stop(context, {"CANCELLED"})
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        try:
            if not self.job.step():
                context.window_manager.progress_update(round(100 * self.job.part))
                context.workspace.status_text_set(f"Pantin: {100 * self.job.part:.0f} %, Esc cancels")
                return {"RUNNING_MODAL"}
            message = self.finished(context, self.job.result)
        except self.REFUSALS as error:
            self.report({"ERROR"}, str(error))
            return self.stop(context, {"CANCELLED"})
        except BaseException:
            # A fault of ours: Blender shows it, and the window is as before.
            self.stop(context, None)
            raise
        self.report({"INFO"}, message)
        return self.stop(context, {"FINISHED"})

    def stop(self, context, outcome):
        """Puts the window back."""
        context.window_manager.event_timer_remove(self.timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        return outcome
