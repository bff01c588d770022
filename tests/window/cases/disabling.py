"""Disabling the extension ends the run and leaves nothing behind; enabled again it works."""

import bpy
from case import Steps, picture
from hands import addon, key, open_sidebar
from interruption import handlers, is_whole, listening, over, relax, workers
from scene import points, ready, run

MODULE = "bl_ext.user_default.mobius_flow"


def case() -> Steps:
    yield from ready()
    before = points()
    yield from relax()
    ended = run()
    bpy.ops.preferences.addon_disable(module=MODULE)
    assert ended.state.name == "CANCELLED"
    yield
    assert not workers()
    assert not listening()
    assert not handlers()
    assert not hasattr(bpy.types.Scene, "mobius_flow")
    is_whole(before)
    yield from picture("disabling-1-disabled")

    bpy.ops.preferences.addon_enable(module=MODULE)
    assert addon("live.registry").latest() is None
    yield from open_sidebar()
    yield from relax()
    yield from picture("disabling-2-enabled-again")
    yield from key("ESC")
    yield from over("Esc in the extension enabled again")
    is_whole(before)
