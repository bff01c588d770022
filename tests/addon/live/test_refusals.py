"""What cannot be relaxed is refused in one sentence, and nothing changes."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_hopf_link, add_trefoil, contents, relax, sentence, show
from shapes import torus_trefoil


def refused(**options):
    """What the operator says; nothing may have changed."""
    before = contents()
    with pytest.raises(RuntimeError) as error:
        bpy.ops.curve.mobius_flow_relax(**options)
    assert contents() == before
    said = sentence(error.value)
    assert 20 < len(said) < 200
    return said


def not_finite():
    add_trefoil().data.splines[0].points[6].co[1] = np.nan


def absurdly_far():
    add_hopf_link().data.splines[1].points[2].co[0] = np.inf  # which Blender clamps to the largest number


def mesh():
    data = bpy.data.meshes.new("Mesh")
    data.from_pydata(TREFOIL.tolist(), [], [])
    show(bpy.data.objects.new("Mesh", data))


def of_type(kind):
    show(bpy.data.objects.new("Words", bpy.data.curves.new("Words", kind)))


def zero_parent():
    obj = add_trefoil()
    obj.parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(obj.parent)
    obj.parent.scale = (0, 0, 0)


def animated():
    obj = add_trefoil()
    obj.data.bevel_depth = 0.1
    obj.data.keyframe_insert("bevel_depth", frame=1)


def relaxed(**options):
    """A curve that was relaxed before."""
    add_trefoil()
    return relax(max_iterations=2, **options)


def another_action():
    relaxed().data.shape_keys.animation_data.action = bpy.data.actions.new("Mine")


TREFOIL = torus_trefoil(9).vertices
OTHER_KEYS = "has other keys or points than it was baked with; undo that, or relax a copy"
CASES = [
    (lambda: add_curve([TREFOIL, [[5, 0, 0], [6, 0, 0]]]), "Spline 2 of 'Knot' has fewer than 3 points"),
    (lambda: add_curve([]), "no splines"),
    (not_finite, "Point 7 of spline 1 of 'Knot' is not finite"),
    (absurdly_far, "Point 3 of spline 2 of 'Knot' is not finite, or further away"),
    (mesh, "'Mesh' is of type Mesh"),
    (lambda: of_type("FONT"), "'Words' is of type Text"),
    (lambda: add_trefoil().hide_set(True), "'Knot' is hidden"),
    (lambda: setattr(add_trefoil(), "scale", (1, 0, 1)), "scaled to nothing"),
    (zero_parent, "scaled to nothing"),
    (lambda: add_curve([TREFOIL[:1]], cyclic=False), "Spline 1 of 'Knot' has fewer than 2 points"),
    (lambda: add_curve([TREFOIL], kind="BEZIER"), "is a Bézier spline"),
    (lambda: add_trefoil().shape_key_add(name="Basis"), "has shape keys"),
    (lambda: relaxed().data.shape_keys.driver_add("eval_time"), OTHER_KEYS),
    (another_action, OTHER_KEYS),
    (lambda: relaxed().data.splines[0].points.add(1), OTHER_KEYS),
    (animated, "is animated"),
    (lambda: add_trefoil().data.driver_add("splines[0].points[3].co", 1), "are driven"),
]


@pytest.mark.parametrize(("prepare", "said"), CASES)
def test_refused_in_one_sentence(prepare, said):
    prepare()
    bpy.context.view_layer.update()
    assert said in refused()


@pytest.mark.parametrize("kind", ["BEZIER", "NURBS"])
@pytest.mark.parametrize("count", [1, 2])
def test_a_stray_smooth_spline_changes_nothing(kind, count):
    stray = torus_trefoil(9).vertices[:count] + 9
    obj = add_curve([torus_trefoil(9).vertices, stray, torus_trefoil(9).vertices + 20], kind=kind)
    obj.data.resolution_u = 1  # two Bézier points are drawn as a segment then
    assert "Spline 2 of 'Knot'" in refused(sample_splines=True)


def test_splines_that_are_not_drawn_are_refused(monkeypatch):
    add_curve([torus_trefoil(9).vertices, torus_trefoil(9).vertices + 9], kind="NURBS")
    monkeypatch.setattr(np, "setdiff1d", lambda *_: np.array([0]))  # as if all that is drawn were one chain
    assert "draws nothing for" in refused(sample_splines=True)


NAN = float("nan")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"frames_per_iterate": NAN}, "Frames/Iterate is nan; it must be from 0.1 to 10000"),
        ({"tolerance": NAN}, "tolerance is nan"),
        ({"vertices": 10}, "vertices is 10"),
        ({"vertices": 2}, "vertices is 2"),
        ({"start_frame": 2**24}, "Start Frame is 16777216; it must be from -1048574 to 1048574"),
        ({"start_frame": -(2**24)}, "it must be from -1048574 to 1048574"),
        ({"start_frame": 1_048_000}, "would go on to frame 1050000, but Blender's last is 1048574"),
        ({"frames_per_iterate": 10_000.0}, "The animation would go on to frame 20000001"),
    ],
)
def test_numbers_that_do_not_fit(options, said):
    add_trefoil()
    assert said in refused(**options)
