"""The event loop of the Relax operator, driven by a double of the operator that is fed events by hand.

Without a window Blender runs ``execute`` instead of ``invoke``; ``tests/window`` has the real thing.
"""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_hopf_link, add_trefoil, stored
from mobius_flow.addon.curves.splines import Splines
from mobius_flow.addon.live.modal import Listening
from mobius_flow.addon.live.run import RunState
from mobius_flow.addon.properties import SETTINGS
from mobius_flow.core import Curve, minimize
from modal_operator import Operator, keys, restored
from shapes import lattice_knot, torus_trefoil


@pytest.mark.parametrize("operator", ["process"], indirect=True)
def test_the_same_curve_as_the_headless_job(operator):
    live = add_trefoil()
    bpy.ops.curve.mobius_flow_fit_tube()
    live.select_set(False)
    headless = add_trefoil()
    bpy.ops.curve.mobius_flow_fit_tube()
    bpy.ops.curve.mobius_flow_relax(vertices=120, timing="DISTANCE")
    headless.select_set(False)
    live.select_set(True)
    assert operator.start() == {"RUNNING_MODAL"}
    assert operator.until(lambda: False) == {"FINISHED"}
    np.testing.assert_array_equal(keys(live), keys(headless))
    np.testing.assert_array_equal(stored(live.data), stored(headless.data))
    assert live.data.bevel_depth == headless.data.bevel_depth > 0
    assert operator.reports[-1][0] == {"INFO"}


@pytest.mark.slow
def test_points_that_are_added_in_the_end_are_in_every_key(operator):
    obj = add_curve([lattice_knot("5_1").vertices])
    start = stored(obj.data).astype(np.float64)
    operator.given["vertices"] = 0
    operator.start()
    operator.reach(1)
    given = len(obj.data.splines[0].points)
    assert operator.until(lambda: False) == {"FINISHED"}
    result = minimize(Curve(start))
    assert given < len(result.curve)
    assert keys(obj).shape[1] == len(result.curve)
    np.testing.assert_array_equal(stored(obj.data), result.curve.vertices.astype(np.float32))
    assert operator.run.report.certified


def test_esc_restores_what_has_got_more_points_meanwhile(operator):
    obj = add_curve([lattice_knot("5_1").vertices])
    before = Splines.of(obj.data)
    operator.given |= {"vertices": 0, "tolerance": 1e-3}
    operator.start()
    operator.reach(1)
    given = len(obj.data.splines[0].points)
    operator.until(lambda: len(obj.data.splines[0].points) > given)
    assert operator.event("ESC") == {"CANCELLED"}
    restored(obj, before)


@pytest.mark.parametrize("kind", ["POLY", pytest.param("BEZIER", marks=pytest.mark.slow), "NURBS"])
def test_esc_restores_bit_for_bit(operator, kind):
    rng = np.random.default_rng(7)
    obj = add_curve([torus_trefoil(24).vertices + 3 * k for k in (0, 4)], kind=kind)
    for spline in obj.data.splines:
        for point in spline.bezier_points if kind == "BEZIER" else spline.points:
            point.radius, point.tilt = rng.random(2)
    obj.data.splines[1].material_index, obj.data.splines[0].use_smooth = 2, False
    before = Splines.of(obj.data)
    operator.given["vertices"] = 0
    operator.start()
    operator.reach(2)
    assert obj.data.splines[0].type == "POLY"
    assert operator.event("ESC") == {"CANCELLED"}
    restored(obj, before)
    assert operator.run.state is RunState.CANCELLED


def test_every_iterate_is_shown(operator):
    obj = add_trefoil()
    operator.start()
    shown = []
    operator.until(lambda: operator.run.last is not None and shown.append(operator.run.last.index))
    assert sorted(set(shown)) == list(range(operator.run.last.index + 1))
    assert obj.data.shape_keys is not None


def test_pause_and_enter_keep_what_is_shown(operator):
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


def test_undo_key_is_esc(operator):
    obj = add_trefoil()
    before = Splines.of(obj.data)
    operator.start()
    operator.reach(1)
    assert operator.event("Z", ctrl=True) == {"CANCELLED"}
    restored(obj, before)


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


