"""Registering and unregistering leave Blender as it was."""

import ast
import re
from importlib import import_module
from pathlib import Path

import bpy
from mobius_flow.addon.live import overlay

ADDON = Path(__file__).parents[2] / "addon"
# of the types that annotations name, which are evaluated when a module is imported, all that the oldest Blender has
OLD = """Action Collection Constraint Context Curve Depsgraph DepsgraphObjectInstance Event FCurve ID Image Material
Menu Mesh Modifier Node NodeTree Object Operator OperatorMousePath Preferences Property PropertyGroup Scene ShapeKey
Spline UILayout WindowManager World bpy_struct"""


def traces():
    """Everything of ours that Blender knows about."""
    handlers = [
        function.__module__
        for name in dir(bpy.app.handlers)
        if isinstance(functions := getattr(bpy.app.handlers, name), list)
        for function in functions
    ]
    drawn = [
        function.__module__
        for kind in (bpy.types.Menu, bpy.types.Panel, bpy.types.Header)
        for cls in kind.__subclasses__()
        for function in getattr(getattr(cls, "draw", None), "_draw_funcs", ())
    ]
    kinds = (bpy.types.Operator, bpy.types.Panel, bpy.types.PropertyGroup, bpy.types.Menu, bpy.types.AddonPreferences)
    classes = [cls.__name__ for kind in kinds for cls in kind.__subclasses__() if cls.is_registered]
    names = [name for kind in (bpy.types.Scene, bpy.types.WindowManager, bpy.types.Object) for name in dir(kind)]
    everything = [*handlers, *drawn, *classes, *names, *dir(bpy.types), *dir(bpy.ops.curve)]
    return sorted(name for name in everything if "mobius" in name.lower())


def test_unregistering_leaves_nothing(addon):
    registered = traces()
    addon.unregister()
    try:
        assert traces() == overlay._handles == []
        assert not hasattr(bpy.types.Scene, "mobius_flow")
        assert not hasattr(bpy.types, "CURVE_OT_mobius_flow_relax")
    finally:
        addon.register()
    assert traces() == registered
    assert len(overlay._handles) == 1
    assert "mobius_flow" in dir(bpy.types.Scene)


def test_no_annotation_is_beyond_the_oldest_blender():
    """Quote what only newer ones have."""
    nodes = [node for path in ADDON.rglob("*.py") for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))]
    notes = [note for node in nodes for key in ("annotation", "returns") if (note := getattr(node, key, None))]
    types = [ast.unparse(part) for note in notes for part in ast.walk(note) if isinstance(part, ast.Attribute)]
    assert {name.split(".")[2] for name in types if name.startswith("bpy.types.")} <= {*OLD.split()}
    assert all(hasattr(bpy.types, name) for name in OLD.split())  # tried with Blender 4.2, too


def test_what_the_windows_cases_name_is_there():
    """They are not run with the other tests, and would be the last to hear that something has moved."""
    cases = "".join(path.read_text(encoding="utf-8") for path in (ADDON.parent / "tests" / "window").rglob("*.py"))
    named = re.findall(r'\b(addon|core)\("?([\w.]*)"?\)\.(\w+)', cases)
    assert len(named) > 20
    for room, module, name in named:
        assert hasattr(import_module(f"mobius_flow.{room}.{module}".rstrip(".")), name), (room, module, name)
