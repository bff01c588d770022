"""Relaxations from scripts: no selection, no scene's settings, errors in place of reports."""

import bpy
import mobius_flow
import numpy as np
import pytest
from blender_scenes import add_curve, add_trefoil, stored
from mobius_flow import Relaxation
from mobius_flow.addon.pictures import staging
from mobius_flow.addon.properties import SETTINGS
from mobius_flow.addon.scripting import complete
from mobius_flow.core import MobiusFlowError
from shapes import hopf_link, regular_polygon

SHORT = {"max_iterations": 5, "vertices": 100, "length": 10, "timing": "DISTANCE"}


def test_defaults_are_those_of_a_new_scene():
    fresh = bpy.data.scenes.new("New").mobius_flow
    values = complete({})
    assert {name: values[name] for name in SETTINGS} == pytest.approx({name: getattr(fresh, name) for name in SETTINGS})


def test_again_further_and_clear():
    obj = add_trefoil()
    before = stored(obj.data)
    relaxation = Relaxation(obj)
    relaxation.relax(**SHORT)
    relaxation.relax(**SHORT)
    before_that = len(relaxation.curves)
    report = relaxation.relax_further(**SHORT)
    assert report.continues
    assert report.last_frame == 20
    assert len(relaxation.curves) == before_that - 1 + report.keys
    assert report.kinds.total() == report.keys - 1  # the last key that was there is not new
    relaxation.clear()
    np.testing.assert_array_equal(stored(obj.data), before)


def test_several_objects_are_one_link():
    one, other = (add_curve([part]) for part in hopf_link(24).components)
    report = Relaxation(one, other).relax(**SHORT)
    assert report.names == (one.name, other.name)
    assert len(Relaxation(one, other).curves[-1].mesh.component_sizes) == 2


def test_smooth_splines_only_if_agreed():
    obj = add_curve([regular_polygon(8).vertices], kind="NURBS")
    with pytest.raises(MobiusFlowError, match="NURBS"):
        Relaxation(obj).relax(**SHORT)
    Relaxation(obj, sample_splines=True).relax(**SHORT)


def test_what_cannot_be_relaxed():
    obj, eye = add_trefoil(), bpy.data.objects.new("Eye", bpy.data.cameras.new("Eye"))
    for given, said in (
        ((), "at least one"),
        ((None,), "'None' is not a curve object"),
        (("Knot",), "'Knot' is not a curve object"),
        ((eye,), "'Eye' is not a curve"),
        ((obj, obj), "'Knot' is given twice"),
    ):
        with pytest.raises(MobiusFlowError, match=said):
            Relaxation(*given)
    for act in (Relaxation(obj).relax_further, Relaxation(obj).clear, lambda: Relaxation(obj).curves):
        with pytest.raises(MobiusFlowError, match="has no keys"):
            act()
    obj.data.dimensions = "2D"
    with pytest.raises(MobiusFlowError, match="is a 2D curve"):
        Relaxation(obj).relax()


def test_a_stage():
    obj, scene = add_trefoil(), bpy.context.scene
    collection = Relaxation(obj).set_up_stage(use_world=False)
    assert collection == staging.own_stage(scene)
    assert scene.world is None


def test_the_package_has_nothing_else_to_import():
    with pytest.raises(AttributeError, match="Relaxations"):
        _ = mobius_flow.Relaxations
