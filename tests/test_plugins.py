"""What CONTRIBUTING promises: one file, and a line in a table, and the new thing is everywhere.

A copy of the project is given an energy, a metric, a direction, a search, a move, a file format, an option and a
subcommand, from `plugins/`, and is looked at from outside: command line, Blender, documents, tests.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.core import read_curve, write_curve
from processes import finished, running
from shapes import torus_trefoil

ROOT = Path(__file__).resolve().parents[1]
SOURCES = Path(__file__).parent / "plugins"
CONTRIBUTING = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
PLUGINS = tomllib.loads((SOURCES / "plugins.toml").read_text(encoding="utf-8"))


def plant(root, plugin):
    """Add the file, and the lines to the table."""
    if "file" in plugin:
        shutil.copy(SOURCES / plugin["file"], root / plugin["room"])
    table = root / plugin["table"]
    lines = table.read_text(encoding="utf-8").splitlines()
    for after, text in plugin["lines"]:
        (place,) = (k for k, line in enumerate(lines) if line.startswith(after))
        lines.insert(place + 1, text)
    table.write_text("\n".join(lines) + "\n", encoding="utf-8")


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """The project with the plugins, importable from a directory of its own."""
    root = tmp_path_factory.mktemp("copy") / "mobius_flow"
    shutil.copytree(ROOT, root, ignore=shutil.ignore_patterns(".*", "__pycache__", "build", "dist"))
    for plugin in PLUGINS.values():
        plant(root, plugin)
    return root


SERVER = """
import contextlib, io, json, os, runpy, sys
from mobius_flow.cli import main
for line in sys.stdin:
    script, words, place = json.loads(line)
    os.chdir(place)
    sys.argv[1:] = words
    out, status = io.TextIOWrapper(io.BytesIO(), encoding="utf-8"), 0
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
        try:
            if script:
                runpy.run_path(script, run_name="__main__")
            else:
                status = main(words)
        except SystemExit as end:
            status = end.code or 0
    out.seek(0)
    print(json.dumps([status, out.read()]), flush=True)
"""


def environment(copy):
    """Of processes whose package is the copy; how pytest was called here is nothing to them."""
    path = os.pathsep.join([str(copy.parent), str(copy / "tests"), str(copy / "tools")])
    return {**os.environ, "PYTHONPATH": path, "PYTEST_ADDOPTS": ""}


@pytest.fixture(scope="module")
def server(copy):
    """A process that runs one after the other in the copy: it imports NumPy and SciPy once."""
    with running([sys.executable, "-c", SERVER], stdin=subprocess.PIPE, env=environment(copy)) as process:
        yield process


@pytest.fixture
def python(server, tmp_path):
    """Run a script on the copy, or the command line where none is named, and give its output."""

    def run(script, *words, status=0):
        server.stdin.write(json.dumps([str(script), [*map(str, words)], str(tmp_path)]) + "\n")
        server.stdin.flush()
        found, said = json.loads(server.stdout.readline())
        assert found == status, said
        return said

    return run


@pytest.fixture
def command(python):
    """Run the copy's command line."""
    return lambda *words, **more: python("", *words, **more)


@pytest.fixture
def trefoil(tmp_path):
    path = tmp_path / "trefoil.txt"
    write_curve(path, torus_trefoil(40))
    return path


@pytest.mark.parametrize("kind", PLUGINS)
def test_contributing_names_the_room_and_the_table(kind):
    plugin = PLUGINS[kind]
    assert f"`{plugin['room']}" in CONTRIBUTING
    assert f"`{plugin['table']}`" in CONTRIBUTING
    assert len(plugin["lines"]) == 1 or "an import and a line" in " ".join(CONTRIBUTING.split())


def test_the_lists_of_the_command_line(command):
    methods = [line.split("\t")[0] for line in command("methods").splitlines()]
    assert {"heavy-ball", "halving", "flow-lumped", "implicit-lumped"} <= set(methods)
    assert re.search(r"length +print it", command("--help"))
    assert "inverse-cube" in command("energy", "--help")
    shown = " ".join(command("relax", "--help-all").split())
    for text in ("inverse-cube", "height", "lumped", "heavy-ball", ".num", "--patience", "wait (default: always)"):
        assert text in shown


def test_the_energy_and_the_subcommand_compute(command, trefoil):
    curve = read_curve(trefoil)
    r = curve.with_vertices(2.0 * curve.vertices)
    write_curve(trefoil.with_name("large.txt"), r)
    small, large = (float(command("energy", path, "--energy", "inverse-cube")) for path in (trefoil, "large.txt"))
    assert large == pytest.approx(small / 2)
    assert float(command("length", trefoil)) == pytest.approx(curve.length)


@pytest.mark.parametrize(
    "words",
    [
        ["--energy", "inverse-cube"],
        ["--term", "height=0.01"],
        ["--metric", "lumped", "--method", "cg"],
        ["--method", "flow-lumped"],
        ["--method", "heavy-ball"],
        ["--method", "halving", "--edge-lengths", "keep"],
        ["--patience", "2.5"],
    ],
    ids=" ".join,
)
def test_relaxing_with_it(words, command, trefoil, tmp_path):
    short = ["--vertices", "40", "--max-iterations", "4", "--quiet"]
    command("relax", trefoil, "out.txt", *words, *short, "--report", "r.json", "--trajectory", "t.npz")
    report = json.loads((tmp_path / "r.json").read_text())
    assert len(report["energy"]) == 5
    assert all(after < before for before, after in zip(report["energy"], report["energy"][1:], strict=False))
    assert report["certified"]
    for flag, value in zip(words[::2], words[1::2], strict=True):
        if flag == "--term":
            assert report["options"]["terms"] == [["height", 0.01]]
            continue
        assert str(report["options"][flag[2:].replace("-", "_")]) == value
    command("verify", "t.npz")


