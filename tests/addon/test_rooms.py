"""The rooms of the extension: none imports from one above it, and its engine runs where there is no Blender."""

import ast
import sys
from pathlib import Path

from processes import finished

ADDON = Path(__file__).resolve().parents[2] / "addon"
ENGINE = sorted((ADDON / "engine").glob("*.py"))
FLOORS = [
    {"engine"},
    {"curves", "translations"},
    {"pictures", "properties"},
    {"live"},
    {"scripting"},
    {"settings", "buttons"},
    {"sidebar"},
    {"registration"},
    {""},  # the package, which Blender and the command line import
]
OF_BLENDER = ("bpy", "bpy_extras", "blf", "bl_operators", "bl_ui", "bmesh", "gpu", "gpu_extras", "mathutils")
WITHOUT_BLENDER = f"""
import importlib
import sys

class Refuse:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in {OF_BLENDER}:
            raise ModuleNotFoundError(f"{{name}} is part of Blender", name=name)

sys.meta_path.insert(0, Refuse())
for name in {[path.stem for path in ENGINE]}:
    importlib.import_module(f"mobius_flow.addon.engine.{{name}}".removesuffix(".__init__"))
assert not set(sys.modules) & set({OF_BLENDER})
"""


def room(parts):
    """The room of a module of the extension, or the module itself where it is in none."""
    return parts[0] if parts else ""


def imported(path):
    """The rooms of the extension that a module imports from, wherever it does so."""
    package = path.relative_to(ADDON).with_suffix("").parts[:-1]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and 0 < node.level <= len(package) + 1:
            base = package[: len(package) + 1 - node.level] + tuple(filter(None, (node.module or "").split(".")))
            yield from (room((*base, alias.name)) for alias in node.names)


def test_no_room_imports_from_one_above_it():
    floor = {name: k for k, names in enumerate(FLOORS) for name in names}
    for path in ADDON.rglob("*.py"):
        here = room([part for part in path.relative_to(ADDON).with_suffix("").parts if part != "__init__"])
        for there in imported(path):
            assert there == here or floor[there] < floor[here], f"{path.relative_to(ADDON)} imports {there}"


def test_arrows_are_found():
    assert set(imported(ADDON / "__init__.py")) == {"registration"}
    assert set(imported(ADDON / "live" / "run.py")) == {"curves", "engine", "live", "pictures"}
    assert set(imported(ADDON / "engine" / "worker.py")) == set()


def test_the_engine_is_imported_without_blender():
    done = finished([sys.executable, "-P", "-c", f"{WITHOUT_BLENDER}\nprint('done')\nimport bpy"])
    assert done.stdout == "done\n", done.stderr
    assert "bpy is part of Blender" in done.stderr, "what refuses Blender refuses it"
