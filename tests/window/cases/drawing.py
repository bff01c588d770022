"""A flat scribble becomes a knot whose crossings can be changed, in one step of undo."""

import bpy
import numpy as np
from case import Steps, picture, until
from cases.knots import alone, together
from hands import button, here, key, open_sidebar, view, window
from scene import clear, look, obj


def case() -> Steps:
    clear()
    add_scribble()
    alone()
    yield from open_sidebar()
    with here():
        view().spaces.active.show_region_hud = True
        bpy.ops.view3d.view_axis(type="TOP")
        bpy.ops.ed.undo_push(message="Scribble")
    yield from look()
    yield from picture("drawing-1-scribble")
    yield from button("curve.mobius_flow_draw_knot")
    yield from until(lambda: obj().name == "Drawn 3_1", "the drawn trefoil")
    assert bpy.data.objects["Scribble"].hide_get()
    yield from picture("drawing-2-knot", differs_from="drawing-1-scribble")
    yield from key("Z", ctrl=True)
    yield from until(lambda: len(bpy.data.objects) == 1, "undo of the drawing")
    assert not bpy.data.objects["Scribble"].hide_get()
    with here():
        change = [k == 1 for k in range(32)]
        bpy.ops.curve.mobius_flow_draw_knot(change=change, number=True)
    assert obj().name == "Drawn Unknot"
    yield from picture("drawing-3-changed", differs_from="drawing-2-knot")
    together()


def add_scribble() -> None:
    """A closed curve with three crossings."""
    t = np.linspace(0, 2 * np.pi, 80, endpoint=False)
    data = bpy.data.curves.new("Scribble", "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("POLY")
    spline.points.add(len(t) - 1)
    spline.use_cyclic_u = True
    points = [np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), 0.0 * t, 0.0 * t + 1.0]
    spline.points.foreach_set("co", np.stack(points, axis=1).astype(np.float32).ravel())
    scribble = bpy.data.objects.new("Scribble", data)
    window().scene.collection.objects.link(scribble)
    window().view_layer.objects.active = scribble
    scribble.select_set(True)
