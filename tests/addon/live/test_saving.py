"""A file that is saved during a run has the curves as they were, or with all their keys: never with half of them."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_trefoil, evaluated, relax, stored
from mobius_flow.addon.curves import bake, keyframes
from mobius_flow.addon.live.run import KeyWriter, RunState
from modal_operator import everything, keys, rings, splines_of


@pytest.fixture(autouse=True)
def slowly(monkeypatch):
    """Let a key be written at a tick."""
    monkeypatch.setattr(KeyWriter, "slice", 0.0)


@pytest.fixture
def path(tmp_path):
    return str(tmp_path / "saved.blend")


def save(path):
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)


def reopen(path):
    bpy.ops.wm.open_mainfile(filepath=path)


def film():
    add_trefoil()
    relax(max_iterations=2)


@pytest.mark.parametrize("scene", [rings, film])
def test_in_mid_run_the_file_has_everything_as_it_was(operator, path, scene):
    scene()
    before, objects = everything(), bpy.context.selected_objects
    operator.given["vertices"] = 0
    operator.start()
    operator.reach(2)
    shown = [stored(obj.data) for obj in objects]
    save(path)
    for obj, points in zip(objects, shown, strict=True):
        np.testing.assert_array_equal(stored(obj.data), points)
    assert operator.event() == {"PASS_THROUGH"}, "saving does not end the run"
    operator.run.cancel()
    names = [obj.name for obj in objects]
    with bpy.data.libraries.load(path) as (_, loaded):
        loaded.objects = list(names)
    for obj, name in zip(loaded.objects, names, strict=True):
        assert splines_of(obj.data) == before["all"][name], "also where the extension is not"
    reopen(path)
    assert everything() == before


def test_keys_whose_writing_has_begun_are_all_in_the_file(operator, path):
    before = {obj.name: stored(obj.data) for obj in rings()}
    operator.given["fit_bevel"] = False
    operator.start()
    operator.until(lambda: bpy.data.objects["A"].data.shape_keys is not None)
    assert bpy.data.objects["B"].data.shape_keys is None, "saved in the middle"
    save(path)
    assert operator.run.state is RunState.DONE
    assert operator.event() == {"FINISHED"}, "the operator ends, and with it comes one undo step"
    assert operator.reports[-1][0] == {"INFO"}
    frames = 1, operator.run.report.last_frame
    written = {name: keys(bpy.data.objects[name]) for name in before}
    assert len(written["A"]) == len(written["B"]) == operator.run.report.keys
    played = {name: [evaluated(bpy.data.objects[name], frame) for frame in frames] for name in before}

    reopen(path)
    for name in before:
        obj = bpy.data.objects[name]
        np.testing.assert_array_equal(keys(obj), written[name])
        for frame, points in zip(frames, played[name], strict=True):
            np.testing.assert_array_equal(evaluated(obj, frame), points)
        assert bake.is_baked(obj.data)
        assert not bake.is_edited(obj.data)
        obj.select_set(True)
        bpy.context.view_layer.objects.active = obj
    assert bpy.ops.curve.mobius_flow_clear() == {"FINISHED"}
    for name, points in before.items():
        np.testing.assert_array_equal(stored(bpy.data.objects[name].data), points)


def test_keys_that_are_still_being_proved_are_not_in_the_file(operator, path, monkeypatch):
    obj = add_trefoil()
    before = everything()
    operator.start()
    operator.reach(2)
    operator.event("RET")
    monkeypatch.setattr(operator.run._keys._thread, "is_alive", lambda: True)
    shown = stored(obj.data)
    save(path)
    assert operator.run.state is RunState.FINISHING
    np.testing.assert_array_equal(stored(obj.data), shown)
    monkeypatch.undo()
    operator.run.cancel()
    reopen(path)
    assert everything() == before


def test_baked_again_the_file_has_the_old_keys_or_the_new_ones(operator, path):
    film()
    old = keys(bpy.context.object)
    operator.start()
    operator.until(lambda: len(bpy.data.shape_keys) == 2)
    save(path)
    assert operator.event() == {"FINISHED"}
    new = keys(bpy.context.object)
    assert len(new) != len(old)
    reopen(path)
    (obj,) = bpy.data.objects
    np.testing.assert_array_equal(keys(obj), new)
    assert bake.is_baked(obj.data)
    assert len(bpy.data.shape_keys) == len(bpy.data.actions) == 1


def test_a_failure_while_saving_puts_everything_back(operator, path, monkeypatch):
    obj = add_trefoil()
    before, written = everything(), keyframes.writing

    def failing(*arguments):
        yield from written(*arguments)
        raise MemoryError

    monkeypatch.setattr(keyframes, "writing", failing)
    operator.start()
    operator.until(lambda: obj.data.shape_keys is not None)
    save(path)
    assert operator.run.state is RunState.CANCELLED
    assert operator.event() == {"CANCELLED"}
    assert operator.reports[-1] == ({"ERROR"}, "Memory ran out; all is as it was")
    reopen(path)
    assert everything() == before


@pytest.mark.parametrize("scene", [add_trefoil, film])
def test_a_file_saved_automatically_has_the_curve_once_it_is_opened(operator, path, monkeypatch, scene):
    """Blender tells nobody of it; a copy that somebody has made of the preview meanwhile is theirs."""
    scene()
    obj = bpy.context.object
    before, name, baked = stored(obj.data), obj.data.name, bake.is_baked(obj.data)
    operator.start()
    operator.reach(2)
    copy = obj.copy()
    copy.data = obj.data.copy()
    bpy.context.scene.collection.objects.link(copy)
    shown = stored(copy.data)
    assert not np.array_equal(shown, before)
    monkeypatch.setattr(operator.run.session, "hide", lambda: None)
    save(path)
    operator.run.cancel()
    reopen(path)
    obj, copied = (bpy.data.objects[each] for each in ("Knot", "Knot.001"))
    assert obj.data.name == name
    np.testing.assert_array_equal(stored(obj.data), before)
    assert bake.is_baked(obj.data) == baked
    np.testing.assert_array_equal(stored(copied.data), shown)