def test_a_run_with_the_move(command, trefoil, tmp_path):
    """Turns are proved like steps, in trajectories too, and change no energy."""
    short = ["--vertices", "40", "--mesh", "fixed", "--seed", "35", "--max-iterations", "6", "--quiet"]
    command("relax", trefoil, "out.txt", *short, "--report", "r.json", "--trajectory", "t.npz")
    command("verify", "t.npz")
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["certified"]
    start, first, second, turned, *_ = report["energy"]
    assert turned == pytest.approx(second, rel=1e-9)
    assert start > first > second > report["energy"][-1]
    with np.load(tmp_path / "t.npz") as frames:
        ends = np.concatenate([frames[name] for name in frames if name.startswith("stage_")])
    moves = [np.abs(after - before).max() for before, after in pairwise(ends)]
    assert sorted(moves)[-2] > 0.2


def test_files_in_the_format(command, trefoil, tmp_path):
    command("relax", trefoil, "a.num", "--max-iterations", "0", "--vertices", "40", "--quiet")
    command("relax", "a.num", "b.txt", "--max-iterations", "0", "--vertices", "40", "--quiet")
    assert (tmp_path / "a.num").read_text().startswith("1,")
    assert (tmp_path / "b.txt").read_text() == trefoil.read_text()
    assert float(command("length", trefoil.rename(tmp_path / "c"), "--format", "txt")) == float(
        command("length", "a.num")
    )


IN_BLENDER = """
import json
import bpy, mobius_flow
mobius_flow.register()
from mobius_flow.addon import properties
owner, scene = bpy.ops.curve.mobius_flow_relax.get_rna_type().properties, bpy.context.scene.mobius_flow
for name in ("energy", "metric", "method"):
    print(name, *(item.identifier for item in owner[name].enum_items))
print(owner["patience"].name, owner["patience"].description)
print(*(option.name for option in properties.shown()))
scene.method, scene.patience = "heavy-ball", 2.5
print(scene.options)
"""


def test_blender(copy):
    pytest.importorskip("bpy")
    done = finished([sys.executable, "-c", IN_BLENDER], env=environment(copy))
    assert done.returncode == 0, done.stderr
    lines = [line.split() for line in done.stdout.splitlines() if line]
    energy, metric, method, patience, shown, options = lines
    assert "inverse-cube" in energy
    assert "lumped" in metric
    assert {"heavy-ball", "halving", "flow-lumped", "implicit-lumped"} <= set(method)
    assert " ".join(patience) == "Patience How long to wait; 0: always"
    assert "patience" in shown
    assert options == ["method=heavy-ball", "patience=2.5"]


def test_the_documents_are_out_of_date_until_they_are_rendered(copy, python):
    tool = copy / "tools/docs.py"
    stale = python(tool, "--check", status=1)
    wanted = {
        "docs/command-line.md": "number of the component",
        "docs/energies.md": "| `inverse-cube` | 1/r³ at the edges' midpoints | -1 |",
        "docs/methods.md": "| `heavy-ball` | heavy ball, metric $J_C$ |",
        "docs/options.md": "\n: How long to wait (default: always).\n",
    }
    for document in wanted:
        assert f"{document} is out of date; python tools/docs.py mends it" in stale
    python(tool)
    for document, text in wanted.items():
        assert text in (copy / document).read_text(encoding="utf-8")
    methods = (copy / "docs/methods.md").read_text(encoding="utf-8")
    assert r"| `lumped` | L², lumped | Σ (ℓ_I + ℓ_J)/2 \|U\|², over" in methods


def test_the_tests_pick_it_up(copy):
    """And that of the metrics asks for the newcomer's value on the circle."""
    wanted = [
        "core/energies/test_contract.py::test_values_and_derivatives_fit_together[inverse-cube-plane]",
        "core/energies/test_contract.py::test_similarities[inverse-cube]",
        "core/driver/test_methods.py::test_every_method_on_every_kind_of_task[heavy-ball-knot]",
        "core/driver/test_methods.py::test_every_method_on_every_kind_of_task[halving-knot]",
        "core/io/test_refusals.py::test_any_bytes_give_a_curve_or_one_sentence[.num]",
        "cli/test_options.py::test_every_option_can_be_given[patience]",
    ]
    chosen = "not test_metrics or lumped and (circle or definite)"
    words = ["-vv", "-p", "no:cacheprovider", "-k", chosen]
    words += [f"tests/{name}" for name in (*wanted, "core/solve/test_metrics.py")]
    done = finished([sys.executable, "-m", "pytest", "--slow", *words], cwd=copy, env=environment(copy))
    found = dict(re.findall(r"^tests/(\S+::\S+) (PASSED|FAILED)", done.stdout, re.MULTILINE))
    assert {name for name, outcome in found.items() if outcome == "PASSED"} >= set(wanted), done.stdout
    failed = [name for name, outcome in found.items() if outcome == "FAILED"]
    assert len(failed) == 4
    assert all("lumped" in name and name.startswith("core/solve/test_metrics.py") for name in failed)
    assert "KeyError: 'lumped'" in done.stdout
