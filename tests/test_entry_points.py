"""Packages join by entry points: commands, methods, terms and formats; those that cannot are left out, with a word."""

import logging
import os
import sys
import tomllib
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path

import pytest
from mobius_flow.cli.main import main
from mobius_flow.cli.parser import joined
from mobius_flow.core import read_curve, write_curve
from mobius_flow.core.base.plugins import Table
from processes import finished
from shapes import torus_trefoil

MODULE = """
import dataclasses
from mobius_flow.core.descent import METHODS
from mobius_flow.core.energies import Bending
from mobius_flow.core.io import FORMATS

def add_count(parser):
    \"\"\"Count vertices.

    More about it.
    \"\"\"
    from mobius_flow.core import read_curve
    parser.add_argument("input")
    parser.set_defaults(run=lambda options: print(len(read_curve(options.input))) or 0)

mine = {"mine": dataclasses.replace(METHODS["cg"], name="mine")}
columns = FORMATS[".txt"]

class Stiffness(Bending):
    name = "stiffness"

stiffness = Stiffness()
"""
GOOD = """
[mobius_flow.commands]
count = planted:add_count
[mobius_flow.methods]
several = planted:mine
[mobius_flow.terms]
stiffness = planted:stiffness
[mobius_flow.formats]
.columns = planted:columns
"""


@pytest.fixture
def planted(tmp_path):
    """Install a package by hand, with the entry points given, and give the directory that it is in."""

    def plant(text):
        info = tmp_path / "planted_package-1.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text("Metadata-Version: 2.1\nName: planted-package\nVersion: 1.0\n")
        (info / "entry_points.txt").write_text(text)
        (tmp_path / "planted.py").write_text(MODULE)
        return tmp_path

    return plant


LINES = "import sys; from mobius_flow.cli.main import main; sys.exit(max(main(line.split()) for line in sys.argv[1:]))"


def test_the_projects_own_entry_points_are_there():
    project = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    for group, entries in project["entry-points"].items():
        assert all(EntryPoint(name, value, group).load() for name, value in entries.items())
        assert {each.name for each in entry_points(group=group)} >= set(entries), "install the project again"


def test_a_package_adds_to_every_table(planted):
    """In a process that finds what is planted where it is started."""
    place = planted(GOOD)
    write_curve(place / "in.txt", torus_trefoil(40))
    given = "--method mine --term stiffness=0.1 --max-iterations 2 --vertices 40"
    lines = "--help", "count in.txt", "methods", f"relax in.txt out.columns {given}", "relax --help-all"
    done = finished([sys.executable, "-c", LINES, *lines], cwd=place)
    assert done.returncode == 0, done.stderr
    (place / "out.columns").rename(place / "out.txt")
    assert len(read_curve(place / "out.txt")) == 40
    for said in ("count vertices\n", "\n40\n", "\nmine\t", ".columns"):
        assert said in done.stdout
    assert "by name: bending, stiffness" in " ".join(done.stdout.split())


@pytest.mark.parametrize(
    ("entry", "why"),
    [
        ("other = missing_module:thing", "No module named 'missing_module'"),
        ("other = os:missing", "has no attribute 'missing'"),
        ("old = os:getcwd", "old exists already"),
        ("other = os:sep", "os:sep is not what belongs there"),
        ("other = os:environ", "os:environ is not what belongs there"),
    ],
)
def test_what_cannot_join_a_table_is_left_out(entry, why, planted, monkeypatch, caplog):
    monkeypatch.syspath_prepend(planted(f"[planted.things]\nsecond = os:getpid\n{entry}\n"))
    table = Table("planted.things", callable, {"old": len})
    with caplog.at_level(logging.WARNING):
        assert table["old"] is len
        assert not caplog.messages  # what is built in needs no package
        assert dict(table) == {"old": len, "second": os.getpid}
    (told,) = caplog.messages
    assert "of the package planted-package" in told
    assert why in told


@pytest.mark.parametrize(
    ("entry", "why"),
    [
        ("count = missing_module:thing", "No module named 'missing_module'"),
        ("count = os:sep", "object is not callable"),
        ("relax = planted:add_count", "there is such a command already"),
    ],
)
def test_commands_that_cannot_join_leave_the_others(entry, why, planted, monkeypatch, capsys):
    monkeypatch.syspath_prepend(planted(f"[mobius_flow.commands]\n{entry}\n"))
    joined.cache_clear()
    try:
        assert main(["--help"]) == 0
        out, err = capsys.readouterr()
        assert "relax a curve" in out
        if not entry.startswith("relax"):
            assert main(["count", "in.txt"]) == 1
            err = capsys.readouterr().err
        (told,) = err.splitlines()
        assert told.startswith("mobius-flow: ")
        assert "of the package planted-package, is left out" in told
        assert why in told
        assert main(["methods"]) == 0
    finally:
        joined.cache_clear()


def test_without_an_installation_one_sentence_tells_what_is_missing(monkeypatch, capsys):
    monkeypatch.setattr("mobius_flow.cli.parser.entry_points", lambda **_: ())
    joined.cache_clear()
    try:
        assert main(["batch", "3_1", "-o", "results"]) == 2
        first, second = capsys.readouterr().err.splitlines()
        assert "'batch' is unknown" in first
        assert (
            second
            == "mobius-flow: batch, atlas, gallery, compare and methods need an installation: python -m pip install ."
        )
    finally:
        joined.cache_clear()
