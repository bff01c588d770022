"""Undo during a run, by key or from the menu, ends it and puts the curve back, unless it undoes something else."""

import bpy
import numpy as np
from case import Steps, picture, until
from hands import addon, here, key, window
from interruption import is_whole, over, relax, undo
from scene import iterate, points, reaches, ready, run


def case() -> Steps:
    yield from ready()
    before = points()
    yield from by_key(before)
    yield from by_menu(before)
    yield from of_something_else(before)
    yield from twice(before)


def by_key(before: np.ndarray) -> Steps:
    """Ctrl-Z ends the run."""
    yield from relax()
    yield from picture("undo-1-running")
    yield from key("Z", ctrl=True)
    yield from over("Ctrl-Z")
    is_whole(before)
    yield from picture("undo-2-ctrl-z", differs_from="undo-1-running")


def by_menu(before: np.ndarray) -> Steps:
    """So do undo and redo of the menu."""
    yield from relax()
    undo()
    yield from over("Edit > Undo")
    is_whole(before)
    with here():  # no new undo step, or there would be nothing to redo
        bpy.ops.curve.mobius_flow_relax("INVOKE_DEFAULT")
    yield from reaches(2)
    with here():
        bpy.ops.ed.redo()
    yield from over("Edit > Redo")
    is_whole(before)


def of_something_else(before: np.ndarray) -> Steps:
    """What was done during the run is undone first, and the run goes on."""
    yield from relax()
    objects = len(bpy.data.objects)
    for what in ("key", "menu"):
        with here():
            bpy.ops.object.empty_add("EXEC_DEFAULT", True)
            window().view_layer.objects.active = bpy.data.objects["5_2"]
        yield from reaches(iterate() + 1)
        if what == "key":
            yield from key("Z", ctrl=True)
        else:
            undo()
        yield from until(lambda: len(bpy.data.objects) == objects, f"undo of something else by {what}")
        assert run(), addon("live.registry").latest().message
        yield from reaches(iterate() + 2)
    yield from picture("undo-3-of-something-else", differs_from="undo-2-ctrl-z")
    window().view_layer.objects.active = bpy.data.objects["5_2"]
    yield from key("Z", ctrl=True)
    yield from over("Ctrl-Z when there is nothing else to undo")
    is_whole(before)


def twice(before: np.ndarray) -> Steps:
    """Undo after a run that was given up over another undo step finds the curve as it was."""
    yield from relax()
    for what in ("Something else", "And another"):
        with here():
            bpy.ops.ed.undo_push(message=what)
        yield from reaches(iterate() + 1)
    yield from key("ESC")
    yield from over("Esc after other undo steps")
    is_whole(before)
    for _ in range(2):  # the first step has a preview
        yield from key("Z", ctrl=True)
        yield
        is_whole(before)
        assert len(bpy.data.curves) == 1
    with here():
        bpy.ops.ed.redo()
    is_whole(before)
    yield from picture("undo-4-twice")
