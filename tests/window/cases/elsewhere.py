"""What else Blender does meanwhile: playback, renders, other windows; and how long it is blocked."""

import time
from collections.abc import Callable

import bpy
import numpy as np
from case import Steps, picture, until
from hands import addon, button, here, key, move, window
from interruption import is_whole, over, relax
from scene import is_, iterate, latest, obj, points, reaches, ready, run, state, steps

TICK, REACTION = 0.05, 0.2  # seconds for which a tick, and Stop or Esc, may block the window


def playback() -> Steps:
    """Esc and Enter are for the run only over a 3D view and without playback; Cancel is there at any time."""
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
    for name in ("ESC", "RETURN"):
        yield from key(name, over=(outliner.x + outliner.width // 2, outliner.y + outliner.height // 2))
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


def rendering() -> Steps:
    """While Blender renders nothing moves, so that the picture is of one shape; then the run goes on."""
    yield from ready(vertices=1200)
    window().scene.mobius_flow.tolerance = 1e-7  # it takes longer than rendering
    before, knot = points(), obj()
    camera()
    window().view_layer.objects.active = knot
    yield from relax()
    yield from key("F12")
    yield from until(lambda: bpy.app.is_job_running("RENDER"), "the render to start")
    index, shown, looks = run().last.index, points(), 0
    yield from picture("rendering-1-rendering")
    while bpy.app.is_job_running("RENDER"):
        assert run().last.index == index
        assert np.array_equal(points(), shown)
        looks += 1
        yield
    print("MEASURED looks at a curve being rendered:", looks, flush=True)
    assert looks > 1
    yield from reaches(index + 2)
    yield from picture("rendering-2-goes-on")

    yield from key("F12")
    yield from until(lambda: bpy.app.is_job_running("RENDER"), "the render to start again")
    yield from key("ESC")
    yield from until(lambda: not bpy.app.is_job_running("RENDER"), "Esc to end the render", 200)
    assert state() == "running", f"Esc was for the render: {state()}"
    yield from reaches(run().last.index + 1)
    yield from key("ESC")
    yield from over("Esc after rendering")
    is_whole(before)


def camera() -> None:
    """A camera that sees the knot; a render of some seconds that opens no window."""
    scene = window().scene
    bpy.context.preferences.view.render_display_type = "NONE"
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 64, False  # not every build can denoise
    scene.render.resolution_percentage = 50
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.camera.location.z = 9.0
    scene.collection.objects.link(scene.camera)


def windows() -> Steps:
    """A run that was started in another window than is closed goes on, one that was started in it ends."""
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


def opened() -> bpy.types.Window:
    """A second window."""
    bpy.ops.wm.window_new()
    return bpy.context.window_manager.windows[-1]


def close(other: bpy.types.Window) -> None:
    with bpy.context.temp_override(window=other):
        bpy.ops.wm.window_close()


def timing() -> Steps:
    """How long the window is blocked; ticks count as processor time, as other programs may hold one up."""
    loop = addon("live.modal").Loop
    original: Callable[..., set[str]] = loop.handle
    for vertices, shown in ((600, 40), (2000, 8)):
        yield from ready(vertices=vertices)
        ticks: list[tuple[float, float]] = []

        def handle(*given: object, ticks: list[tuple[float, float]] = ticks) -> set[str]:
            busy, started = time.thread_time(), time.perf_counter()
            result = original(*given)
            ticks.append((time.thread_time() - busy, time.perf_counter() - started))
            return result

        loop.handle = handle
        start()
        yield from reaches(shown)
        stop = took(run().keep)
        yield from is_("done")
        loop.handle = original
        clock = sorted(wall for _, wall in ticks)
        assert max(ticks)[0] < TICK
        assert clock[-1 - len(clock) // 100] < TICK, "but for one in a hundred by the clock"
        with here():
            bpy.ops.ed.undo()
        yield
        start()
        yield from reaches(2)
        esc = took(run().cancel)
        print(
            f"MEASURED {vertices} points: longest of {len(ticks)} ticks {1e3 * max(ticks)[0]:.1f} ms, by the clock "
            f"{1e3 * clock[-1]:.1f} ms; Stop {1e3 * stop:.1f} ms, Esc {1e3 * esc:.1f} ms",
            flush=True,
        )
        assert max(stop, esc) < REACTION
        yield from until(lambda: run() is None, "Esc")
    yield from ready("7_4", vertices=0)
    started = time.perf_counter()
    yield from button("curve.mobius_flow_relax")
    yield from is_("done")
    count = latest().last.index
    print(f"MEASURED 7_4 in a window: {time.perf_counter() - started:.1f} s for {count} iterates", flush=True)
    assert len(steps()) == count + 1, "all iterates are recorded, though some are shown"


def start() -> None:
    with here():
        assert bpy.ops.curve.mobius_flow_relax("INVOKE_DEFAULT", again=True) == {"RUNNING_MODAL"}


def took(act: Callable[[], object]) -> float:
    """For how long something blocks."""
    started = time.perf_counter()
    act()
    return time.perf_counter() - started


PARTS = (playback, rendering, windows, timing)
