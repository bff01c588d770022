"""An overhand arc by mouse clicks: its ends are pinned in Edit Mode, it is relaxed and keyed; its knot stays on."""

import bpy
import numpy as np
from case import Steps, picture, until
from hands import addon, button, core, here, key, open_panels, open_sidebar, window
from scene import clear, is_, look, obj


def case() -> Steps:
    open_panels("surroundings")
    clear()
    arc = add_arc()
    window().scene.mobius_flow.length = 100
    window().scene.mobius_flow_panel.quality = "PREVIEW"
    yield from open_sidebar()
    yield from look_down()
    yield from picture("pins-1-arc")

    yield from key("TAB")
    yield from until(lambda: bpy.context.mode == "EDIT_CURVE", "Edit Mode")
    select(0, len(arc) - 1)
    with here():
        bpy.ops.ed.undo_push(message="Selected")
    yield from button("curve.mobius_flow_pin")
    yield from until(lambda: pinned() == 2, "the ends to be pinned")
    yield from picture("pins-2-pinned", differs_from="pins-1-arc")
    yield from key("Z", ctrl=True)
    yield from until(lambda: pinned() == 0, "undo of Pin Selected Points")
    assert bpy.context.mode == "EDIT_CURVE"
    yield from key("Z", ctrl=True, shift=True)
    yield from until(lambda: pinned() == 2, "redo")
    yield from key("TAB")
    yield from until(lambda: bpy.context.mode == "OBJECT", "Object Mode")
    assert pinned() == 2

    yield from button("curve.mobius_flow_relax")
    yield from is_("done")
    assert pinned() == 2
    for frame in keyed():
        np.testing.assert_array_equal(frame[[0, -1]], arc[[0, -1]])
    assert not obj().data.splines[0].use_cyclic_u
    yield from look_down()
    yield from picture("pins-3-relaxed", differs_from="pins-2-pinned")

    yield from button("curve.mobius_flow_unpin")
    yield from until(lambda: pinned() == 0, "the ends to be let go")
    yield from picture("pins-4-unpinned")


def look_down() -> Steps:
    """Look at the arc from above, and leave room for the sidebar."""
    with here():
        bpy.ops.view3d.view_axis(type="TOP")
    yield from look()
    with here():
        for _ in range(2):
            bpy.ops.view3d.zoom(delta=-1)
    yield


def add_arc() -> np.ndarray:
    """An overhand knot in an arc, with a tube; its points."""
    curve = core("knots").overhand(100)
    data = addon("curves.splines").new_curve_data("Arc", curve.mesh)
    addon("curves.splines").write_points(data, curve.vertices.astype("f4"))
    with here():
        arc = bpy.data.objects.new("Arc", data)
        bpy.context.collection.objects.link(arc)
        window().view_layer.objects.active = arc
        arc.select_set(True)
        bpy.ops.curve.mobius_flow_fit_tube()
        bpy.ops.ed.undo_push(message="Arc added")
    return np.array([point.co[:3] for point in data.splines[0].points], dtype=np.float32)


def select(*indices: int) -> None:
    """Select points in Edit Mode."""
    for k, point in enumerate(obj().data.splines[0].points):
        point.select = k in indices


def pinned() -> int:
    """Number of pinned points."""
    return int(addon("curves.pins").count(obj().data))


def keyed() -> list[np.ndarray]:
    """The points at all keys."""
    return list(addon("curves.recorded").keyed_points(obj().data))
