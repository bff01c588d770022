"""Esc and Enter are for the run only over a 3D view and without playback; Cancel is there at any time."""

import bpy
from case import Steps, picture, until
from hands import button, here, key, window
from interruption import is_whole, over, relax
from scene import iterate, points, reaches, ready, run, state


def case() -> Steps:
    yield from ready(vertices=1000)
    before = points()
    yield from relax()
    with here():
        bpy.ops.screen.animation_play()
    yield from until(lambda: window().screen.is_animation_playing, "playback")
    yield from reaches(iterate() + 2)
    yield from key("ESC")
    yield from until(lambda: not window().screen.is_animation_playing, "Esc to stop playback")
    assert state() == "running", "Esc was for the playback"
    yield from reaches(iterate() + 1)

    outliner = next(area for area in window().screen.areas if area.type == "OUTLINER")
    over_it = (outliner.x + outliner.width // 2, outliner.y + outliner.height // 2)
    for name in ("ESC", "RETURN"):
        yield from key(name, over=over_it)
        yield from reaches(iterate() + 1)
    assert state() == "running", "the mouse was over another editor"
    yield from picture("playback-1-running")
    run().toggle_pause()  # finding a button takes a while
    yield from button("curve.mobius_flow_cancel")
    yield from over("Cancel")
    is_whole(before)
    yield from picture("playback-2-cancelled", differs_from="playback-1-running")
