"""Which run is going on, and which was the last: known to Python only."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .run import Run

_running: "list[Run]" = []
_finished: "list[Run]" = []


def begin(run: "Run") -> None:
    """A run goes on from now; there is only one at a time."""
    assert not _running, "checks.refusal says so before"
    _running.append(run)


def end(run: "Run") -> None:
    """A run is over; it is remembered for the panel."""
    if run in _running:
        _running.remove(run)
    _finished[:] = [run]


def current() -> "Run | None":
    """The run that is going on, if there is one."""
    return _running[0] if _running else None


def latest() -> "Run | None":
    """The run that is going on, or else the last one."""
    return next(iter(_running + _finished), None)


def forget() -> None:
    """Forget the last run."""
    _finished.clear()