def test_other_events_pass_through(operator):
    add_trefoil()
    operator.start()
    assert operator.event("MOUSEMOVE") == operator.event("G") == operator.event() == {"PASS_THROUGH"}


def test_another_object_has_to_wait(operator):
    obj = add_trefoil()
    before = Splines.of(obj.data)
    operator.start()
    operator.reach(1)
    other = add_hopf_link()
    untouched = Splines.of(other.data)
    second = Operator()
    assert second.start() == {"CANCELLED"}
    assert second.reports == [({"ERROR"}, f"'{obj.name}' is being relaxed; stop that first")]
    operator.event("ESC")
    restored(obj, before)
    restored(other, untouched)


def test_a_bad_curve_is_refused_untouched(operator):
    points = torus_trefoil(30).vertices.copy()
    points[3] = points[2]
    obj = add_curve([points])
    before = Splines.of(obj.data)
    operator.start()
    assert operator.until(lambda: False) == {"CANCELLED"}
    assert operator.reports[-1][0] == {"ERROR"}
    restored(obj, before)


def test_deletion(operator):
    obj = add_trefoil()
    data, before = obj.data, stored(obj.data)
    operator.start()
    operator.reach(1)
    bpy.data.objects.remove(obj)
    assert operator.event() == {"CANCELLED"}
    assert operator.run.state is RunState.LOST
    np.testing.assert_array_equal(stored(data), before)


def test_a_new_name_does_not_matter(operator):
    obj = add_trefoil()
    operator.start()
    operator.reach(1)
    obj.name, obj.data.name = "Other", "Other"
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.report.names == ("Other",)
    assert obj.data.name == "Other", "it was given to a stand-in"
    operator.start()
    operator.reach(1)
    obj.data.name = "Another"
    operator.run.cancel()
    assert obj.data.name == "Another"


def test_topology_change_leaves_what_somebody_made(operator):
    obj = add_trefoil()
    operator.start()
    operator.reach(1)
    obj.data.splines[0].points.add(1)
    count = len(obj.data.splines[0].points)
    assert operator.event() == {"CANCELLED"}
    assert len(obj.data.splines[0].points) == count


def test_shape_keys_of_somebody_else_are_left_alone(operator):
    obj = add_trefoil()
    operator.start()
    operator.reach(1)
    obj.shape_key_add(name="Mine")
    shown, key = stored(obj.data), keys(obj)
    assert operator.event() == {"CANCELLED"}
    assert operator.run.state is RunState.LOST
    np.testing.assert_array_equal(stored(obj.data), shown)
    np.testing.assert_array_equal(keys(obj), key)


def test_edit_mode(operator):
    obj = add_trefoil()
    before = Splines.of(obj.data)
    operator.start()
    operator.reach(1)
    bpy.ops.object.mode_set(mode="EDIT")
    assert operator.event() == {"CANCELLED"}
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    restored(obj, before)


@pytest.mark.parametrize("operator", ["process"], indirect=True)
def test_loading_a_file(operator):
    add_trefoil()
    operator.start()
    operator.reach(1)
    bpy.ops.wm.read_homefile(use_empty=True)
    assert operator.run.state is RunState.CANCELLED
    assert operator.run._worker.process.poll() is not None
    operator.cancel(operator.context)


def test_disabling_ends_the_run(operator, addon):
    obj = add_trefoil()
    before = Splines.of(obj.data)
    operator.start()
    operator.reach(1)
    addon.unregister()
    addon.register()
    assert operator.run.state is RunState.CANCELLED
    restored(obj, before)


@pytest.mark.parametrize("operator", ["process"], indirect=True)
def test_a_worker_that_dies_loses_nothing(operator):
    obj = add_trefoil()
    operator.given["vertices"] = 400
    operator.start()
    operator.reach(1)
    operator.run._worker.process.kill()
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.failed
    assert operator.reports[-1][0] == {"WARNING"}
    assert obj.data.shape_keys is not None


def test_operators_can_keep_what_they_need_in_a_window():
    """Blender makes attributes of what is annotated: a setting of the same name would take the place of another."""
    for name in dir(Listening):
        assert name not in SETTINGS, name
