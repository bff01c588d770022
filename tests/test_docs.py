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
from mobius_flow.core.proof import verify
from numpy.typing import ArrayLike
from processes import finished

ROOT = Path(__file__).resolve().parents[1]
DOCUMENTS = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])


def test_generated_parts_are_up_to_date():
    done = finished([sys.executable, str(ROOT / "tools/docs.py"), "--check"])
    assert done.returncode == 0, f"{done.stdout}{done.stderr}python tools/docs.py mends it"


def test_every_generated_part_stands_in_one_place():
    found = [name for path in DOCUMENTS for name in re.findall(r"<!-- generated: (.*?) -->", path.read_text("utf-8"))]
    assert sorted(found) == ["commands", "energies", "formats", "methods", "metrics", "options", "rooms"]


def test_every_section_is_about_a_method():
    page = (ROOT / "docs/methods.md").read_text(encoding="utf-8")
    linked = set(re.findall(r"\[`[\w-]+`\]\(#([\w-]+)\)", page))
    headings = re.findall(r"^## (.+: `.+)$", page, re.MULTILINE)
    assert linked == {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}
    assert len(linked) == 6


def test_examples_in_docstrings():
    rooms = [*(ROOT / "core").rglob("*.py"), *(ROOT / "addon/engine").glob("*.py")]
    names = [
        ".".join(["mobius_flow", *path.relative_to(ROOT).with_suffix("").parts]).removesuffix(".__init__")
        for path in rooms
        if ">>> " in path.read_text(encoding="utf-8")
    ]
    tried = [doctest.testmod(importlib.import_module(name)) for name in [*names, "hard_curves"]]
    assert sum(each.attempted for each in tried) > len(names)
    assert not sum(each.failed for each in tried)


def test_the_reference_has_every_public_name():
    pages = "".join(path.read_text(encoding="utf-8") for path in ROOT.glob("docs/api/*.md"))
    listed = set(re.findall(r"^\.\. auto\w+:: ([\w.]+)$", pages, re.MULTILINE))
    assert set(mobius_flow.core.__all__) <= listed


def test_signatures_name_what_is_like_an_array():
    typing = pytest.importorskip("sphinx.util.typing")
    shorten = runpy.run_path(str(ROOT / "docs/_extensions/docstrings.py"))["shorten"]
    annotation = typing.stringify_annotation(ArrayLike, "smart")
    newer = "Buffer | _SupportsArray[Any] | _NestedSequence[_SupportsArray[Any]] | complex | _NestedSequence[complex]"
    for each in (annotation, newer):
        assert shorten(f"(target: {each}, k: int)", "None") == ("(target: ~numpy.typing.ArrayLike, k: int)", "None")


def test_the_readme_is_one_page():
    assert len((ROOT / "README.md").read_text(encoding="utf-8").split()) <= 650


def test_a_version_has_few_words_in_the_changelog():
    _, *versions = re.split(r"^## ", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert all(len(text.split()) <= 500 for text in versions)


def test_the_manual_stays_short():
    pages = [path.read_text(encoding="utf-8") for path in (ROOT / "docs").glob("*.md")]
    written = [re.sub("<!-- generated: .*?<!-- end -->", "", page, flags=re.DOTALL) for page in pages]
    assert sum(len(page.split()) for page in written) <= 16_690  # half of what it was, and ropes


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_somewhere(document):
    for target in re.findall(r"\]\(([^)#]+)[^)]*\)", document.read_text(encoding="utf-8")):
        if not target.startswith("http"):
            assert (document.parent / target).exists(), target


@pytest.mark.parametrize("document", ["README.md", "docs/library.md", "docs/certificate.md"])
def test_the_examples_run(document, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    examples = re.findall(r"```python\n(.*?)```", (ROOT / document).read_text(encoding="utf-8"), re.DOTALL)
    code = "".join(each for each in examples if "bpy" not in each)
    assert code
    exec(compile(code, document, "exec"), {"__name__": document})
    assert all(verify(path).accepted for path in tmp_path.glob("*.npz"))


@pytest.mark.slow
def test_the_commands_of_the_tutorial_run(tmp_path):
    for needed in ("plotly", "tqdm", "pyarrow"):
        pytest.importorskip(needed)
    text = (ROOT / "docs/tutorial-command-line.md").read_text(encoding="utf-8")
    commands = re.findall(r"^    ((?:mobius-flow|echo) .*)$", text, re.MULTILINE)
    program = f'set -e; mobius-flow() {{ "{sys.executable}" -m mobius_flow "$@"; }}\n'
    refused = "mobius-flow same a.txt b.txt"  # they are mirror images
    lines = "".join(f"{line} || test $? = 1\n" if line == refused else f"{line}\n" for line in commands)
    assert len(commands) > 20
    assert refused in commands
    done = finished(["bash", "-c", program + lines], cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert verify(tmp_path / "perko.npz").accepted


def test_the_readme_example_for_blender_runs():
    pytest.importorskip("bpy")
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    example = re.search(r"```python\n(import bpy.*?)```", readme, re.DOTALL)
    assert example is not None
    scripting = (ROOT / "docs/scripting.md").read_text(encoding="utf-8")
    told = re.search(r"`mobius_flow_relax` takes the panel's settings: (.*?);", scripting, re.DOTALL)
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
        "bpy.ops.curve.mobius_flow_add_knot(knot='3_1')\n"
        "bpy.context.object.name = 'Knot'\n"
    )
    done = finished([sys.executable, "-P", "-c", before + code])
    assert done.returncode == 0, done.stdout + done.stderr
    assert (tmp_path / "film.mp4").exists()


def test_the_readme_names_the_versions_of_blender():
    least = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))["blender_version_min"]
    assert f"Blender {least.removesuffix('.0')} or newer" in (ROOT / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("made", [True, False])
def test_the_site_takes_in_the_pages_of_an_atlas(made, tmp_path, monkeypatch):
    pytest.importorskip("sphinx")
    monkeypatch.setattr(sys, "meta_path", [*sys.meta_path])
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
