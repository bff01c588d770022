"""The panel for people: quality, presets, the plot in any theme, whose run is shown, and a message with its place."""

from pathlib import Path

import bpy
import numpy as np
from case import Steps, picture, until
from hands import addon, button, here, key, move, open_sidebar, window
from interruption import undo
from scene import clear, is_, knot, look, obj, reaches, ready

LIGHT = Path(bpy.utils.system_resource("SCRIPTS")) / "presets/interface_theme/Blender_Light.xml"
CROSSED = [[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 2, 0]]


def shown() -> object:
    return addon("live.registry").shown(obj())


def case() -> Steps:
    yield from ready("thistlethwaite", vertices=0)
    scene = window().scene
    assert scene.mobius_flow_panel.quality == "GOOD"
    yield from picture("panel-1-ready")
    yield from menus()
    yield from running()
    yield from another()
    yield from taken_back()
    yield from refused()


def menus() -> Steps:
    """The presets."""
    yield from move(500, 500)  # menus open at the mouse
    with here():
        bpy.ops.wm.call_panel(name="VIEW3D_PT_mobius_flow_presets", keep_open=True)
    yield from picture("panel-1-presets", differs_from="panel-1-ready")
    yield from key("ESC")


def running() -> Steps:
    """The plot is drawn while the curve moves, in a dark and in a light theme."""
    window().scene.mobius_flow.view_every = 1
    yield from button("curve.mobius_flow_relax")
    yield from reaches(15)
    yield from button("curve.mobius_flow_pause")
    yield from is_("paused")
    yield from look()
    yield from picture("panel-2-running", differs_from="panel-1-ready")
    window().scene.mobius_flow_panel.show_plot = False
    yield from picture("panel-3-without-plot", differs_from="panel-2-running")
    window().scene.mobius_flow_panel.show_plot = True
    with here():
        bpy.ops.script.execute_preset(filepath=str(LIGHT), menu_idname="USERPREF_MT_interface_theme_presets")
    yield from picture("panel-4-light")
    with here():
        bpy.ops.preferences.reset_default_theme()
    yield from button("curve.mobius_flow_pause")
    yield from is_("done")
    assert shown() is not None
    yield from look()
    yield from picture("panel-5-done")


def another() -> Steps:
    """The run is shown with its own object only."""
    first = obj()
    knot("3_1", 0)
    yield
    assert shown() is None
    yield from picture("panel-6-another")
    bpy.data.objects.remove(obj())
    window().view_layer.objects.active = first
    first.select_set(True)
    assert shown() is not None


def taken_back() -> Steps:
    """Clear, undo and redo are followed."""
    with here():
        bpy.ops.ed.undo_push(message="Before")
    yield from button("curve.mobius_flow_clear")
    yield from until(lambda: obj().data.shape_keys is None, "the keys to be gone")
    assert shown() is None
    yield from picture("panel-7-cleared")
    undo()
    yield from until(lambda: obj().data.shape_keys is not None, "undo")
    assert shown() is not None
    with here():
        bpy.ops.ed.redo()
    yield from until(lambda: obj().data.shape_keys is None, "redo")
    assert shown() is None


def refused() -> Steps:
    """A curve that touches itself: the place is marked, and Show selects the points."""
    clear()
    data = bpy.data.curves.new("Crossed", "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("POLY")
    spline.points.add(len(CROSSED) - 1)
    spline.points.foreach_set("co", np.pad(CROSSED, ((0, 0), (0, 1)), constant_values=1).ravel())
    spline.use_cyclic_u = True
    new = bpy.data.objects.new("Crossed", data)
    window().scene.collection.objects.link(new)
    window().view_layer.objects.active = new
    new.select_set(True)
    with here():
        bpy.ops.ed.undo_push(message="Crossed")
    yield from open_sidebar()
    yield from look()
    yield from button("curve.mobius_flow_relax")
    yield from is_("cancelled")
    yield from picture("panel-8-refused")
    yield from key("ESC")  # closes Blender's own message
    yield from button("curve.mobius_flow_show")
    yield from until(lambda: obj().mode == "EDIT", "Edit Mode")
    yield from picture("panel-9-shown", differs_from="panel-8-refused")
    undo()
    yield from until(lambda: obj().mode == "OBJECT", "Show to be undone")
