"""Knots are picked from the menu, in the gallery and by search, and can be told apart; each is one undo step."""

import bpy
from case import Steps, picture, until
from hands import addon, button, here, key, move, open_sidebar, region, view, window
from scene import clear, look, obj

SIXTEEN = [f"{crossings}_{k}" for crossings, k in ((3, 1), (4, 1), (5, 1), (5, 2), (6, 1), (6, 2), (6, 3), (7, 4))]
SIXTEEN += ["7_7", "8_5", "8_18", "8_19", "L2a1", "L4a1", "L5a1", "L6a4"]


def case() -> Steps:
    clear()
    with here():
        bpy.ops.ed.undo_push(message="Empty")
    yield from menu()
    yield from side_by_side()
    yield from gallery()
    yield from search()
    together()


def menu() -> Steps:
    """The sub-menu of Add > Curve has pictures."""
    yield from move(600, 700)
    with here():
        bpy.ops.wm.call_menu(name="VIEW3D_MT_mobius_flow_knots")
    yield from picture("knots-1-menu")
    yield from key("ESC", over=(100, 300))


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
    yield from picture("knots-2-sixteen")
    clear()
    with here():
        bpy.ops.ed.undo_push(message="Empty again")


def gallery() -> Steps:
    """What is picked in the gallery is added by the button below, and undone in one step."""
    alone()
    yield from open_sidebar()
    settings = window().scene.mobius_flow_knots
    settings.group, settings.knot = "LINKS", "L6a4"
    region("UI").tag_redraw()
    yield from picture("knots-3-gallery")
    yield from button("curve.mobius_flow_pick_knot")
    yield from until(lambda: obj() is not None, "Borromean rings")
    assert len(obj().data.splines) == len(obj().data.materials) == 3
    yield from look()
    yield from picture("knots-4-borromean", differs_from="knots-3-gallery")
    yield from key("Z", ctrl=True)
    yield from until(lambda: not bpy.data.objects, "undo")


def alone() -> None:
    """Leave the gallery alone in the sidebar, and open it, so that it is found at once."""
    knots = addon("sidebar.panels").VIEW3D_PT_mobius_flow_knots
    for cls in reversed(panels()):
        bpy.utils.unregister_class(cls)
    knots.bl_options = set()
    bpy.utils.register_class(knots)


def together() -> None:
    """Bring the others back: Blender unregisters all of them when it quits."""
    bpy.utils.unregister_class(addon("sidebar.panels").VIEW3D_PT_mobius_flow_knots)
    for cls in panels():
        bpy.utils.register_class(cls)


def panels() -> list[type]:
    """The panels of the sidebar."""
    return [cls for cls in addon("registration").CLASSES if issubclass(cls, bpy.types.Panel)]


def search() -> Steps:
    """What is typed is found, and Enter adds it."""
    yield from move(500, 600)
    with here():
        bpy.ops.curve.mobius_flow_pick_knot("INVOKE_DEFAULT")
    yield
    for letter in "whit":
        for value in ("PRESS", "RELEASE"):
            text = {"unicode": letter} if value == "PRESS" else {}
            window().event_simulate(type=letter.upper(), value=value, x=500, y=600, **text)
            yield
    yield from picture("knots-5-search")
    for value in ("PRESS", "RELEASE"):
        window().event_simulate(type="RET", value=value, x=500, y=600)
        yield
    yield from until(lambda: obj() is not None, "a link from the list")
    assert obj().name.startswith("L5a1")
    yield from look()
    yield from picture("knots-6-found")
