"""The event loop of the Relax operator, driven by a double of the operator that is fed events by hand.

Without a window Blender runs ``execute`` instead of ``invoke``; ``tests/window`` has the real thing.
"""

import time
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import add_hopf_link, add_trefoil, stored
from mobius_flow.addon.live import handlers, run
from mobius_flow.addon.live.modal import Listening
from mobius_flow.addon.live.run import RunState
from mobius_flow.addon.properties import SETTINGS
from mobius_flow.core.keys.recording import Kind
from modal_operator import keys, ring_and_torus, rings


def one():
    return [add_trefoil()]


def beside():
    ring, torus = ring_and_torus()
    collection = bpy.data.collections.new("Avoid")
    collection.objects.link(torus)
    return [ring]


@pytest.mark.parametrize(
    ("scene", "said", "operator"),
    [
        (one, "with itself", "process"),
        (rings, "with themselves and each other", "thread"),
        (beside, "proved free of contact with itself, and with 'Torus'", "thread"),
    ],
    indirect=["operator"],
)
def test_the_same_curves_as_the_headless_job(operator, scene, said):
    live = scene()
    bpy.ops.curve.mobius_flow_fit_tube()
    bpy.ops.object.duplicate()
    copies = sorted(bpy.context.selected_objects, key=lambda obj: obj.name)
    for obj in copies:
        obj.data = obj.data.copy()
    avoid = "Avoid" if scene is beside else ""
    film = {"timing": "DISTANCE", "length": 40, "radius": "keep"}
    bpy.ops.curve.mobius_flow_relax(vertices=120, avoid=avoid, **film)
    for obj in copies:
        obj.select_set(False)
    for obj in live:
        obj.select_set(True)
    operator.given |= film | {"avoid": list(bpy.data.collections["Avoid"].objects) if avoid else []}
    assert operator.start() == {"RUNNING_MODAL"}
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.report.names == tuple(obj.name for obj in live)
    assert operator.run.avoided == operator.run.report.avoided == (("Torus",) if avoid else ())
    assert operator.reports[-1][0] == {"INFO"}
    assert said in operator.reports[-1][1]
    for obj, headless in zip(live, copies, strict=True):
        np.testing.assert_array_equal(keys(obj), keys(headless))
        np.testing.assert_array_equal(stored(obj.data), stored(headless.data))
        assert obj.data.bevel_depth == headless.data.bevel_depth > 0


def test_iterates_are_taken_together_and_the_last_is_shown(operator, monkeypatch):
    obj = add_trefoil()
    monkeypatch.setattr(run.LiveRun, "slice", 60.0)
    operator.given["view_every"] = 0
    operator.start()
    operator.until(lambda: operator.run._worker._queue.qsize() > 3 or operator.run.shown is not None)
    operator.until(lambda: operator.run.last is not None and operator.run.last.index > 2)
    operator.run.toggle_pause()
    assert operator.run.shown is operator.run.last
    np.testing.assert_array_equal(stored(obj.data), operator.run.last.curve.vertices.astype(np.float32))
    operator.run.toggle_pause()
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.report.kinds[Kind.STEP] == operator.run.last.index + 1


_WHILE = 0.4  # seconds, in which a worker does many iterates


@pytest.mark.parametrize("operator", ["thread", "process"], indirect=True)
def test_a_pause_is_one_for_the_worker_too(operator):
    add_trefoil()
    operator.given |= {"view_every": 0, "method": "flow-l2", "tolerance": 1e-9, "max_iterations": 10_000}
    operator.start()
    operator.reach(3)
    operator.run.toggle_pause()
    paused, waiting = operator.run.last.index, operator.run._worker._queue
    time.sleep(_WHILE)
    ahead = waiting.qsize()
    time.sleep(_WHILE)
    assert waiting.qsize() == ahead < 40
    operator.event()
    assert operator.run.last.index == operator.run.shown.index == paused
    operator.run.toggle_pause()
    operator.until(lambda: operator.run.shown.index != paused)
    assert operator.run.shown.index == paused + 1
    operator.reach(paused + ahead + 3)


def test_enter_keeps_what_is_shown_in_a_pause(operator):
    obj = add_hopf_link()
    operator.start()
    operator.reach(2)
    operator.run.toggle_pause()
    shown = stored(obj.data)
    for _ in range(20):
        operator.event()
    np.testing.assert_array_equal(stored(obj.data), shown)
    operator.event("RET")
    assert operator.until(lambda: False) == {"FINISHED"}
    np.testing.assert_array_equal(stored(obj.data), shown)
    assert "stopped after 2 steps" in operator.run.message
    assert bpy.context.scene.frame_current_final == pytest.approx(operator.run.report.last_frame)


class Screen:
    """A 3D view beside an outliner."""

    areas = (
        SimpleNamespace(type="VIEW_3D", x=0, y=0, width=100, height=100),
        SimpleNamespace(type="OUTLINER", x=100, y=0, width=100, height=100),
    )
    is_animation_playing = False


@pytest.mark.parametrize("key", [{"kind": "ESC"}, {"kind": "Z", "ctrl": True}, {"kind": "RET"}], ids=str)
def test_keys_meant_for_something_else_pass_through(operator, key):
    """With the mouse over another editor, or to stop playback."""
    add_trefoil()
    operator.start()
    operator.reach(1)
    assert operator.event("MOUSEMOVE") == operator.event("G") == operator.event() == {"PASS_THROUGH"}
    screen = Screen()
    operator.context.window = SimpleNamespace(screen=screen)
    operator.context.workspace = SimpleNamespace(status_text_set=lambda _: None)
    assert operator.event(**key, mouse=(150, 50)) == {"PASS_THROUGH"}
    screen.is_animation_playing = True
    assert operator.event(**key, mouse=(50, 50)) == {"PASS_THROUGH"}
    assert operator.run.state is RunState.RUNNING
    screen.is_animation_playing = False
    assert operator.event(**key, mouse=(50, 50)) != {"PASS_THROUGH"}
    assert operator.run.state in (RunState.CANCELLED, RunState.FINISHING)


def test_operators_can_keep_what_they_need_in_a_window():
    """Blender makes attributes of what is annotated: a setting of the same name would take the place of another."""
    assert not set(dir(Listening)) & set(SETTINGS)


def test_the_timeline_shows_any_iterate_while_the_run_goes_on(operator, monkeypatch):
    obj, scene = add_trefoil(), bpy.context.scene
    operator.given["vertices"] = 0
    operator.start()
    operator.reach(3)
    start = operator.run.session.motion.start.vertices.astype(np.float32)

    def shows_the_last():
        np.testing.assert_array_equal(stored(obj.data), operator.run.last.curve.vertices.astype(np.float32))

    monkeypatch.setattr(run, "looks_back", lambda: True)
    with monkeypatch.context() as patch:
        patch.setattr(run, "is_rendering", lambda: True)
        handlers.HANDLERS["frame_change_post"]()
        assert operator.run.looked_at is None, "nothing moves while Blender renders"
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
    shows_the_last()
    monkeypatch.setattr(run, "looks_back", lambda: True)
    scene.frame_set(1)
    operator.event("RET")
    shows_the_last()
    operator.until(lambda: False)
    assert operator.run.report.certified
