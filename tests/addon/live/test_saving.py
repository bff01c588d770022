"""A file that is saved during a run has the curves as they were, or with all their keys: never with half of them."""

import bpy
import numpy as np
import pytest
from baked_curves import two_rings
from blender_scenes import add_trefoil, evaluated, relax, stored
from mobius_flow.addon.curves import bake, keyframes
from mobius_flow.addon.live.run import KeyWriter, RunState
from modal_operator import keys


@pytest.fixture(autouse=True)
def slowly(monkeypatch):
    """Let a key be written at a tick."""
    monkeypatch.setattr(KeyWriter, "slice", 0.0)


def save(path):
    bpy.ops.wm.save_as_mainfile(filepath=str(path / "saved.blend"), copy=True)


def reopen(path):
    bpy.ops.wm.open_mainfile(filepath=str(path / "saved.blend"))


def test_keys_whose_writing_has_begun_are_all_in_the_file(operator, tmp_path):
    for obj in two_rings():
        obj.select_set(True)
    before = {obj.name: stored(obj.data) for obj in bpy.context.selected_objects}
    operator.start()
    operator.until(lambda: bpy.data.objects["A"].data.shape_keys is not None)
    assert bpy.data.objects["B"].data.shape_keys is None, "saved in the middle"
    save(tmp_path)
    assert operator.run.state is RunState.DONE
    assert operator.event() == {"FINISHED"}, "the operator ends, and with it comes one undo step"
    assert operator.reports[-1][0] == {"INFO"}
    written = {name: keys(bpy.data.objects[name]) for name in before}
    assert len(written["A"]) == len(written["B"]) == operator.run.report.keys

    reopen(tmp_path)
    for name in before:
        obj = bpy.data.objects[name]
        np.testing.assert_array_equal(keys(obj), written[name])
        assert bake.is_baked(obj.data)
        assert not bake.is_edited(obj.data)
        obj.select_set(True)
        bpy.context.view_layer.objects.active = obj
    assert bpy.ops.curve.mobius_flow_clear() == {"FINISHED"}
    for name, points in before.items():
        np.testing.assert_array_equal(stored(bpy.data.objects[name].data), points)


def test_keys_that_are_still_being_proved_are_not_in_the_file(operator, tmp_path, monkeypatch):
    obj = add_trefoil()
    before = stored(obj.data)
    operator.start()
    operator.reach(2)
    operator.event("RET")
    monkeypatch.setattr(operator.run._keys._thread, "is_alive", lambda: True)
    shown = stored(obj.data)
    save(tmp_path)
    assert operator.run.state is RunState.FINISHING
    np.testing.assert_array_equal(stored(obj.data), shown)
    monkeypatch.undo()
    operator.run.cancel()
    reopen(tmp_path)
    (obj,) = bpy.data.objects
    np.testing.assert_array_equal(stored(obj.data), before)
    assert obj.data.shape_keys is None
    assert obj.data.animation_data is None


def test_baked_again_the_file_has_the_old_keys_or_the_new_ones(operator, tmp_path):
    add_trefoil()
    old = keys(relax(max_iterations=2))
    operator.start()
    operator.until(lambda: len(bpy.data.shape_keys) == 2)
    save(tmp_path)
    assert operator.event() == {"FINISHED"}
    new = keys(bpy.context.object)
    assert len(new) != len(old)
    reopen(tmp_path)
    (obj,) = bpy.data.objects
    np.testing.assert_array_equal(keys(obj), new)
    assert bake.is_baked(obj.data)
    assert len(bpy.data.shape_keys) == len(bpy.data.actions) == 1


def test_a_failure_while_saving_puts_everything_back(operator, tmp_path, monkeypatch):
    obj = add_trefoil()
    before = stored(obj.data)
    written = keyframes.writing

    def failing(*arguments):
        yield from written(*arguments)
        raise MemoryError

    monkeypatch.setattr(keyframes, "writing", failing)
    operator.start()
    operator.until(lambda: obj.data.shape_keys is not None)
    save(tmp_path)
    assert operator.run.state is RunState.CANCELLED
    assert operator.event() == {"CANCELLED"}
    assert operator.reports[-1] == ({"ERROR"}, "Memory ran out; all is as it was")
    reopen(tmp_path)
    (obj,) = bpy.data.objects
    np.testing.assert_array_equal(stored(obj.data), before)
    assert obj.data.shape_keys is None


def test_the_saved_animation_plays(operator, tmp_path):
    obj = add_trefoil()
    operator.given["fit_bevel"] = False
    operator.start()
    operator.until(lambda: obj.data.shape_keys is not None)
    save(tmp_path)
    operator.event()
    last = operator.run.report.last_frame
    wanted = [evaluated(obj, frame) for frame in (1, last)]
    reopen(tmp_path)
    (obj,) = bpy.data.objects
    for frame, points in zip((1, last), wanted, strict=True):
        np.testing.assert_array_equal(evaluated(obj, frame), points)


@pytest.mark.parametrize("baked", [False, True])
def test_a_file_saved_automatically_has_the_curve_once_it_is_opened(operator, tmp_path, monkeypatch, baked):
    """Blender tells nobody of it; a copy that somebody has made of the preview meanwhile is theirs."""
    obj = add_trefoil()
    if baked:
        relax(max_iterations=2)
    before, name = stored(obj.data), obj.data.name
    operator.start()
    operator.reach(2)
    copy = obj.copy()
    copy.data = obj.data.copy()
    bpy.context.scene.collection.objects.link(copy)
    shown = stored(copy.data)
    assert not np.array_equal(shown, before)
    monkeypatch.setattr(operator.run.group, "hide", lambda: None)
    save(tmp_path)
    operator.run.cancel()
    reopen(tmp_path)
    obj, copied = (bpy.data.objects[each] for each in ("Knot", "Knot.001"))
    assert obj.data.name == name
    np.testing.assert_array_equal(stored(obj.data), before)
    assert bake.is_baked(obj.data) == baked
    np.testing.assert_array_equal(stored(copied.data), shown)
