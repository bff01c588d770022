"""Tighten: selected knots are pulled tight, keyed and proved as a relaxation is."""

import bpy
import pytest
from blender_scenes import add_curve
from mobius_flow import Relaxation
from mobius_flow.addon.scripting import begin
from mobius_flow.core.collision import thickness
from mobius_flow.core.knots import knot


def trefoil():
    obj = add_curve([knot("3_1", 60).vertices], "Knot")
    obj.select_set(True)
    return obj


def test_a_button_pulls_a_trefoil_tight_and_clear_undoes_it():
    obj = trefoil()
    before = Relaxation(obj)
    assert bpy.ops.curve.mobius_flow_tighten(vertices=100, time_limit=60) == {"FINISHED"}
    first, last = (before.curves[k] for k in (0, -1))
    assert last.length / thickness(last) < 32.9
    assert last.length < 0.7 * first.length
    assert thickness(last) == pytest.approx(0.9 * thickness(first), rel=1e-5)
    before.clear()


def test_a_live_run_tells_the_ropelength(operator):
    obj = trefoil()
    operator.session = lambda _, values: begin([obj], values | {"vertices": 100}, False, False, starts=1)
    operator.start()
    operator.until(lambda: operator.run.state.over)
    assert "ropelength 32.8" in operator.run.message
    assert operator.run.report.certified
