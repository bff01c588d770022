"""What happens to a live relaxation when a file is loaded or saved, or somebody undoes."""

from collections.abc import Callable
from functools import wraps
from typing import Any

import bpy
from bpy.app.handlers import persistent

from ...core.messages import Message
from ..curves.member import show_originals
from . import registry
from .modal import clear_status
from .run import Run


def _during_run(handle: Callable[[Run], None]) -> Any:
    """Call a handler with the run that is going on, if there is one."""

    @wraps(handle)
    def handler(*_: Any) -> None:
        if run := registry.current():
            handle(run)

    return persistent(handler)


@_during_run
def _load_pre(run: Run) -> None:
    run.cancel(Message("A file was loaded; the relaxation of {names} has ended", names=run.name))


@persistent  # type: ignore[untyped-decorator]
def _load_post(*_: Any) -> None:
    registry.forget()  # it was about another file
    show_originals()  # of a run during which the file was saved automatically


@_during_run
def _undo_pre(run: Run) -> None:
    _before(run, registry.history.others)


@_during_run
def _redo_pre(run: Run) -> None:
    _before(run, registry.history.undone)


@persistent  # type: ignore[untyped-decorator]
def _undo_post(*_: Any) -> None:
    if run := registry.current():
        registry.history.undo()
    _after(run)


@persistent  # type: ignore[untyped-decorator]
def _redo_post(*_: Any) -> None:
    if run := registry.current():
        registry.history.undo(-1)
    _after(run)


def _before(run: Run, others: int) -> None:
    """The curve must be as undo knows it; unless something else is undone or done again, the run is over."""
    if others and run.endures:
        run.group.hide()
    else:
        run.cancel(Message("Undone; the relaxation of {names} has ended", names=run.name))


def _after(run: Run | None) -> None:
    """Show what the run has reached; without one, Blender may have gone back to the middle of one that is over."""
    if run:
        run.group.resume()
    else:
        show_originals()


@_during_run
def _save_pre(run: Run) -> None:
    """A file holds curves as they were or with all their keys, and nothing in between."""
    run.complete()
    if not run.state.over:
        run.group.hide()


@_during_run
def _save_post(run: Run) -> None:
    run.group.resume()


_HANDLERS = {
    "load_pre": _load_pre,
    "load_post": _load_post,
    "undo_pre": _undo_pre,
    "redo_pre": _redo_pre,
    "undo_post": _undo_post,
    "redo_post": _redo_post,
    "save_pre": _save_pre,
    "save_post": _save_post,
    "save_post_fail": _save_post,
}


def register() -> None:
    for name, handler in _HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    """End what is running, and listen no more."""
    if run := registry.current():
        run.cancel(Message("Möbius Flow was disabled; all is as it was"))
    registry.forget()
    if bpy.app.timers.is_registered(clear_status):
        bpy.app.timers.unregister(clear_status)
    for name, handler in _HANDLERS.items():
        getattr(bpy.app.handlers, name).remove(handler)
