"""Relax, Pause, Keep, Cancel, Recover, Continue and Clear by mouse and keys; each is one undo step."""

import time
from collections.abc import Generator

import bpy
import numpy as np
from case import Steps, picture, until
from hands import button, click, entry, found, key, window
from scene import endless, in_world, is_, iterate, keys, look, obj, points, reaches, ready, run, state, steps, undone


def buttons() -> Steps:
    """The curve moves, stands still, moves on and is kept; undo takes it all back at once."""
    yield from ready()
    endless()
    before = points()
    yield from picture("buttons-1-ready")
    yield from button("curve.mobius_flow_relax")
    yield from reaches(3)
    assert points().shape != before.shape, "the curve is refined and moves"
    yield from picture("buttons-2-running")
    yield from button("curve.mobius_flow_pause")
    yield from is_("paused")
    still, index = points(), iterate()
    yield from picture("buttons-3-paused", differs_from="buttons-1-ready")
    assert iterate() == index
    assert np.array_equal(points(), still)
    yield from button("curve.mobius_flow_pause")
    yield from reaches(index + 2)
    yield from button("curve.mobius_flow_stop")
    assert not np.array_equal(points(), still)
    yield from is_("done")
    yield from look()
    yield from picture("buttons-4-stopped", differs_from="buttons-1-ready")
    assert obj().data.shape_keys is not None
    yield from undone(lambda: len(points()) == len(before), "the run")
    assert np.array_equal(points(), before)
    assert obj().data.shape_keys is None
    assert state() == "done"
    yield from picture("buttons-5-undone")


def esc_and_enter() -> Steps:
    """Esc restores bit for bit, Enter keeps what is shown; both act at once."""
    yield from ready()
    before = points()
    yield from button("curve.mobius_flow_relax")
    yield from reaches(3)
    started = time.perf_counter()
    yield from key("ESC")
    yield from until(lambda: run() is None, "Esc")
    print(f"MEASURED Esc, with its mouse movement: {time.perf_counter() - started:.3f} s")
    assert state() == "cancelled"
    assert np.array_equal(points(), before)
    yield from picture("keys-1-esc")

    yield from button("curve.mobius_flow_relax")
    yield from reaches(3)
    run().toggle_pause()
    yield
    shown, index = in_world(), iterate()
    yield from key("RET")
    yield from is_("done")
    assert iterate() == index
    yield
    assert np.allclose(in_world(), shown, rtol=0, atol=1e-5), "Enter keeps what is shown"
    assert np.array_equal(keys()[-1], points()[:, :3])
    assert abs(obj().data.shape_keys.eval_time - len(keys()) + 1) < 1e-4, (
        "the frame is the one of the shape that was kept"
    )
    yield from picture("keys-2-enter")
    yield from undone(lambda: len(points()) == len(before), "the run")
    assert np.array_equal(points(), before)


def baked() -> Steps:
    """Relax twice, Cancel, Recover, Continue, Set Scene Range and Clear, and all of it undone step by step."""
    yield from ready()
    before = points()
    yield from pressed("curve.mobius_flow_relax", "baking-1-relaxed")
    first = steps()

    yield from asked("baking-2-asked")
    yield from key("ESC")
    assert same(steps(), first), "nothing begins before the answer"
    where = yield from asked("baking-2-asked-again")
    yield from entry("again=True", *where)
    yield from reaches(3)
    run().toggle_pause()  # finding a button takes a while
    assert obj().data.shape_keys is None, "the original stands in for the baked curve"
    yield from picture("baking-3-relaxed-again", differs_from="baking-1-relaxed")
    yield from button("curve.mobius_flow_cancel")
    yield from is_("cancelled")
    assert same(steps(), first), "the baked curve is there again"
    yield from picture("baking-4-cancelled", differs_from="baking-3-relaxed-again")

    yield from button("curve.mobius_flow_recover")
    yield from is_("done")
    recovered = steps()
    assert len(recovered) < len(first)
    assert same(recovered, first[: len(recovered)]), "what had been reached when it was cancelled"
    yield from picture("baking-5-recovered", differs_from="baking-4-cancelled")

    where = yield from asked("baking-6-asked")
    yield from entry("curve.mobius_flow_continue", *where)
    yield from until(lambda: run() is not None, "Continue to begin")
    yield from is_("done")
    assert len(steps()) > len(recovered)
    assert same(steps()[: len(recovered)], recovered), "new keys follow the old ones"
    yield from button("curve.mobius_flow_scene_range")
    assert window().scene.frame_start == 1
    assert 250 < window().scene.frame_end <= 500
    yield from picture("baking-7-scene-range")

    yield from button("curve.mobius_flow_clear")
    yield from until(lambda: obj().data.shape_keys is None, "Clear")
    assert np.array_equal(points(), before)
    assert not bpy.data.actions
    assert not bpy.data.shape_keys
    yield from look()
    yield from picture("baking-8-cleared", differs_from="baking-7-scene-range")

    yield from undone(lambda: same(steps()[: len(recovered)], recovered), "Clear")
    yield from undone(lambda: window().scene.frame_end == 250, "Set Scene Range")
    yield from undone(lambda: same(steps(), recovered), "Continue")
    yield from undone(lambda: same(steps(), first), "Recover")
    yield from undone(lambda: obj().data.shape_keys is None, "Relax")
    assert np.array_equal(points(), before)
    yield from picture("baking-9-undone")


PARTS = (buttons, esc_and_enter, baked)


def pressed(operator: str, name: str) -> Steps:
    """Press a button and wait until all is done."""
    yield from button(operator)
    yield from until(lambda: run() is not None, f"{operator} to begin")
    yield from is_("done")
    yield from look()
    yield from picture(name)


def asked(name: str) -> Generator[None, None, tuple[int, range]]:
    """Press Relax, and have a picture of the question; where its answers are."""
    x, y = yield from found("curve.mobius_flow_relax")
    yield from click(x, y)
    yield from picture(name)
    assert run() is None, "nothing begins before the answer"
    return x, range(y + 60, y - 100, -6)


def same(some: list[np.ndarray], others: list[np.ndarray]) -> bool:
    """Whether keys are the same, bit for bit."""
    return len(some) == len(others) and all(map(np.array_equal, some, others))
