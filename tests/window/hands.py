"""A user's hands: mouse and keys in the first window, and what can be seen there."""

import importlib
from collections.abc import Generator
from typing import Any

import bpy
from case import Steps, until

_KEYS = {"RETURN": "RET"}


def window() -> bpy.types.Window:
    """The first window."""
    return bpy.context.window_manager.windows[0]


def view() -> bpy.types.Area:
    """The 3D view."""
    return next(area for area in window().screen.areas if area.type == "VIEW_3D")


def region(kind: str) -> bpy.types.Region:
    """A region of the 3D view."""
    return next(region for region in view().regions if region.type == kind)


def here() -> Any:
    """The context of the 3D view; after loading a file there is no window otherwise."""
    return bpy.context.temp_override(window=window(), area=view(), region=region("WINDOW"))


def addon(module: str = "") -> Any:
    """A module of the installed extension, such as ``live.registry``."""
    return importlib.import_module(f"bl_ext.user_default.mobius_flow.addon.{module}".rstrip("."))


def core(module: str = "") -> Any:
    """A module of the library inside the extension, such as ``knots``."""
    return importlib.import_module(f"bl_ext.user_default.mobius_flow.core.{module}".rstrip("."))


def move(x: int, y: int) -> Steps:
    """Move the mouse; buttons notice it only if it moves over them."""
    for dx in (1, 0):
        window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x + dx, y=y)
        yield


def click(x: int, y: int) -> Steps:
    """Click with the left button."""
    yield from move(x, y)
    for value in ("PRESS", "RELEASE"):
        window().event_simulate(type="LEFTMOUSE", value=value, x=x, y=y)
        yield


def key(name: str, over: tuple[int, int] | None = None, **modifiers: bool) -> Steps:
    """Press a key with the mouse over a place, by default the middle of the 3D view."""
    main = region("WINDOW")
    x, y = over or (main.x + main.width // 2, main.y + main.height // 2)
    yield from move(x, y)
    for value in ("PRESS", "RELEASE"):
        window().event_simulate(type=_KEYS.get(name, name), value=value, x=x, y=y, **modifiers)
        yield


def open_sidebar() -> Steps:
    """Show Möbius Flow's tab, and give it room."""
    with here():
        view().spaces.active.show_region_ui = True
    yield
    sidebar = region("UI")

    def shown() -> bool:
        try:
            sidebar.active_panel_category = "Möbius Flow"
        except TypeError:  # not drawn yet
            return False
        return str(sidebar.active_panel_category) == "Möbius Flow"

    yield from until(shown, "the sidebar's tab")
    sidebar.tag_redraw()
    for _ in range(4):
        yield


def open_panels(*names: str) -> None:
    """Let these sub-panels be open, such as ``film``, and no others; to be called before the sidebar is first drawn."""
    for panel in addon("registration").CLASSES:
        if getattr(panel, "bl_parent_id", ""):
            bpy.utils.unregister_class(panel)
            panel.bl_options = set() if panel.__name__.rpartition("_")[2] in names else {"DEFAULT_CLOSED"}
            bpy.utils.register_class(panel)


def button(operator: str) -> Steps:
    """Find a button of the sidebar with the mouse and click it; an operator such as ``curve.mobius_flow_relax``."""
    x, y = yield from found(operator)
    yield from click(x, y)


def found(operator: str) -> Generator[None, None, tuple[int, int]]:
    """Find a button of the sidebar with the mouse, and where it is."""
    sidebar = region("UI")
    ys = range(sidebar.y + sidebar.height - 10, sidebar.y + 10, -10)
    for share, y in [(share, y) for share in (0.2, 0.5, 0.83) for y in ys]:
        x = sidebar.x + int(share * sidebar.width)
        yield from move(x, y)
        if f"bpy.ops.{operator}(" in _under_mouse(sidebar):
            return x, y
    raise AssertionError(f"no button for {operator}")


def entry(command: str, x: int, ys: range) -> Steps:
    """Find an entry of the menu that is open, by a part of its command, which Ctrl-C copies, and choose it."""
    manager = bpy.context.window_manager
    for y in ys:
        yield from move(x, y)
        manager.clipboard = ""
        for value in ("PRESS", "RELEASE"):
            window().event_simulate(type="C", value=value, ctrl=True, x=x, y=y)
            yield
        if command in manager.clipboard:
            yield from key("RET", over=(x, y))  # opened again, the last entry is active, not that here
            return
    raise AssertionError(f"no entry for {command}")


def _under_mouse(sidebar: bpy.types.Region) -> str:
    """The Python command of the button under the mouse, as Blender's own context menu copies it."""
    with bpy.context.temp_override(window=window(), area=view(), region=sidebar):
        if not bpy.ops.ui.copy_python_command_button.poll():
            return ""
        bpy.context.window_manager.clipboard = ""
        bpy.ops.ui.copy_python_command_button()
    return str(bpy.context.window_manager.clipboard)
