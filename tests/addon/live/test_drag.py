"""Strands that are dragged while they relax, by a double of the mouse in a double of a 3D view."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_hopf_link, add_trefoil, stored
from mathutils import Matrix
from mobius_flow import Relaxation
from mobius_flow.addon.curves import bake, pins
from mobius_flow.addon.live.drag import Drag, projected
from mobius_flow.addon.live.run import RunState
from mobius_flow.core import MobiusFlowError
from modal_operator import keys
from shapes import torus_trefoil

SIZE = 600.0
WIDE = 12.0  # of the view, in the world


def area(overlapping=()):
    """A 3D view from above, in which one unit is 50 pixels."""
    view = SimpleNamespace(
        perspective_matrix=Matrix.Diagonal((2 / WIDE, 2 / WIDE, -0.01, 1.0)),
        view_matrix=Matrix.Translation((0.0, 0.0, -10.0)),
        is_perspective=False,
        view_perspective="ORTHO",
    )
    region = SimpleNamespace(type="WINDOW", x=100, y=50, width=SIZE, height=SIZE, data=view)
    return SimpleNamespace(type="VIEW_3D", x=100, y=50, width=SIZE, height=SIZE, regions=[region, *overlapping])


def begin(operator, stays=True, **more):
    operator.given |= {"vertices": 60} | more
    operator.start(stays)
    screen = SimpleNamespace(areas=[area()], is_animation_playing=False)
    operator.context.window = SimpleNamespace(screen=screen)
    operator.context.workspace = SimpleNamespace(status_text_set=lambda _: None)
    view = bpy.context.preferences.view  # without a window interfaces have no scale
    operator.context.preferences = SimpleNamespace(system=SimpleNamespace(ui_scale=1.0), view=view)
    operator.reach(1)


def pixel(place):
    return 100 + SIZE * (place[0] / WIDE + 0.5), 50 + SIZE * (place[1] / WIDE + 0.5)


def press(operator, place, **keys):
    return operator.event("LEFTMOUSE", pixel(place), **keys)


def taken(operator):
    """Where a trefoil is taken hold of."""
    add_curve([torus_trefoil(40).vertices])
    begin(operator)
    place = on_curve(operator)
    assert press(operator, place) == {"RUNNING_MODAL"}
    return place


def move(operator, place):
    return operator.event("MOUSEMOVE", pixel(place), value="NOTHING")


def release(operator, place, **keys):
    return operator.event("LEFTMOUSE", pixel(place), value="RELEASE", **keys)


def key(operator, name, ctrl=False):
    return operator.event(name, (400, 350), ctrl=ctrl)


def moved(place, *by):
    return place + np.array(by)


def on_curve(operator, vertex=0):
    return operator.run.session.in_view.vertices[vertex]


def gap(operator, target):
    drag = operator.run.drag
    return np.linalg.norm(drag.held(operator.run.session.in_view)[:2] - target[:2])


@pytest.mark.parametrize("operator", ["thread", "process"], indirect=True)
def test_a_strand_follows_the_mouse_and_all_is_proved(operator):
    place = taken(operator)
    for k in range(1, 11):
        target = moved(place, 0.1 * k, 0.05 * k, 0.0)
        assert move(operator, target) == {"RUNNING_MODAL"}
        operator.event()
    operator.until(lambda: gap(operator, target) < 0.2)
    before = operator.run.drag.target
    operator.run.pull(np.array([np.nan, 0.0, np.inf]))  # nowhere, which is left out
    assert operator.run.drag.target is before
    operator.run.pull(np.array([1e300, 0.0, 0.0]))
    assert release(operator, target) == {"RUNNING_MODAL"}
    assert operator.run.drag is None
    operator.reach(operator.run.last.index + 1)
    assert key(operator, "RET") == {"RUNNING_MODAL"}
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.report.certified


def test_what_is_beside_the_curve_or_pressed_with_a_key_is_blenders(operator):
    add_curve([torus_trefoil(40).vertices])
    begin(operator)
    place = on_curve(operator)
    assert press(operator, [5.5, 5.5, 0.0]) == {"PASS_THROUGH"}
    for modifier in ("shift", "alt", "oskey"):
        assert press(operator, place, **{modifier: True}) == {"PASS_THROUGH"}
    assert operator.event("MIDDLEMOUSE", pixel(place)) == {"PASS_THROUGH"}
    assert move(operator, place) == {"PASS_THROUGH"}
    assert release(operator, place) == {"PASS_THROUGH"}
    sidebar = SimpleNamespace(type="UI", x=100, y=50, width=SIZE, height=SIZE)
    operator.context.window.screen.areas = [area([sidebar])]
    assert press(operator, place) == {"PASS_THROUGH"}
    assert operator.run.drag is None


def at_rest(operator):
    """Whether the last iterate is one that comes where nothing moves any more."""
    last = operator.run.last
    return bool(last.path) and last.step_size == 0.0


@pytest.mark.parametrize(("size", "early"), [("LENGTH", False), ("RADIUS", True)])
def test_ctrl_leaves_a_pin_that_is_kept(operator, size, early):
    obj = add_curve([torus_trefoil(40).vertices])
    begin(operator, keep_size=size)
    place = on_curve(operator, 7)
    assert press(operator, place, ctrl=early) == {"RUNNING_MODAL"}
    target = moved(place, 0.5, 0.0, 0.0)
    move(operator, target)
    operator.until(lambda: gap(operator, target) < 0.2)
    release(operator, target, ctrl=not early)
    operator.until(lambda: operator.run.shown.pins)
    assert pins.count(obj.data) == 1
    (vertex,) = operator.run.shown.pins
    held = operator.run.session.in_view.vertices[vertex]
    operator.reach(operator.run.last.index + 5)
    np.testing.assert_array_equal(operator.run.session.in_view.vertices[vertex], held)
    key(operator, "RET")
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.report.certified
    assert pins.count(obj.data) == 1
    pinned = bake.sizes(obj.data)[-1].of(pins.places(obj.data)[0].astype(np.float64))
    np.testing.assert_allclose(pinned, held, rtol=0.0, atol=1e-6)


@pytest.mark.parametrize(("pressed", "let_go"), [("Z", True), ("Z", False), ("ESC", False)])
def test_a_drag_is_taken_back(operator, pressed, let_go):
    obj = add_curve([torus_trefoil(40).vertices])
    bpy.ops.ed.undo_push(message="Before")
    begin(operator)
    operator.until(lambda: at_rest(operator))
    before, index = stored(obj.data), operator.run.last.index
    place = on_curve(operator)
    press(operator, place)
    target = moved(place, 2.0, 0.0, 0.0)
    move(operator, target)
    operator.until(lambda: gap(operator, target) < 1.0)
    if let_go:
        release(operator, target, ctrl=True)
    assert np.abs(stored(obj.data) - before).max() > 0.1
    if pressed == "Z":
        assert key(operator, pressed, ctrl=True) == {"PASS_THROUGH"}, "Blender undoes its step"
        bpy.ops.ed.undo()
        obj, operator.context.scene = bpy.context.view_layer.objects.active, bpy.context.scene
    else:
        assert key(operator, pressed) == {"RUNNING_MODAL"}
    operator.until(lambda: at_rest(operator) and np.abs(stored(obj.data) - before).max() < 1e-4)
    assert operator.run.drag is None
    assert pins.count(obj.data) == 0
    assert operator.run.state is RunState.RUNNING
    key(operator, "RET")
    assert operator.until(lambda: False) == {"FINISHED"}
    assert operator.run.report.certified
    assert len(keys(obj)) == operator.run.last.index + 1
    assert operator.run.last.index <= index + 20
    assert len(operator.run.energies) == operator.run.last.index + 1


def test_the_strand_in_front_is_held_where_two_cross(operator):
    add_hopf_link()
    begin(operator)
    curve = operator.run.session.in_view
    region = area().regions[0]
    flat, depth, seen = projected(region, curve.vertices)
    assert seen.all()
    vertex = int(depth.argmin())
    drag = Drag.at(curve, region, flat[vertex], 15.0)
    assert np.linalg.norm(drag.target - curve.vertices[vertex]) < 0.3
    assert Drag.at(curve, region, np.array([1.0, 1.0]), 15.0) is None


@pytest.mark.parametrize("size", ["LENGTH", "BOX", "RADIUS"])
def test_curves_are_dragged_where_they_are_seen(operator, size):
    obj = add_curve([torus_trefoil(40).vertices])
    begin(operator, keep_size=size)
    if size == "LENGTH":
        obj.location = (2.0, -1.0, 0.0)
        bpy.context.view_layer.update()
    else:
        operator.until(lambda: at_rest(operator))
    place = on_curve(operator)
    press(operator, place)
    target = moved(place, 0.3, 0.3, 0.0)
    operator.until(lambda: move(operator, target) and gap(operator, target) < 0.2)


def test_scripts_drag_too():
    obj, seen = add_trefoil(), []

    def drag(hand, iterate):
        seen.append(iterate.index)
        if iterate.index == 2:
            hand.grab(0, 0.5)
        if 2 <= iterate.index < 12:
            hand.move([0.2 * iterate.index, 0.0, 0.0])
        if iterate.index == 12:
            hand.release(pin=True)

    report = Relaxation(obj).relax(drag=drag, vertices=120)
    assert report.certified
    assert len(seen) > 13
    with pytest.raises(MobiusFlowError, match="finite"):
        Relaxation(obj).relax(drag=lambda hand, _: hand.move([np.nan] * 3), vertices=120)
