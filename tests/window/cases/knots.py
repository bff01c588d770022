"""Knots are picked from the menu, in the gallery and by search; a drawing becomes a knot, in one undo step each."""

import bpy
import numpy as np
from case import Steps, picture, until
from hands import below, button, click, found, here, key, move, open_sidebar, region, view, window
from scene import clear, look, obj

SIXTEEN = [f"{crossings}_{k}" for crossings, k in ((3, 1), (4, 1), (5, 1), (5, 2), (6, 1), (6, 2), (6, 3), (7, 4))]
SIXTEEN += ["7_7", "8_5", "8_18", "8_19", "L2a1", "L4a1", "L5a1", "L6a4"]


def case() -> Steps:
    clear()
    with here():
        bpy.ops.ed.undo_push(message="Empty")
    yield from side_by_side()
    yield from menu()
    yield from gallery()
    yield from search()
    yield from drawing()


def side_by_side() -> Steps:
    """Sixteen knots can be told apart in one picture."""
    with here():
        for k, name in enumerate(SIXTEEN):
            bpy.ops.curve.mobius_flow_pick_knot(knot=name, location=(2.4 * (k % 4), -2.2 * (k // 4), 0))
        bpy.ops.object.select_all(action="SELECT")
        bpy.ops.view3d.view_axis(type="TOP")
        bpy.ops.view3d.view_selected()
        bpy.ops.object.select_all(action="DESELECT")
    view().spaces.active.shading.color_type = "MATERIAL"
    yield from picture("knots-1-sixteen")
    clear()


def menu() -> Steps:
    """The sub-menu of Add > Curve has pictures; its first entry adds a knot."""
    yield from move(600, 700)
    with here():
        bpy.ops.wm.call_menu(name="VIEW3D_MT_mobius_flow_knots")
    yield from picture("knots-2-menu")
    yield from key("ESC", over=(100, 300))


def gallery() -> Steps:
    """A knot picked in the gallery is added by the button below."""
    yield from open_sidebar()
    y = yield from below("curve.mobius_flow_add_knot")
    sidebar = region("UI")
    yield from fold_others(sidebar, y)
    yield from picture("knots-3-gallery")
    yield from button("curve.mobius_flow_pick_knot")
    yield from until(lambda: obj() is not None, "a knot from the gallery")
    assert obj().name == "0_1"
    yield from key("Z", ctrl=True)
    yield from until(lambda: not bpy.data.objects, "undo")
    window().scene.mobius_flow_knots.group = "LINKS"
    window().scene.mobius_flow_knots.knot = "L6a4"
    x, top = yield from found("curve.mobius_flow_pick_knot")
    yield from click(x, top + 60)
    yield from picture("knots-4-popup")
    yield from key("ESC", over=(100, 300))
    yield from button("curve.mobius_flow_pick_knot")
    yield from until(lambda: obj() is not None, "Borromean rings")
    assert len(obj().data.splines) == len(obj().data.materials) == 3
    yield from look()
    yield from picture("knots-5-borromean")


def fold_others(sidebar: bpy.types.Region, y: int) -> Steps:
    """Ctrl-click on the header of our panel, found by trying, which folds all others."""
    settings = window().scene.mobius_flow_knots
    assert settings is not None
    sidebar.tag_redraw()
    yield
    for at in range(y, sidebar.y, -12):
        yield from click(sidebar.x + int(0.6 * sidebar.width), at)
        if (yield from is_open()):
            return
        yield from click(sidebar.x + int(0.6 * sidebar.width), at)
    raise AssertionError("no panel with a gallery")


def is_open() -> Steps:
    try:
        yield from found("curve.mobius_flow_draw_knot")
    except AssertionError:
        return False
    return True


def search() -> Steps:
    """What is typed is found, and Enter adds it."""
    clear()
    with here():
        bpy.ops.curve.mobius_flow_pick_knot("INVOKE_DEFAULT")
    yield
    for letter in ("EIGHT", "UNDERSCORE"):
        assert letter
    for kind, text in (("W", "w"), ("H", "h"), ("I", "i"), ("T", "t")):
        window().event_simulate(type=kind, value="PRESS", unicode=text, x=600, y=600)
        yield
        window().event_simulate(type=kind, value="RELEASE", x=600, y=600)
        yield
    yield from picture("knots-6-search")
    yield from key("RETURN")
    yield from until(lambda: obj() is not None, "a knot from the list")
    assert obj().name.startswith("L5a1")
    yield from look()


def drawing() -> Steps:
    """A flat scribble becomes a knot; a crossing is changed in the panel of the last operation."""
    clear()
    t = np.linspace(0, 2 * np.pi, 80, endpoint=False)
    data = bpy.data.curves.new("Scribble", "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("POLY")
    spline.points.add(len(t) - 1)
    spline.use_cyclic_u = True
    wave = np.column_stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), 0 * t, 0 * t + 1])
    spline.points.foreach_set("co", wave.astype(np.float32).ravel())
    scribble = bpy.data.objects.new("Scribble", data)
    window().scene.collection.objects.link(scribble)
    window().view_layer.objects.active = scribble
    scribble.select_set(True)
    view().spaces.active.show_region_hud = True
    with here():
        bpy.ops.ed.undo_push(message="Scribble")
    yield from look()
    yield from picture("knots-7-scribble")
    yield from button("curve.mobius_flow_draw_knot")
    yield from until(lambda: obj().name == "Drawn 3_1", "the drawn trefoil")
    assert scribble.hide_get()
    with here():
        bpy.ops.view3d.view_orbit(angle=0.5, type="ORBITDOWN")
    yield from picture("knots-8-drawn", differs_from="knots-7-scribble")
    yield from key("Z", ctrl=True)
    yield from until(lambda: len(bpy.data.objects) == 1, "undo of the drawing")
    assert not bpy.data.objects["Scribble"].hide_get()
