"""The event loop of the Relax operator on several objects at once: all of them are relaxed, or none is touched."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_trefoil, stored
from mobius_flow.addon.curves import keyframes
from mobius_flow.addon.curves.splines import Splines
from mobius_flow.addon.engine import worker
from mobius_flow.addon.live.run import KeyWriter, RunState
from modal_operator import keys, restored
from shapes import hopf_link


@pytest.fixture
def rings():
    """Two linked rings, each an object, both selected."""
    vertices = hopf_link(24).vertices
    first = add_curve([vertices[:24]], "A")
    second = add_curve([0.5 * vertices[24:] - [0, 2, 0]], "B")
    second.scale, second.location = (2, 2, 2), (0, 4, 0)
    bpy.context.view_layer.update()
    return first, second


def test_two_objects_are_the_headless_job_too(operator, rings):
    bpy.ops.curve.mobius_flow_fit_tube()
    bpy.ops.object.duplicate()
    copies = bpy.context.selected_objects
    for obj in copies:
        obj.data = obj.data.copy()
    bpy.ops.curve.mobius_flow_relax(vertices=120, timing="DISTANCE")
    for obj in copies:
        obj.select_set(False)
    for obj in rings:
        obj.select_set(True)
    assert operator.start() == {"RUNNING_MODAL"}
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.report.names == ("A", "B")
    assert "with themselves and each other" in operator.reports[-1][1]
    for live, headless in zip(rings, sorted(copies, key=lambda obj: obj.name), strict=True):
        np.testing.assert_array_equal(keys(live), keys(headless))
        assert live.data.bevel_depth == headless.data.bevel_depth > 0


@pytest.mark.parametrize("operator", ["process"], indirect=True)
def test_the_worker_proves_what_is_stored(operator, rings, monkeypatch):
    """Nothing is proved twice: the motions of rounded points of all objects come proved from the worker."""
    again = []
    monkeypatch.setattr(worker, "is_free", lambda *_: again.append(1) or True)
    operator.given["timing"] = "ITERATE"  # which leaves no room for keys in between
    operator.start()
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.report.certified
    assert len(again) <= 1, "only the rounding of the start"


def test_esc_restores_all_objects(operator, rings):
    before = [Splines.of(obj.data) for obj in rings]
    operator.start()
    operator.reach(2)
    assert all(len(obj.data.splines[0].points) > 24 for obj in rings)
    assert operator.event("ESC") == {"CANCELLED"}
    for obj, each in zip(rings, before, strict=True):
        restored(obj, each)


def remove(obj):
    bpy.data.objects.remove(obj)
    return "'B' was deleted"


def edit(obj):
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")  # of all selected objects
    return "'A' is being edited"


def give_keys(obj):
    obj.shape_key_add(name="Mine")
    return "'B' was given shape keys"


def add_point(obj):
    obj.data.splines[0].points.add(1)
    return "Points of 'B' were added or removed"


def move(obj):
    obj.location.x += 1e-3
    bpy.context.view_layer.update()
    return "'B' was moved against the others"


def give_data(obj):
    obj.data = obj.data.copy()
    return "'B' was given other curve data"


@pytest.mark.parametrize("act", [remove, edit, give_keys, add_point, move, give_data], ids=lambda act: act.__name__)
def test_what_happens_to_one_object_restores_the_others(operator, rings, act):
    first, second = rings
    before = Splines.of(first.data)
    operator.start()
    operator.reach(2)
    said = act(second)
    assert operator.event() == {"CANCELLED"}
    assert operator.run.state is RunState.LOST
    rest = "every curve is as it was" if act in (edit, move) else "the others are as they were"
    assert operator.reports[-1][1] == f"{said}; the relaxation has ended, and {rest}"
    restored(first, before)
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    if act in (edit, move):
        assert len(second.data.splines[0].points) == 24


def test_a_single_object_may_be_moved_meanwhile(operator):
    obj = add_trefoil()
    operator.start()
    operator.reach(1)
    obj.location.x += 1
    bpy.context.view_layer.update()
    assert operator.until(lambda: False) == {"FINISHED"}


def test_a_file_saved_meanwhile_has_all_objects_as_they_were(operator, rings, tmp_path):
    before = [stored(obj.data) for obj in rings]
    operator.start()
    operator.reach(2)
    shown = [stored(obj.data) for obj in rings]
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"), copy=True)
    for obj, points in zip(rings, shown, strict=True):
        np.testing.assert_array_equal(stored(obj.data), points)
    assert operator.event() == {"PASS_THROUGH"}, "saving does not end the run"
    operator.run.cancel()
    with bpy.data.libraries.load(str(tmp_path / "a.blend")) as (_, loaded):
        loaded.curves = ["A", "B"]
    for data, points in zip(loaded.curves, before, strict=True):
        np.testing.assert_array_equal(stored(data), points)


def test_esc_while_keys_of_the_second_object_are_written(operator, rings, monkeypatch):
    monkeypatch.setattr(KeyWriter, "slice", 0.0)  # a key at a tick
    before = [Splines.of(obj.data) for obj in rings]
    operator.start()
    operator.until(lambda: rings[1].data.shape_keys is not None)
    assert operator.event("ESC") == {"CANCELLED"}
    for obj, each in zip(rings, before, strict=True):
        restored(obj, each)
        assert obj.data.shape_keys is None
        assert obj.data.bevel_depth == 0
    assert len(bpy.data.actions) == 0


def test_an_error_while_keys_are_written_loses_nothing(operator, rings, monkeypatch):
    before, writing = [Splines.of(obj.data) for obj in rings], keyframes.writing

    def failing(*arguments):
        yield next(writing(*arguments))
        raise MemoryError

    monkeypatch.setattr(keyframes, "writing", failing)
    operator.start()
    assert operator.until(lambda: False) == {"CANCELLED"}
    assert operator.reports[-1] == ({"ERROR"}, "Memory ran out; all is as it was")
    for obj, each in zip(rings, before, strict=True):
        restored(obj, each)
        assert obj.data.shape_keys is None
