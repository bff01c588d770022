"""The extension is found, and a knot by what is typed."""

import bpy
from case import Steps, picture, until
from hands import here, key, move, region, view, window
from scene import clear, is_, look, obj, ready


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


PARTS = (found, search)
