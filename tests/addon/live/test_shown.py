"""What is shown of a run: in the curves while it goes on, in the panel for as long as it is about the active object."""

import bpy
import pytest
from blender_scenes import add_curve, add_hopf_link, add_trefoil
from mobius_flow.addon.curves.bevel import is_fitted
from mobius_flow.addon.curves.recorded import Recorded
from mobius_flow.addon.live import registry
from shapes import torus_trefoil

COARSE = 1e-6  # of a radius: Blender keeps 32 bits


def shown():
    return registry.shown(bpy.context.active_object)


def activate(obj):
    bpy.context.view_layer.objects.active = obj


@pytest.fixture
def done(operator):
    """A trefoil that has just been relaxed."""
    obj = add_trefoil()
    operator.given["max_iterations"] = 5
    operator.start()
    operator.until(lambda: False)
    assert shown() is operator.run
    return obj


def test_what_goes_on_is_always_shown(operator):
    add_trefoil()
    operator.start()
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.scene.collection.objects.link(empty)
    for other in (None, add_curve([torus_trefoil(9).vertices]), empty):
        activate(other)
        assert shown() is operator.run


def test_it_is_about_its_object_wherever_and_whenever_that_is_seen(done, operator):
    run = operator.run
    assert len(run.energies) == run.last.index + 1 == 6
    assert run.energies[-1] == run.last.energy
    assert run.target is None, "it is knotted"
    for frame in (1, 40, 250):
        bpy.context.scene.frame_set(frame)
        assert shown() is run
    done.location, done.name = (1, 2, 3), "Other"
    assert shown() is run
    other = add_hopf_link()
    for active, about in ((other, None), (done, run), (None, None), (done, run)):
        activate(active)
        assert shown() is about
    done.select_set(True)
    other.select_set(False)
    bpy.ops.curve.mobius_flow_clear()
    assert shown() is None


@pytest.mark.parametrize("output", ["SHAPE_KEYS", "RESULT", "cancelled"])
def test_points_that_are_moved_are_others(operator, output):
    obj = add_trefoil()
    operator.given |= {"max_iterations": 5} | ({} if output == "cancelled" else {"keyframes": output})
    operator.start()
    if output == "cancelled":
        operator.reach(2)
        operator.event("ESC")
        assert operator.run.recoverable
    operator.until(lambda: False)
    assert shown() is operator.run
    obj.data.splines[0].points[3].co[0] += 1
    assert shown() is None


@pytest.mark.parametrize("going_on", [True, False])
def test_another_file_has_none(operator, tmp_path, going_on):
    add_trefoil()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    operator.given["max_iterations"] = 5
    operator.start()
    if not going_on:
        operator.until(lambda: False)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    assert registry.latest() is None
    assert shown() is None


@pytest.fixture
def knot():
    """A flat trefoil, stretched by 2, with a tube that fits."""
    obj = add_trefoil()
    obj.scale = (2, 2, 2)
    for point in obj.data.splines[0].points:
        point.co.z *= 0.3
    bpy.context.view_layer.update()
    bpy.ops.curve.mobius_flow_fit_tube()
    return obj


@pytest.mark.parametrize("radius", ["none", "keep"])
def test_a_fitted_tube_is_kept_as_it_is_shown(operator, knot, radius):
    """That of a rope is the rope itself all along."""
    operator.given |= {"keep_size": "LENGTH", "max_iterations": 8, "radius": radius}
    operator.start()
    operator.reach(8)
    shown = knot.data.bevel_depth
    if radius == "keep":
        assert shown == pytest.approx(0.998 * operator.run.last.radius[0] / 2.0, rel=COARSE)
    assert operator.until(lambda: False) == {"FINISHED"}
    assert knot.data.bevel_depth == pytest.approx(shown, rel=COARSE)
    assert is_fitted(knot.data)
    assert Recorded.of(knot).radii[-1] == pytest.approx(1.0)
