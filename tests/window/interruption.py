"""A run that something happens to: how it starts, and what must be true when it is over."""

import threading
from pathlib import Path

import bpy
import numpy as np
from case import Steps, until
from hands import here
from scene import endless, points, reaches, run, state

MOVED = 2  # iterates


def relax() -> Steps:
    """Start a run anew that is not over by itself, with an undo step before it; wait until the curve has moved."""
    endless()
    with here():
        bpy.ops.ed.undo_push(message="Before")
        assert bpy.ops.curve.mobius_flow_relax("INVOKE_DEFAULT", again=True) == {"RUNNING_MODAL"}
    yield from reaches(MOVED)
    assert len(workers()) == 1, (state(), workers())


def over(what: str, wanted: str = "cancelled") -> Steps:
    """Wait until the run is over in this way, and see that nothing of it is left."""
    yield from until(lambda: run() is None, f"the run to end after {what}")
    print(f"ENDED by {what}: {state()}", flush=True)
    assert state() == wanted, state()
    assert not workers(), "the worker's process has ended"
    assert not [each.name for each in threading.enumerate() if each.name.startswith("Möbius")]
    yield from until(lambda: not listening(), "the operator to end")
    assert len(handlers()) == len(set(handlers())), "nothing listens twice"


def is_whole(before: np.ndarray) -> None:
    """See that the curve is what it was, bit for bit."""
    assert np.array_equal(points(), before)


def undo() -> None:
    """Edit > Undo."""
    with here():
        bpy.ops.ed.undo()


def workers() -> list[str]:
    """Command lines of the processes that Blender started and that are still there."""
    found = []
    for child in Path("/proc/self/task").glob("*/children"):
        for pid in child.read_text().split():
            command = Path(f"/proc/{pid}/cmdline").read_text().replace("\0", " ")
            found += [command] if "child.py" in command else []
    return found


def listening() -> list[str]:
    """Operators of ours that still get the events of a window."""
    windows = bpy.context.window_manager.windows
    names = [_name(operator) for window in windows for operator in window.modal_operators]
    return [name for name in names if "mobius_flow" in name.lower()]


def _name(operator: bpy.types.Operator | None) -> str:
    try:
        return str(operator.bl_idname)
    except (AttributeError, ValueError):  # just taken out by Blender: nothing, or an empty shell in 4.3
        return ""


def handlers() -> list[str]:
    """Functions of ours that Blender calls when something happens."""
    lists = {name: getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers)}
    return [
        f"{name}: {each.__name__}"
        for name, functions in lists.items()
        if isinstance(functions, list)
        for each in functions
        if "mobius_flow" in each.__module__
    ]
