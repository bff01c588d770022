"""The documents keep up with the program."""

import doctest
import importlib
import re
import runpy
import shutil
import sys
import tomllib
from pathlib import Path

import mobius_flow.core
import pytest
from processes import finished

ROOT = Path(__file__).resolve().parents[1]
DOCUMENTS = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])


def test_generated_parts_are_up_to_date():
    done = finished([sys.executable, str(ROOT / "tools/docs.py"), "--check"])
    assert done.returncode == 0, f"{done.stdout}{done.stderr}python tools/docs.py mends it"


def test_every_generated_part_stands_in_one_place():
    found = [name for path in DOCUMENTS for name in re.findall(r"<!-- generated: (.*?) -->", path.read_text("utf-8"))]
    assert sorted(found) == ["energies", "formats", "methods", "metrics", "options", "rooms"]


def test_every_section_is_about_a_method():
    page = (ROOT / "docs/methods.md").read_text(encoding="utf-8")
    linked = set(re.findall(r"\[`[\w-]+`\]\(#([\w-]+)\)", page))
    headings = re.findall(r"^## (.+: `.+)$", page, re.MULTILINE)
    assert linked == {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}
    assert len(linked) == 8


def test_examples_in_docstrings():
    rooms = [*(ROOT / "core").rglob("*.py"), *(ROOT / "addon/engine").glob("*.py")]
    names = [
        ".".join(["mobius_flow", *path.relative_to(ROOT).with_suffix("").parts]).removesuffix(".__init__")
        for path in rooms
        if ">>> " in path.read_text(encoding="utf-8")
    ]
    tried = [doctest.testmod(importlib.import_module(name)) for name in [*names, "hard_curves.unknots"]]
    assert sum(each.attempted for each in tried) > len(names)
    assert not sum(each.failed for each in tried)


def test_the_reference_has_every_public_name():
    pages = "".join(path.read_text(encoding="utf-8") for path in ROOT.glob("docs/api/*.md"))
    listed = set(re.findall(r"^\.\. auto\w+:: ([\w.]+)$", pages, re.MULTILINE))
    assert set(mobius_flow.core.__all__) <= listed


def test_the_readme_is_one_page():
    assert len((ROOT / "README.md").read_text(encoding="utf-8").split()) <= 700


def test_a_version_has_few_words_in_the_changelog():
    _, *versions = re.split(r"^## ", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert all(len(text.split()) <= 400 for text in versions)


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_somewhere(document):
    for target in re.findall(r"\]\(([^)#]+)[^)]*\)", document.read_text(encoding="utf-8")):
        if not target.startswith("http"):
            assert (document.parent / target).exists(), target


@pytest.mark.parametrize("document", ["README.md", "docs/library.md", "docs/surroundings.md"])
def test_the_examples_run(document, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / document).read_text(encoding="utf-8")
    example = re.search(r"```python\n(from .*?)```", text, re.DOTALL)
    assert example is not None
    exec(compile(example.group(1), document, "exec"), {"__name__": document})


def test_the_readme_example_for_blender_runs():
    pytest.importorskip("bpy")
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    example = re.search(r"```python\n(import bpy.*?)```", readme, re.DOTALL)
    assert example is not None
    scripting = (ROOT / "docs/scripting.md").read_text(encoding="utf-8")
    told = re.search(r"`mobius_flow_relax` takes the panel's settings: (.*?);", scripting, re.DOTALL)
    assert told is not None
    names = re.findall(r"`([a-z_]+)`", told.group(1))
    assert "max_keys" in names
    code = (
        "import mobius_flow\nmobius_flow.register()\n"
        + example.group(1)
        + (
            "assert bpy.context.object.data.shape_keys.animation_data\n"
            f"assert set({names}) <= set(bpy.ops.curve.mobius_flow_relax.get_rna_type().properties.keys())\n"
        )
    )
    done = finished([sys.executable, "-P", "-c", code])
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_example_for_scripts_in_blender_runs(tmp_path):
    pytest.importorskip("bpy")
    guide = (ROOT / "docs/scripting.md").read_text(encoding="utf-8")
    example = re.search(r"```python\n(import bpy.*?)```", guide, re.DOTALL)
    assert example is not None
    code = example.group(1).replace("from bl_ext.user_default.mobius_flow", "from mobius_flow")
    code = code.replace('"/tmp/film.mp4", look="QUICK"', f"{str(tmp_path / 'film.mp4')!r}")
    before = (
        "import bpy, mobius_flow\n"
        "mobius_flow.register()\n"
        "scene = bpy.context.scene\n"
        "scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = 'CYCLES', 1, False\n"
        "scene.render.resolution_x, scene.render.resolution_y, scene.frame_end = 64, 36, 2\n"
        "bpy.ops.mesh.primitive_cube_add(location=(0, 0, -9))\n"
        "bpy.context.object.name = 'Table'\n"
        "bpy.ops.curve.mobius_flow_add_knot()\n"
        "bpy.context.object.name = 'Knot'\n"
    )
    done = finished([sys.executable, "-P", "-c", before + code])
    assert done.returncode == 0, done.stdout + done.stderr
    assert (tmp_path / "film.mp4").exists()


def test_the_readme_names_the_versions_of_blender():
    least = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))["blender_version_min"]
    assert f"Blender {least.removesuffix('.0')} or newer" in (ROOT / "README.md").read_text(encoding="utf-8")


def test_the_readme_has_both_commands():
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    for marker in ("main command", "test command"):
        assert re.search(rf"<!-- {marker} -->\n\n    \S", readme)


@pytest.mark.parametrize("made", [True, False])
def test_the_site_takes_in_the_pages_of_an_atlas(made, tmp_path):
    pytest.importorskip("sphinx")
    for name in ("docs/conf.py", "blender_manifest.toml"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    if made:
        (tmp_path / "build/site/atlas").mkdir(parents=True)
    tags = set()
    found = runpy.run_path(str(tmp_path / "docs/conf.py"), {"tags": tags})
    assert (found.get("html_extra_path"), tags) == (
        ([str(tmp_path / "build/site")], {"atlas"}) if made else (None, set())
    )
