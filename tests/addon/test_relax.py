"""The operator does in Blender what the library does outside: relax, grow, pack and balance."""

import bpy
import numpy as np
import threadpoolctl
from blender_scenes import add_curve, add_trefoil, relax, stored, values
from mobius_flow.addon.curves import pins
from mobius_flow.addon.curves.recorded import BakedKeys
from mobius_flow.addon.curves.splines import box
from mobius_flow.addon.curves.surroundings import Surroundings
from mobius_flow.addon.live.selection import avoided
from mobius_flow.core import Curve, MoebiusEnergy, RelaxOptions, minimize
from mobius_flow.core.collision.embedded import clears
from mobius_flow.core.knots import torus_knot
from shapes import regular_polygon


def expected(components, **options):
    """The library's result for the same world-space points."""
    return minimize(Curve.from_components(components), RelaxOptions(radius="none", **options)).curve.vertices


def test_a_script_in_blender_finds_its_blas_threads_as_they_were(monkeypatch):
    pools, seen = threadpoolctl.ThreadpoolController().select(user_api="blas"), []
    method = MoebiusEnergy.value_and_derivative

    def spied(*arguments):
        seen.extend(each["num_threads"] for each in pools.info())
        return method(*arguments)

    monkeypatch.setattr(MoebiusEnergy, "value_and_derivative", spied)
    with pools.limit(limits=2):
        add_trefoil()
        relax(max_iterations=2)
        assert {each["num_threads"] for each in pools.info()} == {2}
    assert set(seen) == {1}


def test_settings_come_from_the_scene_and_the_operators_own_win():
    obj = add_trefoil()
    bpy.context.scene.mobius_flow.max_iterations = 3
    bpy.context.scene.mobius_flow.method = "flow-l2"
    start = stored(obj.data).astype(np.float64)
    relax(method="lbfgs")
    result = expected([start], method="lbfgs", max_iterations=3)
    np.testing.assert_array_equal(stored(obj.data), result.astype(np.float32))
    assert bpy.context.scene.mobius_flow.method == "flow-l2"


def test_refinement_interpolates_what_points_have():
    obj = add_trefoil(30)
    (spline,) = obj.data.splines
    for name, low in (("radius", 0.5), ("tilt", -1.0), ("weight_softbody", 0.1)):
        spline.points.foreach_set(name, np.linspace(low, low + 0.9, 30).astype(np.float32))
    before = {name: values(spline, name) for name in ("radius", "tilt", "weight_softbody")}
    start = stored(obj.data)
    relax(vertices=100, max_iterations=0, keyframes="RESULT")
    points, (spline,) = stored(obj.data), obj.data.splines
    assert len(points) == 100
    old = np.array([np.abs(points - p).max(axis=1).argmin() for p in start])
    np.testing.assert_array_equal(points[old], start)
    for name, array in before.items():
        refined = values(spline, name)
        np.testing.assert_array_equal(refined[old], array)
        lengths = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
        along = np.concatenate([[0], np.cumsum(lengths)])
        linear = np.interp(along[:-1], [*along[old], along[-1]], [*array, array[0]])
        np.testing.assert_allclose(refined, linear, atol=1e-5)


def add_ring():
    return add_curve([regular_polygon(40).vertices * [1.0, 0.8, 1.0]])


def add_ball():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=1.3)
    ball = bpy.context.object
    ball.select_set(False)
    bpy.context.scene.mobius_flow_surroundings.container = ball
    return ball


def test_a_curve_is_packed_into_its_container():
    obj, ball = add_ring(), add_ball()
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    assert bpy.ops.curve.mobius_flow_pack(max_iterations=20, vertices=60) == {"FINISHED"}
    keys = BakedKeys([obj])
    lengths = [curve.length for curve in keys.curves]
    assert lengths[-1] > 1.2 * lengths[0]
    assert keys.unproved == 0
    assert clears(keys.curves[-1], Surroundings([ball], []).obstacles, 0.0)
    low, high = box(ball)
    assert all((low < each.vertices).all() and (each.vertices < high).all() for each in keys.curves)


def test_what_lies_in_the_container_never_touches_it_whatever_is_pressed():
    obj, ball = add_ring(), add_ball()
    obj.select_set(True)
    assert avoided(bpy.context) == [ball]
    assert avoided(bpy.context, "") == []
    obj.select_set(False)
    assert avoided(bpy.context) == []
    obj.select_set(True)
    ball.hide_set(True)
    assert avoided(bpy.context) == []
    ball.hide_set(False)
    for x in (-2.0, 2.0):
        obj.location.x = x
        bpy.context.view_layer.update()
        assert avoided(bpy.context) == []


def add_unbalanced(n):
    curve = minimize(torus_knot(2, 3, n), RelaxOptions(vertices=n, radius="none")).curve
    away = curve.vertices - np.array([0.9, 0.4, 0.9])  # an inversion near the knot
    return add_curve([3 * away / np.square(away).sum(axis=1, keepdims=True)])


def test_grab_ends_balanced_unless_something_is_in_the_way(capfd):
    """A knot that was pulled hard would stay small on a large ring."""
    obj = add_unbalanced(60)
    assert bpy.ops.curve.mobius_flow_grab(vertices=60) == {"FINISHED"}
    assert "balanced: bending reduced" in capfd.readouterr().out
    bpy.ops.curve.mobius_flow_clear()
    pins.pin(obj.data.splines[0], np.arange(60) == 7)
    assert bpy.ops.curve.mobius_flow_grab(vertices=60) == {"FINISHED"}
    assert "balance" not in capfd.readouterr().out
