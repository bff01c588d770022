"""How a live relaxation responds to undo, and to files that are loaded or saved."""

from collections.abc import Callable
from typing import Any

import bpy
from bpy.app.handlers import persistent

from ...core.base import Message
from ..curves.member import show_originals
from . import registry
from .modal import clear_status
from .run import LiveRun


def _forget() -> None:
    """Forget the run of another file; the new one may have been saved automatically during a run."""
    registry.forget()
    show_originals()


def _before_undo(run: LiveRun, others: int) -> None:
    """Undo must find the originals; the run goes on only if something else is undone or redone."""
    if others and run.endures:
        run.session.hide()
    else:
        run.cancel(Message("Undone; the relaxation of {names} has ended", names=run.name))


def _after_undo(run: LiveRun, count: int) -> None:
    drag = registry.history.undo(count)
    run.session.resume()
    if drag:
        run.take_back()


def _handler(handle: Callable[[LiveRun], None], otherwise: Callable[[], None] = lambda: None) -> Any:
    def handler(*_: Any) -> None:
        run = registry.current()
        handle(run) if run else otherwise()

    return persistent(handler)


# after undo without a run, Blender may have gone back to the middle of one that is over
HANDLERS = {
    "load_pre": _handler(
        lambda run: run.cancel(Message("A file was loaded; the relaxation of {names} has ended", names=run.name))
    ),
    "load_post": _handler(lambda _run: _forget(), _forget),
    "undo_pre": _handler(lambda run: _before_undo(run, registry.history.others)),
    "redo_pre": _handler(lambda run: _before_undo(run, registry.history.undone)),
    "undo_post": _handler(lambda run: _after_undo(run, 1), show_originals),
    "redo_post": _handler(lambda run: _after_undo(run, -1), show_originals),
    "frame_change_post": _handler(lambda run: run.look()),
    "save_pre": _handler(lambda run: run.session.hide()),  # a file holds curves as they were
    "save_post": _handler(lambda run: run.session.resume()),
    "save_post_fail": _handler(lambda run: run.session.resume()),
}


def register() -> None:
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    """End what is running, and stop listening."""
    if run := registry.current():
        run.cancel(Message("Möbius Flow was disabled; all is as it was"))
    registry.forget()
    if bpy.app.timers.is_registered(clear_status):
        bpy.app.timers.unregister(clear_status)
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).remove(handler)
