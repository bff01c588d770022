"""Esc and Enter are for the run only over a 3D view and without playback; Cancel is there at any time."""

import bpy
from case import Steps, picture, until
from hands import button, here, key, move, window
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
    looked = run().looked_at
    yield from until(lambda: run().looked_at not in (None, looked), "playback to show what was before")
    yield from picture("playback-0-looking-back")
    yield from key("ESC")
    yield from until(lambda: not window().screen.is_animation_playing, "Esc to stop playback")
    assert state() == "running", "Esc was for the playback"
    yield from reaches(iterate() + 1)
    assert run().looked_at is None
    run().toggle_pause()
    paused = iterate()
    yield from scrub()
    yield from until(lambda: run().shown is run().last, "the newest iterate")
    assert iterate() == paused
    run().toggle_pause()
    yield from until(lambda: run().shown.index > paused, "the next iterate")
    assert run().shown.index == paused + 1

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


def scrub() -> Steps:
    """Drag the timeline from its middle to the left: earlier iterates are shown until the button is released."""
    timeline = next(area for area in window().screen.areas if area.type == "DOPESHEET_EDITOR")
    main = next(region for region in timeline.regions if region.type == "WINDOW")
    x, y = main.x + main.width // 2, main.y + main.height - 10
    yield from move(x, y)
    window().event_simulate(type="LEFTMOUSE", value="PRESS", x=x, y=y)
    seen = set()
    for k in range(12):
        window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x - 15 * k, y=y)
        yield
        seen.add(run().looked_at)
    assert len(seen - {None}) > 3, seen
    yield from picture("playback-0-scrubbed")
    window().event_simulate(type="LEFTMOUSE", value="RELEASE", x=x - 165, y=y)
    yield
