"""What scripts may ask of Continue: the balanced shape, and a way off a saddle."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, relax
from mobius_flow.addon.curves import pins
from mobius_flow.addon.curves.recorded import BakedKeys
from mobius_flow.core import RelaxOptions, minimize
from mobius_flow.core.curve.measures import bending
from mobius_flow.core.knots import torus_knot

OPS = bpy.ops.curve


def add_unbalanced(n):
    curve = minimize(torus_knot(2, 3, n), RelaxOptions(vertices=n)).curve
    away = curve.vertices - np.array([0.9, 0.4, 0.9])  # an inversion near the knot
    return add_curve([3 * away / np.square(away).sum(axis=1, keepdims=True)])


def test_grab_ends_balanced_unless_something_is_in_the_way(capfd):
    """A knot that was pulled hard would stay small on a large ring."""
    obj = add_unbalanced(60)
    assert OPS.mobius_flow_grab(vertices=60) == {"FINISHED"}
    assert "balanced: bending reduced" in capfd.readouterr().out
    OPS.mobius_flow_clear()
    pins.pin(obj.data.splines[0], np.arange(60) == 7)
    assert OPS.mobius_flow_grab(vertices=60) == {"FINISHED"}
    assert "balance" not in capfd.readouterr().out


@pytest.mark.slow
def test_a_balanced_curve_goes_on_from_its_animation():
    add_unbalanced(100)
    obj = relax(vertices=100)
    keys = BakedKeys([obj])
    there, unbalanced = len(keys.frames), bending(keys.curves[-1])
    assert OPS.mobius_flow_continue(balance=True, fit_bevel=False) == {"FINISHED"}
    keys = BakedKeys([obj])
    assert len(keys.frames) > there + 5, "the way has keys"
    assert keys.unproved == 0
    assert bending(keys.curves[-1]) < 0.95 * unbalanced
    assert not bpy.context.scene.mobius_flow.balance


def test_a_saddle_is_told_and_left(capfd):
    add_curve([torus_knot(3, 4, 120).vertices])
    obj = relax(vertices=120, stability=True)
    assert "the energy is not least here" in capfd.readouterr().out
    there = len(BakedKeys([obj]).frames)
    assert OPS.mobius_flow_continue(escape_saddles=True, fit_bevel=False) == {"FINISHED"}
    assert len(BakedKeys([obj]).frames) > there + 5
    assert "every small change of shape raises the energy" in capfd.readouterr().out
