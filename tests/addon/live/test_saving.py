"""A file that is saved during a run has the curves as they were."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_trefoil, relax, stored
from mobius_flow.addon.curves import bake
from mobius_flow.addon.live.run import RunState
from modal_operator import everything, rings, splines_of


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


def test_keys_that_are_still_being_proved_are_not_in_the_file(operator, path, monkeypatch):
    obj = add_trefoil()
    before = everything()
    operator.start()
    operator.reach(2)
    operator.event("RET")
    monkeypatch.setattr(operator.run._keys, "done", lambda: False)
    shown = stored(obj.data)
    save(path)
    assert operator.run.state is RunState.FINISHING
    np.testing.assert_array_equal(stored(obj.data), shown)
    monkeypatch.undo()
    operator.run.cancel()
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
