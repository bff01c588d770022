"""The panel shows a run that is about the active object as it is now, in the open file, and no other."""

import bpy
import pytest
from blender_scenes import add_curve, add_hopf_link, add_trefoil
from mobius_flow.addon.live import registry
from shapes import torus_trefoil


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
    for other in (None, add_curve([torus_trefoil(9).vertices]), bpy.data.objects.new("Empty", None)):
        if other is not None and other.name == "Empty":
            bpy.context.scene.collection.objects.link(other)
        activate(other)
        assert shown() is operator.run


def test_another_object(done, operator):
    other = add_hopf_link()
    assert shown() is None
    activate(done)
    assert shown() is operator.run
    activate(None)
    assert shown() is None
    activate(other)
    assert shown() is None


def test_clear(done):
    bpy.ops.curve.mobius_flow_clear()
    assert shown() is None


@pytest.mark.parametrize("output", ["SHAPE_KEYS", "FCURVES", "RESULT"])
def test_points_that_are_moved(operator, output):
    obj = add_trefoil()
    operator.given |= {"max_iterations": 5, "keyframes": output}
    operator.start()
    operator.until(lambda: False)
    assert shown() is operator.run
    obj.data.splines[0].points[3].co[0] += 1
    assert shown() is None
    obj.data.splines[0].points[3].co[0] -= 1


def test_playing_the_animation(done, operator):
    for frame in (1, 40, 250):
        bpy.context.scene.frame_set(frame)
        assert shown() is operator.run


def test_moving_and_renaming_the_object(done, operator):
    done.location, done.name = (1, 2, 3), "Other"
    assert shown() is operator.run


def test_a_cancelled_run_is_shown_while_the_curve_is_as_it_was(operator):
    obj = add_trefoil()
    operator.start()
    operator.reach(2)
    operator.event("ESC")
    assert shown() is operator.run
    assert operator.run.recoverable
    obj.data.splines[0].points[0].co[1] += 1
    assert shown() is None


@pytest.mark.parametrize("going_on", [True, False])
def test_another_file(operator, tmp_path, going_on):
    add_trefoil()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    operator.given["max_iterations"] = 5
    operator.start()
    if not going_on:
        operator.until(lambda: False)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    assert registry.latest() is None
    assert shown() is None


def test_energies_are_kept_for_the_plot(done, operator):
    run = operator.run
    assert len(run.energies) == run.last.index + 1 == 6
    assert run.energies[-1] == run.last.energy
    assert run.target is None, "it is knotted"
