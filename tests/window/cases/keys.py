"""Esc restores bit for bit, Enter keeps what is shown; both act at once. Undo takes a run back in one step."""

import time

import numpy as np
from case import Steps, picture, until
from hands import button, key
from scene import is_, iterate, obj, points, reaches, ready, run, seen, state


def case() -> Steps:
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
    shown, index = seen(), iterate()
    yield from key("RET")
    yield from is_("done")
    assert iterate() == index
    yield
    assert np.allclose(seen(), shown, rtol=0, atol=1e-5), "Enter keeps what is shown"
    last = obj().data.shape_keys.key_blocks[-1]
    assert np.array_equal(np.array([p.co[:] for p in last.data], dtype=np.float32), points()[:, :3])
    assert abs(obj().data.shape_keys.eval_time - index) < 1e-4, "the frame is the one of the shape that was kept"
    yield from picture("keys-2-enter")
    yield from key("Z", ctrl=True)
    yield from until(lambda: len(points()) == len(before), "undo")
    assert np.array_equal(points(), before)
    yield from picture("keys-3-undone")
