"""A baked curve that is relaxed again in a window: whatever ends the run, the curve with its keys is there again."""

import gc

import bpy
import numpy as np
import pytest
from blender_scenes import add_trefoil, contents, evaluated, relax, stored
from mobius_flow.addon.curves.splines import Splines
from mobius_flow.addon.live import handlers, registry, run
from mobius_flow.core.keys.motion import Kind
from modal_operator import restored


@pytest.fixture(params=["SHAPE_KEYS", pytest.param("FCURVES", marks=pytest.mark.slow)])
def baked(request):
    """A baked trefoil, drawn at its first frame."""
    obj = add_trefoil()
    relax(max_iterations=3, keyframes=request.param)
    bpy.context.scene.frame_set(1)
    return obj


def everything():
    """All names and curves, and which of them would be purged."""
    users = {data.name: (data.users, data.use_fake_user) for data in bpy.data.curves}
    return contents(), users, sorted(keys.name for keys in bpy.data.shape_keys)


@pytest.mark.parametrize("continues", [False, True])
@pytest.mark.parametrize("key", ["ESC", "Z"])
def test_esc_gives_the_baked_curve_back(operator, baked, continues, key):
    before, data, shown = everything(), baked.data, evaluated(baked, 3)
    bpy.context.scene.frame_set(1)
    operator.continues, operator.given["vertices"] = continues, 0
    operator.start()
    assert baked.data != data
    operator.reach(2)
    assert operator.event(key, ctrl=key == "Z") == {"CANCELLED"}
    assert baked.data == data
    assert everything() == before
    np.testing.assert_array_equal(evaluated(baked, 3), shown)


@pytest.mark.parametrize("continues", [False, True])
def test_to_the_end(operator, baked, continues):
    names = everything()[1:]
    count = len(baked.data.splines[0].points)
    operator.continues, operator.given["vertices"] = continues, 0
    operator.given["keyframes"] = "SHAPE_KEYS" if baked.data.shape_keys else "FCURVES"
    operator.start()
    assert operator.until(lambda: False) == {"FINISHED"}
    assert everything()[1:] == names
    assert len(baked.data.splines[0].points) == count
    assert bpy.ops.curve.mobius_flow_clear() == {"FINISHED"}
    assert len(baked.data.splines[0].points) == 30


def test_it_begins_from_the_original_or_from_the_end(operator, baked):
    end = evaluated(baked, 4)
    bpy.context.scene.frame_set(2)
    operator.given["vertices"], operator.continues = 0, True
    operator.start()
    np.testing.assert_array_equal(stored(baked.data), end)
    operator.run.cancel()
    operator.continues = False
    operator.start()
    assert len(stored(baked.data)) == 30


def test_what_is_set_aside_is_not_purged(operator, baked):
    data = baked.data
    operator.given["vertices"] = 0
    operator.start()
    operator.reach(1)
    bpy.ops.outliner.orphans_purge(do_recursive=True)
    gc.collect()
    assert operator.event("ESC") == {"CANCELLED"}
    assert baked.data == data


def test_a_saved_file_has_the_baked_curve(operator, baked, tmp_path):
    data, before = baked.data, everything()
    operator.given["vertices"] = 0
    operator.start()
    operator.reach(1)
    preview, shown = baked.data, stored(baked.data)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"), copy=True)
    assert baked.data == preview
    np.testing.assert_array_equal(stored(baked.data), shown)
    operator.event("ESC")
    assert baked.data == data
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    assert everything() == before


def test_edit_mode_gives_the_baked_curve_back(operator, baked):
    data = baked.data
    operator.given["vertices"] = 0
    operator.start()
    operator.reach(1)
    bpy.ops.object.mode_set(mode="EDIT")
    assert operator.event() == {"CANCELLED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert baked.data == data


def recover():
    return bpy.ops.curve.mobius_flow_recover()


@pytest.mark.parametrize("add", [lambda: None, lambda: relax(max_iterations=2)])
def test_a_cancelled_run_is_recovered(operator, add):
    obj = add_trefoil()
    add()
    operator.given |= {"vertices": 0, "fit_bevel": False}
    operator.start()
    operator.reach(3)
    last = operator.run.last.curve.vertices.astype(np.float32)
    assert operator.event("ESC") == {"CANCELLED"}
    assert recover() == {"FINISHED"}
    np.testing.assert_array_equal(evaluated(obj, 250), last)
    assert operator.run.report.certified
    assert operator.run.report.kinds[Kind.STEP] == operator.run.last.index + 1
    with pytest.raises(RuntimeError, match="No relaxation was cancelled"):
        recover()
    assert bpy.ops.curve.mobius_flow_clear() == {"FINISHED"}
    assert len(stored(obj.data)) == 30


def test_what_has_changed_is_not_recovered(operator):
    obj = add_trefoil()
    operator.start()
    operator.reach(1)
    operator.event("ESC")
    obj.data.splines[0].points[3].co[1] += 0.25
    before = contents()
    with pytest.raises(RuntimeError, match="'Knot' changed since the relaxation ended; relax anew"):
        recover()
    assert contents() == before
    bpy.data.objects.remove(obj)
    with pytest.raises(RuntimeError, match="'Knot' changed since the relaxation ended; relax anew"):
        recover()


def test_undo_of_something_else_does_not_end_a_run(operator):
    """Blender runs no undo without a window; the handlers are called as it would call them."""
    obj = add_trefoil()
    before = Splines.of(obj.data)
    operator.start()
    operator.reach(2)
    registry.history.others = 2
    assert operator.event("Z", ctrl=True) == {"PASS_THROUGH"}
    handlers.HANDLERS["undo_pre"]()
    restored(obj, before)
    shown = operator.run.shown.curve.vertices.astype(np.float32)
    handlers.HANDLERS["undo_post"]()
    np.testing.assert_array_equal(stored(obj.data), shown)
    operator.reach(operator.run.last.index + 1)
    for name in ("redo_pre", "redo_post", "undo_pre", "undo_post"):
        handlers.HANDLERS[name]()
    assert (registry.history.others, registry.history.undone) == (1, 1)
    registry.history.others = 0
    handlers.HANDLERS["undo_pre"]()
    assert registry.current() is None
    restored(obj, before)


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
