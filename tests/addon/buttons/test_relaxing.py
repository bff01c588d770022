"""Balance, Check and Leave Saddle."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_trefoil, contents, relax
from mobius_flow.addon.curves.baked_keys import BakedKeys
from mobius_flow.core import RelaxOptions, minimize
from mobius_flow.core.curve.measures import bending
from mobius_flow.core.knots import torus_knot

OPS = bpy.ops.curve


@pytest.mark.slow
def test_a_balanced_curve_goes_on_from_its_animation():
    curve = minimize(torus_knot(2, 3, 100), RelaxOptions(vertices=100)).curve
    away = curve.vertices - np.array([0.9, 0.4, 0.9])  # an inversion near the knot
    add_curve([3 * away / np.square(away).sum(axis=1, keepdims=True)])
    obj = relax(vertices=100)
    keys = BakedKeys([obj])
    there, unbalanced = len(keys.frames), bending(keys.curves[-1])
    assert OPS.mobius_flow_balance(fit_bevel=False) == {"FINISHED"}
    keys = BakedKeys([obj])
    assert len(keys.frames) > there + 5, "the way has keys"
    assert keys.unproved == 0
    assert bending(keys.curves[-1]) < 0.95 * unbalanced
    assert not bpy.context.scene.mobius_flow.balance


def saddle():
    add_curve([torus_knot(3, 4, 120).vertices])
    return relax(vertices=120)


def test_a_saddle_is_told_and_left():
    obj = saddle()
    before = contents()
    assert OPS.mobius_flow_check() == {"FINISHED"}
    assert contents() == before
    there = len(BakedKeys([obj]).frames)
    assert OPS.mobius_flow_leave_saddle(fit_bevel=False) == {"FINISHED"}
    assert len(BakedKeys([obj]).frames) > there + 5
    before = contents()
    assert OPS.mobius_flow_leave_saddle() == {"CANCELLED"}, "it is a minimum now"
    assert contents() == before


@pytest.mark.parametrize("name", ["balance", "check", "leave_saddle"])
def test_what_was_not_baked_is_refused(name):
    add_trefoil()
    before = contents()
    with pytest.raises(RuntimeError, match="has no keys of Möbius Flow; press Relax first"):
        getattr(OPS, f"mobius_flow_{name}")()
    assert contents() == before
