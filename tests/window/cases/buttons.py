"""Relax, Pause, Resume and Keep by mouse clicks; the curve moves; undo takes it all back at once."""

import numpy as np
from case import Steps, picture, until
from hands import button, key
from scene import endless, is_, iterate, look, obj, points, reaches, ready, run, state


def case() -> Steps:
    yield from ready()
    endless()
    before = points()
    yield from picture("buttons-1-ready")
    yield from button("curve.mobius_flow_relax")
    yield from reaches(3)
    moved = points()
    assert moved.shape != before.shape, "the curve is refined and moves"
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
    assert run() is None
    yield from look()
    yield from picture("buttons-4-stopped", differs_from="buttons-1-ready")
    assert obj().data.shape_keys is not None
    yield from key("Z", ctrl=True)
    yield from until(lambda: len(points()) == len(before), "undo")
    assert np.array_equal(points(), before)
    assert obj().data.shape_keys is None
    assert state() == "done"
    yield from picture("buttons-5-undone")
