"""What goes with the package: its types, how to cite it, and what the README's commands install."""

import ast
import re
import sys
import tomllib
from importlib.resources import files
from pathlib import Path

import pytest
from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def test_the_package_is_typed():
    assert files("mobius_flow").joinpath("py.typed").is_file()
    assert "py.typed" in PROJECT["tool"]["setuptools"]["package-data"]["mobius_flow"]


def test_the_citation_names_this_version_and_the_paper():
    yaml = pytest.importorskip("yaml")  # which the cluster's packages need
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["authors"] == PROJECT["project"]["authors"]
    assert citation["keywords"] == PROJECT["project"]["keywords"]
    assert {"cff-version", "message", "title", "authors"} <= set(citation)
    assert citation["version"] == PROJECT["project"]["version"]
    assert f"{citation['license']} AND CC0-1.0" == PROJECT["project"]["license"]
    (paper,) = citation["references"]
    assert {"type", "title", "authors"} <= set(paper)
    assert paper["doi"] == "10.1007/s00205-021-01680-1"


def installed(*extras):
    """The distributions that extras bring, with the names of what those bring for the package (dask[distributed])."""
    for each in extras:
        for requirement in map(Requirement, PROJECT["project"]["optional-dependencies"][each]):
            ours = requirement.name == PROJECT["project"]["name"]
            yield from installed(*requirement.extras) if ours else {requirement.name, *requirement.extras}


def imported(path):
    """The modules that a script imports from elsewhere."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        names += [node.module] if isinstance(node, ast.ImportFrom) else []
        yield from {name.split(".")[0] for name in names} - {*sys.stdlib_module_names, "drawing", "mobius_flow"}


@pytest.mark.parametrize(
    ("command", "needs"),
    [
        ("main", {"bpy", "matplotlib", "shtab"}),
        ("test", {"bpy", "hypothesis", "pytest", "trimesh", "plotly", "python-flint", "distributed"}),
        ("site", {"furo", "sphinx", "trimesh", "plotly", "python-flint"}),
    ],
)
def test_a_command_of_the_readme_installs_what_it_needs(command, needs):
    """For the site also what the gallery imports; its film is shown without running where there is no Blender."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    extras = re.search(rf"<!-- {command} command -->\n\n    \S.* \"\.\[(\S+)\]\" && \S", readme)
    has = {*installed(*extras[1].split(","))}
    if command == "site":
        needs = needs.union(*map(imported, ROOT.glob("examples/*.py"))) - {"bl_ext", "bpy", "numpy", "scipy"}
        listed = re.search(
            r"^extensions = (\[.*?\])", (ROOT / "docs/conf.py").read_text("utf-8"), re.MULTILINE | re.DOTALL
        )
        ours = {path.stem for path in ROOT.glob("docs/_extensions/*.py")}
        needs |= {name.split(".")[0].replace("_", "-") for name in ast.literal_eval(listed[1])} - ours
    assert has >= needs


def test_the_recipe_for_conda_asks_for_what_the_package_asks_for():
    yaml = pytest.importorskip("yaml")
    recipe = yaml.safe_load((ROOT / "tools/recipe.yaml").read_text(encoding="utf-8"))
    project = PROJECT["project"]
    assert recipe["context"]["version"] == project["version"]
    assert recipe["about"]["license"] == project["license"]
    _, *run = recipe["requirements"]["run"]
    assert [*map(Requirement, run)] == [*map(Requirement, project["dependencies"])]
    assert PROJECT["build-system"]["requires"][0].replace(">", " >") == recipe["requirements"]["host"][-1]
    assert recipe["build"]["python"]["entry_points"] == [f"{name} = {to}" for name, to in project["scripts"].items()]
