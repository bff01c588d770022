"""Which run is going on, and which was the last: known to Python only."""

from typing import TYPE_CHECKING

from .run import Run

if TYPE_CHECKING:
    import bpy

_latest: list[Run] = []


def begin(run: Run) -> None:
    """A run goes on from now; there is only one at a time."""
    assert current() is None, "checks.refusal says so before"
    _latest[:] = [run]


def current() -> Run | None:
    """The run that is going on, if there is one."""
    run = latest()
    return None if run is None or run.state.over else run


def latest() -> Run | None:
    """The run that is going on, or else the last one."""
    return _latest[0] if _latest else None


def shown(obj: "bpy.types.Object | None") -> Run | None:
    """The run that is going on, or else the last one, if what is known of it is about an object as it is now."""
    run = latest()
    return run if run is not None and run.concerns(obj) else None


def forget() -> None:
    """Forget the last run."""
    _latest.clear()
