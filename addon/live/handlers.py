"""What happens to a live relaxation when a file is loaded or saved, or somebody undoes."""

from collections.abc import Callable
from typing import Any

import bpy
from bpy.app.handlers import persistent

from ..engine.phrase import Phrase
from . import registry
from .modal import clear_status
from .run import Run


def _before_undo(run: Run, others: int) -> None:
    """The curve must be as undo knows it; unless something else is undone or done again, the run is over."""
    if others and run.endures:
        run.preview.set_aside()
    else:
        run.cancel(Phrase("Undone; the relaxation of {names} has ended", names=run.name))


def _after_undo(run: Run, count: int) -> None:
    registry.history.undo(count)
    run.preview.put_forward()


def _before_saving(run: Run) -> None:
    """A file holds curves as they were or with all their keys, and nothing in between."""
    run.complete()
    if not run.state.over:
        run.preview.set_aside()


def _with_run(handle: Callable[[Run], None]) -> Any:

    def handler(*_: Any) -> None:
        if run := registry.current():
            handle(run)

    return persistent(handler)


@persistent  # type: ignore[untyped-decorator]
def _load_post(*_: Any) -> None:
    registry.forget()  # it was about another file


HANDLERS = {
    "load_pre": _with_run(
        lambda run: run.cancel(Phrase("A file was loaded; the relaxation of {names} has ended", names=run.name))
    ),
    "load_post": _load_post,
    "undo_pre": _with_run(lambda run: _before_undo(run, registry.history.others)),
    "redo_pre": _with_run(lambda run: _before_undo(run, registry.history.undone)),
    "undo_post": _with_run(lambda run: _after_undo(run, 1)),
    "redo_post": _with_run(lambda run: _after_undo(run, -1)),
    "save_pre": _with_run(_before_saving),
    "save_post": _with_run(lambda run: run.preview.put_forward()),
    "save_post_fail": _with_run(lambda run: run.preview.put_forward()),
}


def register() -> None:
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    """End what is running, and listen no more."""
    if run := registry.current():
        run.cancel(Phrase("Möbius Flow was disabled; all is as it was"))
    registry.forget()
    if bpy.app.timers.is_registered(clear_status):
        bpy.app.timers.unregister(clear_status)
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).remove(handler)
