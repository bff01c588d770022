"""The extension is found by "mobius" and by "relax": in Operator Search, in the Object menu, and among extensions."""

import bpy
from case import Steps, picture
from hands import here, key, region, view, window
from scene import is_, ready


def case() -> Steps:
    yield from ready()
    yield from picture("found-0-before")
    for words in ("mobius", "relax"):
        yield from searched(words)
        yield from picture(f"found-1-{words}", differs_from="found-0-before")
        yield from key("ESC")
        yield from key("ESC")

    for words in ("mobius", "relax"):
        yield from searched(words)
        yield from key("RETURN")  # what is listed first
        yield from is_("running")
        yield from key("ESC")
        yield from is_("cancelled")

    with here():
        bpy.ops.wm.call_menu(name="VIEW3D_MT_mobius_flow")
    yield from picture("found-2-menu", differs_from="found-0-before")
    yield from key("ESC")
    yield from extensions("mobius")


def searched(words: str) -> Steps:
    """Open the search and type into it."""
    yield from key("F3")
    for _ in range(5):
        yield
    for letter in words:
        yield from typed(letter)
    for _ in range(5):
        yield


def typed(letter: str) -> Steps:
    """Type a letter where the mouse is."""
    main, kind = region("WINDOW"), "SPACE" if letter == " " else letter.upper()
    x, y = main.x + main.width // 2, main.y + main.height // 2
    window().event_simulate(type=kind, value="PRESS", unicode=letter, x=x, y=y)
    yield
    window().event_simulate(type=kind, value="RELEASE", x=x, y=y)
    yield


def extensions(words: str) -> Steps:
    """Look for it in Preferences > Get Extensions."""
    bpy.context.preferences.active_section = "EXTENSIONS"
    bpy.context.window_manager.extension_search = words
    view().type = "PREFERENCES"
    yield from picture("found-3-extensions", differs_from="found-0-before")
