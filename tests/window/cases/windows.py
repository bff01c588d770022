"""Closing a window: a run that was started in another goes on, one that was started in it ends."""

import bpy
from case import Steps, picture
from hands import key
from interruption import is_whole, over, relax
from scene import points, reaches, ready, run


def case() -> Steps:
    yield from ready(vertices=1200)  # it takes longer than opening and closing windows
    before = points()
    yield from relax()
    second = opened()
    yield from reaches(run().last.index + 1)
    yield from picture("windows-1-two")
    close(second)
    yield from reaches(run().last.index + 2)
    yield from key("ESC")
    yield from over("Esc after a second window was closed")
    is_whole(before)

    second = opened()
    yield
    with bpy.context.temp_override(window=second):
        assert bpy.ops.curve.mobius_flow_relax("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield from reaches(2)
    close(second)
    yield from over("closing the window of the run")
    is_whole(before)
    yield from picture("windows-2-restored")


def opened() -> bpy.types.Window:
    """A second window."""
    bpy.ops.wm.window_new()
    return bpy.context.window_manager.windows[-1]


def close(window: bpy.types.Window) -> None:
    with bpy.context.temp_override(window=window):
        bpy.ops.wm.window_close()
