"""The house stands: no circles among its rooms, no way up, and the drawing in the documents is of these walls."""

import importlib.util
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
_SPEC = importlib.util.spec_from_file_location("import_map", ROOT / "tools/import_map.py")
tool = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(tool)
MAP = tool.import_map()
CLUSTER = {"dask", "distributed", "pyarrow"}

# from the ground up; a room reaches none of a higher floor, nor of its own, by any chain of imports
FLOORS = (
    {"core.base"},
    {"core.curve", "core.proof"},
    {"core.collision", "core.energies"},
    {"core.knots", "core.solve"},
    {"core.descent", "core.io", "core.untangle"},
    {"core.keys"},
    {"core.driver"},
    {"core.ropes"},
    {"core"},
    {"addon"},
    {"cli"},
    {"lab"},
)
FLOOR = {name: number for number, floor in enumerate(FLOORS) for name in sorted(floor)}


def test_every_package_has_a_floor():
    packages = {"cli", "addon", "lab", *(f"core.{path.parent.name}" for path in (ROOT / "core").glob("*/__init__.py"))}
    assert packages <= set(FLOOR), f"give {packages - set(FLOOR)} a floor here"
    assert packages <= set(MAP)


@pytest.mark.parametrize("name", [name for name in FLOOR if name in MAP])
def test_no_room_reaches_up(name):
    up = {there for there in tool.reachable(MAP, name) if there in FLOOR and FLOOR[there] >= FLOOR[name]}
    assert not up


def test_there_are_no_circles():
    TopologicalSorter(MAP).prepare()


def test_modules_go_in_circles_for_type_checkers_only():
    """Two types may name each other; code that does so has no beginning."""
    paths = [path for top in tool.TOPS for path in (ROOT / top).rglob("*.py")]
    modules = {".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path for path in paths}
    found = {}
    for name, path in modules.items():
        wanted = [each if each in modules else each.rpartition(".")[0] for each in tool.imports(path, types=False)]
        found[name] = {each for each in wanted if each in modules and each != name}
    TopologicalSorter(found).prepare()


@pytest.mark.parametrize("top", ["core", "cli", "lab"])
def test_blender_stays_in_the_addon(top):
    paths = (ROOT / top).rglob("*.py")
    found = {path.name for path in paths if any(name.split(".")[0] == "bpy" for name in tool.imports(path))}
    assert not found


def test_the_core_needs_nothing_but_numpy_and_scipy():
    names = {name.split(".")[0] for path in (ROOT / "core").rglob("*.py") for name in tool.imports(path, ROOT)}
    assert not names & {"addon", "cli", "lab", "bpy", "shtab", "matplotlib", "mobius_flow", *CLUSTER}
    assert {"numpy", "scipy"} <= names


def test_clusters_are_for_the_laboratory():
    paths = [*(ROOT / "addon").rglob("*.py"), *(ROOT / "cli").rglob("*.py")]
    assert not {name.split(".")[0] for path in paths for name in tool.imports(path)} & CLUSTER


def test_the_verifier_shares_no_code_with_what_it_checks():
    assert tool.reachable(MAP, "core.proof") <= {"core.base"}


def house(root, **files):
    """A house of a few lines."""
    for place, text in files.items():
        path = root / f"{place.replace('__', '/')}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tool.import_map(root)


def test_imports_of_every_kind_are_seen(tmp_path):
    found = house(
        tmp_path,
        core__curve__mesh="from ..errors import E\nfrom .. import quadrature\nimport numpy",
        core__energies__edge="def f():\n    from ..curve.mesh import Mesh\n",
        core__metrics__one="from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from ..energies import edge\n",
        core__errors="",
        core__quadrature="from .curve import mesh",
        cli__main="from ..core import Curve\nfrom ..core.metrics import one\nfrom . import parser",
    )
    assert found["core.curve"] == {"core.base"}
    assert found["core.base"] == found["core.energies"] == {"core.curve"}
    assert found["core.metrics"] == {"core.energies"}
    assert found["cli"] == {"core", "core.metrics"}
