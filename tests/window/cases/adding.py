"""The extension is found; knots are added from the menu, in the gallery and by search."""

import bpy
from case import Steps, picture, until
from hands import addon, button, here, key, move, open_sidebar, region, view, window
from scene import clear, is_, look, obj, ready, undone

SIXTEEN = [f"{crossings}_{k}" for crossings, k in ((3, 1), (4, 1), (5, 1), (5, 2), (6, 1), (6, 2), (6, 3), (7, 4))]
SIXTEEN += ["7_7", "8_5", "8_18", "8_19", "L2a1", "L4a1", "L5a1", "L6a4"]


def found() -> Steps:
    """By "mobius", "relax" and "untangle" in Operator Search, in the Object menu, and among extensions."""
    yield from ready()
    yield from picture("found-0-before")
    for words in ("mobius", "relax"):
        yield from searched(words)
        yield from picture(f"found-1-{words}", differs_from="found-0-before")
        yield from key("ESC")
        yield from key("ESC")
    for words in ("mobius", "untangle"):  # by "relax", Blender's own Relax Pose to Breakdown is listed before ours
        yield from searched(words)
        yield from key("RETURN")  # what is listed first
        yield from is_("running")
        yield from key("ESC")
        yield from is_("cancelled")
    with here():
        bpy.ops.wm.call_menu(name="VIEW3D_MT_mobius_flow")
    yield from picture("found-2-menu", differs_from="found-0-before")
    yield from key("ESC")
    bpy.context.preferences.active_section = "EXTENSIONS"
    bpy.context.window_manager.extension_search = "mobius"
    view().type = "PREFERENCES"
    yield from picture("found-3-extensions", differs_from="found-0-before")


def searched(words: str) -> Steps:
    """Open the search and type into it."""
    yield from key("F3")
    for _ in range(5):
        yield
    main = region("WINDOW")
    yield from typed(words, main.x + main.width // 2, main.y + main.height // 2)


def typed(words: str, x: int, y: int) -> Steps:
    """Type letters, and let what they find be listed."""
    for letter in words:
        for value in ("PRESS", "RELEASE"):
            text = {"unicode": letter} if value == "PRESS" else {}
            window().event_simulate(type=letter.upper(), value=value, x=x, y=y, **text)
            yield
    for _ in range(5):
        yield


def side_by_side() -> Steps:
    """The sub-menu of Add > Curve has pictures; sixteen knots can be told apart in one picture."""
    clear()
    yield from move(600, 700)
    with here():
        bpy.ops.wm.call_menu(name="VIEW3D_MT_mobius_flow_knots")
    yield from picture("knots-1-menu")
    yield from key("ESC", over=(100, 300))
    with here():
        for k, name in enumerate(SIXTEEN):
            bpy.ops.curve.mobius_flow_pick_knot(knot=name, location=(2.4 * (k % 4), -2.2 * (k // 4), 0))
        bpy.ops.object.select_all(action="SELECT")
        bpy.ops.view3d.view_axis(type="TOP")
        bpy.ops.view3d.view_selected()
        bpy.ops.object.select_all(action="DESELECT")
        view().spaces.active.shading.color_type = "MATERIAL"
    yield from picture("knots-2-sixteen")


def gallery() -> Steps:
    """What is picked in the gallery is added by the button below, and undone in one step."""
    clear()
    with here():
        bpy.ops.ed.undo_push(message="Empty")
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
    yield from undone(lambda: not bpy.data.objects, "the link")
    together()


def search() -> Steps:
    """What is typed is found, and Enter adds it."""
    clear()
    yield from move(500, 600)
    with here():
        bpy.ops.curve.mobius_flow_pick_knot("INVOKE_DEFAULT")
    yield
    yield from typed("whit", 500, 600)
    yield from picture("knots-5-search")
    yield from key("RET", over=(500, 600))
    yield from until(lambda: obj() is not None, "a link from the list")
    assert obj().name.startswith("L5a1")
    yield from look()
    yield from picture("knots-6-found")


PARTS = (found, side_by_side, gallery, search)


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
