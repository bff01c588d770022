"""The event loop of the Relax operator beside objects that are avoided."""

import re

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, relax
from mobius_flow.addon.curves.splines import Splines
from mobius_flow.addon.engine import worker
from mobius_flow.addon.live.run import RunState
from modal_operator import keys, restored
from shapes import hopf_link


@pytest.fixture
def torus():
    bpy.ops.mesh.primitive_torus_add(major_radius=1, minor_radius=0.25)
    obj = bpy.context.object
    obj.select_set(False)
    return obj


@pytest.fixture
def ring(torus, operator):
    """A stretched ring around the torus, selected."""
    operator.given["avoid"] = [torus]
    return add_curve([hopf_link(24).vertices[24:] * [1.0, 1.0, 4.0]], "Ring")


def test_a_live_run_is_the_headless_job(operator, ring, torus):
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    collection = bpy.data.collections.new("Avoid")
    collection.objects.link(torus)
    relax(avoid="Avoid", vertices=120, timing="DISTANCE")
    copy.select_set(False)
    ring.select_set(True)
    operator.start()
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.avoided == operator.run.report.avoided == ("Torus",)
    assert "proved free of contact with itself, and with 'Torus'" in operator.reports[-1][1]
    np.testing.assert_array_equal(keys(ring), keys(copy))


@pytest.mark.parametrize("operator", ["process"], indirect=True)
def test_the_worker_proves_what_is_stored(operator, ring, monkeypatch):
    """Motions beside the torus come proved from the worker."""
    again = []
    monkeypatch.setattr(worker, "is_free", lambda *given: again.append(given[-1]) or True)
    operator.given["timing"] = "ITERATE"  # which leaves no room for keys in between
    operator.start()
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.report.certified
    assert len(again) <= 1, "only the rounding of the start"
    assert all(avoided.name == "Torus" for obstacles in again for avoided in obstacles)


def delete(_ring, torus):
    bpy.data.objects.remove(torus)
    return "'Torus' was deleted"


def edit(_ring, torus):
    for obj in bpy.context.selected_objects:
        obj.select_set(False)
    bpy.context.view_layer.objects.active = torus
    bpy.ops.object.mode_set(mode="EDIT")
    return "'Torus' is being edited"


def move(_ring, torus):
    torus.location.x += 1e-3
    return "'Torus' was moved against the others"


def move_curve(ring, _torus):
    ring.location.x += 1e-3
    return "'Ring' was moved against the others"


@pytest.mark.parametrize("act", [delete, edit, move, move_curve], ids=lambda act: act.__name__)
def test_what_happens_to_what_is_avoided_ends_the_run(operator, ring, torus, act):
    before = Splines.of(ring.data)
    operator.start()
    operator.reach(2)
    said = act(ring, torus)
    bpy.context.view_layer.update()
    assert operator.event() == {"CANCELLED"}
    assert operator.run.state is RunState.LOST
    assert operator.reports[-1][1] == f"{said}; the relaxation has ended, and every curve is as it was"
    restored(ring, before)
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def test_what_was_cancelled_is_recovered_only_beside_the_same(operator, ring, torus):
    operator.start()
    operator.reach(2)
    operator.run.cancel()
    torus.location.x += 1
    bpy.context.view_layer.update()
    with pytest.raises(RuntimeError, match="changed since the relaxation ended"):
        bpy.ops.curve.mobius_flow_recover()
    torus.location.x = 0
    bpy.context.view_layer.update()
    assert bpy.ops.curve.mobius_flow_recover() == {"FINISHED"}
    assert ring.data.shape_keys is not None


def test_a_start_in_contact_is_said_and_shown(operator, ring, torus):
    torus.scale = (2, 1, 1)
    operator.start()
    assert operator.until(lambda: False) == {"CANCELLED"}
    kind, said = operator.reports[-1]
    assert kind == {"ERROR"}
    assert re.match(r"Segment \d+ of spline 1 of 'Ring' ", said)
    assert "'Torus' at (" in said
    assert [spot.member for spot in operator.run.trouble] == [0]
