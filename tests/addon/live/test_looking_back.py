"""A run that is paused, and one that the timeline looks back at while it goes on."""

import time

import bpy
import numpy as np
import pytest
from blender_scenes import add_trefoil, stored
from mobius_flow.addon.live import handlers, run

_WHILE = 0.4  # seconds, in which a worker does many iterates


def waiting(operator):
    """Number of iterates that have arrived and were not taken in."""
    return operator.run._worker._queue.qsize()


@pytest.mark.parametrize("in_process", [False, True])
def test_a_pause_is_one_for_the_worker_too(operator, in_process):
    add_trefoil()
    operator.in_process = in_process
    operator.given |= {"view_every": 0, "method": "flow-l2", "tolerance": 1e-9, "max_iterations": 10_000}
    operator.start()
    operator.reach(3)
    operator.run.toggle_pause()
    paused = operator.run.last.index
    time.sleep(_WHILE)
    ahead = waiting(operator)
    time.sleep(_WHILE)
    assert waiting(operator) == ahead < 40
    operator.event()
    assert operator.run.last.index == operator.run.shown.index == paused
    operator.run.toggle_pause()
    operator.until(lambda: operator.run.shown.index != paused)
    assert operator.run.shown.index == paused + 1
    operator.reach(paused + ahead + 3)
    operator.event("ESC")


def test_the_timeline_shows_any_iterate_while_the_run_goes_on(operator, monkeypatch):
    obj = add_trefoil()
    operator.given |= {"timing": "ITERATE", "vertices": 0}
    operator.start()
    operator.reach(3)
    start = operator.run._session.motion.start.vertices.astype(np.float32)

    monkeypatch.setattr(run, "looks_back", lambda: True)
    scene = bpy.context.scene
    for _ in range(3):
        scene.frame_set(1)  # the handler shows it
        np.testing.assert_array_equal(stored(obj.data), start)
        assert (operator.run.looked_at, operator.run.shown) == (0.0, None)
        operator.event()
    operator.reach(5)
    scene.frame_set(2, subframe=0.5)
    assert operator.run.looked_at == 1.5
    operator.run.toggle_pause()
    scene.frame_set(1)
    np.testing.assert_array_equal(stored(obj.data), start)

    monkeypatch.setattr(run, "looks_back", lambda: False)
    operator.event()
    assert operator.run.shown is operator.run.last
    np.testing.assert_array_equal(stored(obj.data), operator.run.last.curve.vertices.astype(np.float32))
    monkeypatch.setattr(run, "looks_back", lambda: True)
    scene.frame_set(1)
    operator.event("RET")
    np.testing.assert_array_equal(stored(obj.data), operator.run.last.curve.vertices.astype(np.float32))
    operator.until(lambda: False)
    assert operator.run.report.certified


def test_while_blender_renders_nothing_is_looked_at(operator, monkeypatch):
    add_trefoil()
    operator.start()
    operator.reach(1)
    monkeypatch.setattr(run, "looks_back", lambda: True)
    monkeypatch.setattr(run, "is_rendering", lambda: True)
    handlers.HANDLERS["frame_change_post"]()
    assert operator.run.looked_at is None
    monkeypatch.undo()
    operator.event("ESC")
