"""The command line's contract: names, formats, exit statuses, one line for every error."""

import json
import os
import re
import sys

import numpy as np
import pytest
from mobius_flow.cli import main, places, view
from mobius_flow.core import METHODS, read_curve, write_curve
from mobius_flow.core.descent import Method
from mobius_flow.core.driver.info import measure
from mobius_flow.core.knots import knot, knot_names, smooth_knot
from processes import finished
from shapes import regular_polygon, torus_trefoil


@pytest.fixture
def trefoil(tmp_path):
    path = tmp_path / "trefoil.txt"
    write_curve(path, torus_trefoil(60))
    return path


def run(*arguments):
    return main([str(argument) for argument in arguments])


def test_relax_writes_curve_report_and_trajectory(trefoil, tmp_path, capsys):
    out, report, trajectory = tmp_path / "out.obj", tmp_path / "r.json", tmp_path / "t.npz"
    assert run("relax", trefoil, out, "--report", report, "--trajectory", trajectory, "--vertices", 80) == 0
    captured = capsys.readouterr()
    assert captured.out == ""
    said = dict(line[2:].split(maxsplit=1) for line in captured.err.splitlines())
    assert said["converged"].endswith(" · 80 vertices")
    assert said["wrote"].split() == list(map(str, (out, report, trajectory)))
    assert said["next"] == f"mobius-flow verify {trajectory}"
    assert said["certified"] == "no contact on the whole path"
    values = json.loads(report.read_text())
    assert values["status"] == "converged"
    assert values["vertices"] == 80 == len(read_curve(out))
    assert run("verify", trajectory) == 0


def test_energies_have_the_digits_that_the_mesh_leaves_them(tmp_path, capsys):
    """The objective is told where strands are so near that the barrier acts."""
    start, out, report = tmp_path / "in.txt", tmp_path / "out.txt", tmp_path / "r.json"
    write_curve(start, knot("8_19", vertices=60))
    assert run("relax", start, out, "--report", report, "--vertices", 60, "--max-iterations", 5) == 0
    said, values = capsys.readouterr().err, json.loads(report.read_text())
    assert run("energy", out) == 0
    energy = float(capsys.readouterr().out)
    assert values["final_energy"] == pytest.approx(energy)
    assert said.startswith("– iteration limit  5 iterations · ")
    first, last, share = map(float, re.search(r"energy +(\S+) → (\S+) \(mesh error about (\S+) %\)", said).groups())
    assert first == pytest.approx(measure(read_curve(start)), rel=0.01)
    assert last == pytest.approx(energy, abs=0.1 * share / 100 * energy)
    assert last != energy
    first, last = map(float, re.search(r"objective +(\S+) → (\S+), which is minimised", said).groups())
    assert [first, last] == pytest.approx([values["energy"][0], values["energy"][-1]], rel=0.1 * share / 100)


def test_an_unknown_knot_is_told_where_the_names_are(tmp_path, capsys):
    for smooth in ([], ["--smooth"]):
        assert run("knot", "nonsense", tmp_path / "k.vect", *smooth) == 2
        assert "no knot is called 'nonsense'" in (said := capsys.readouterr().err)
        assert said.endswith("; see mobius-flow knot --list\n")


def test_compare_prints_objectives(trefoil, tmp_path, capsys):
    assert run("compare", trefoil, "--methods", "cg", "--max-iterations", 1, "-o", tmp_path / "c.json") == 0
    last = json.loads((tmp_path / "c.json").read_text())[0]["energy"][-1]
    shown = capsys.readouterr().out.splitlines()
    assert shown[0].split() == ["method", "status", "iterations", "rises", "fallback", "s", "objective", "gradient"]
    assert f"{last:.6g}" in shown[1].split()


def test_quiet(trefoil, tmp_path, capsys):
    assert run("relax", trefoil, tmp_path / "o.txt", "--quiet", "--max-iterations", 1) == 0
    captured = capsys.readouterr()
    assert captured.out + captured.err == ""


def test_energy(tmp_path, capsys):
    path = tmp_path / "circle.xyz"
    write_curve(path, regular_polygon(50))
    assert run("energy", path) == 0
    assert float(capsys.readouterr().out) == pytest.approx(4)
    assert run("energy", path, "--json", "--energy", "moebius") == 0
    assert json.loads(capsys.readouterr().out) == {"name": "moebius", "energy": pytest.approx(4)}


def test_methods_are_names_and_descriptions(capsys):
    assert run("methods") == 0
    lines = [line.split("\t") for line in capsys.readouterr().out.splitlines()]
    assert [name for name, _ in lines] == list(METHODS)
    for name, words in lines:
        assert words == METHODS[name].sentence
        assert words.startswith(f"{METHODS[name].label}: ")
    assert [METHODS[name].comparison for name, _ in lines] == sorted(METHODS[name].comparison for name, _ in lines)


def test_methods_are_a_table_in_a_terminal(monkeypatch, capsys):
    monkeypatch.setattr("mobius_flow.lab.compare.command.width_of", lambda _: 80)
    monkeypatch.setattr("mobius_flow.cli.terminal.width_of", lambda _: 80)
    assert run("methods") == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["method", "what", "it", "is"]
    assert len(lines) > len(METHODS) + 1
    assert max(map(len, lines)) < 80


def test_what_knot_writes_comes_next(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run("knot", "3_1", "$(touch x).txt") == 0
    said = "✓ wrote       '$(touch x).txt'\n  next        mobius-flow relax '$(touch x).txt' relaxed.obj\n"
    assert capsys.readouterr() == ("", said)


def test_a_list_makes_its_directory(tmp_path, capsys):
    (tmp_path / "list.txt").write_text("3_1\n4_1\n")
    assert run("knot", tmp_path / "list.txt", tmp_path / "new/knots") == 0
    assert sorted(os.listdir(tmp_path / "new/knots")) == ["3_1.txt", "4_1.txt"]
    assert capsys.readouterr().err == f"✓ 2 knots     {tmp_path}/new/knots\n"


def test_what_relax_does_not_write_view_does(trefoil, tmp_path, capsys):
    assert run("relax", trefoil, tmp_path / "o.stl") == 2
    assert capsys.readouterr().err.endswith("; mobius-flow view makes .stl of one of those\n")
    assert set(places.VIEWED) == set(view.WRITERS)


@pytest.mark.parametrize("words", [("atlas", "results", "-o"), ("knot", "list.txt"), ("batch", "3_1", "-o")])
def test_a_directory_that_cannot_be_written_is_noticed_before_any_work(words, tmp_path, monkeypatch, capsys):
    """As in one that is read-only, which does not stop the superuser of this test."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "list.txt").write_text("3_1\n")
    (tmp_path / "file").touch()
    assert run(*words, "file/out") == 2
    assert "file/out: cannot be written" in capsys.readouterr().err


def test_a_method_without_a_label_is_called_by_its_name():
    bare = Method("bare", "nothing but what it is", METHODS["cg"].rule)
    assert (bare.label, bare.sentence, bare.comparison) == ("bare", "nothing but what it is", False)


def test_knot(tmp_path):
    assert run("knot", "3_1", tmp_path / "k.vect") == 0
    assert len(read_curve(tmp_path / "k.vect")) > 10


def test_smooth_knots(tmp_path, capsys):
    assert run("knot", "m7_4", tmp_path / "k.vect", "--smooth", "--vertices", 150) == 0
    np.testing.assert_allclose(read_curve(tmp_path / "k.vect").vertices, smooth_knot("m7_4", 150).vertices)
    assert run("knot", "T(2,3)", tmp_path / "t.vect", "--smooth") == 2
    assert "none of the table" in capsys.readouterr().err


def test_knots_are_listed(capsys):
    assert run("knot", "--list") == 0
    names = capsys.readouterr().out.splitlines()
    assert names == knot_names()


@pytest.mark.slow
def test_knots_that_no_command_reads_are_not_written(tmp_path, capsys):
    path = tmp_path / "k.txt"
    assert run("knot", "T(300,301)", path) == 2
    assert "give --vertices 200000" in capsys.readouterr().err
    assert not path.exists()
    assert run("knot", "T(300,301)", path, "--vertices", 200_000) == 0
    assert len(read_curve(path)) == 200_000


def test_module_is_the_same_program():
    done = finished([sys.executable, "-m", "mobius_flow", "methods"])
    assert done.stdout.startswith("lbfgs\t")


def test_an_interrupted_film_keeps_report_and_trajectory(trefoil, tmp_path, monkeypatch, capsys):
    def interrupted(*_arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr(places.export, "require_blender", lambda: None)
    monkeypatch.setattr(places.export, "write_movie", interrupted)
    report, trajectory = tmp_path / "r.json", tmp_path / "t.npz"
    extras = ["--report", report, "--trajectory", trajectory, "--max-iterations", "2"]
    assert run("relax", trefoil, tmp_path / "film.mp4", *extras) == 130
    assert json.loads(report.read_text())["status"] == "iteration_limit"
    assert run("verify", trajectory) == 0
    said = capsys.readouterr().err
    assert said.startswith("mobius-flow: interrupted: ")
    assert said.count("\n") == 1


BAD = {
    "two points": ("0 0 0\n1 0 0\n", "2 vertices"),
    "not a number": ("0 0 0\n1 x 0\n0 1 0\n", "line 2"),
    "nan": ("0 0 0\n1 nan 0\n0 1 0\n", "line 2"),
    "repeated point": ("0 0 0\n1 0 0\n1 0 0\n0 1 0\n", "same"),
    "doubled back": ("0 0 0\n2 0 0\n1 0 0\n1 1 0\n", "back"),
    "touching": ("0 0 0\n2 0 0\n2 1 0\n1 0 0\n1 -1 0\n", "edge"),
    "empty": ("", "empty"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_curves_are_one_line_and_leave_nothing(name, tmp_path, capsys):
    text, expected = BAD[name]
    path = tmp_path / "bad.txt"
    path.write_text(text)
    assert run("relax", path, tmp_path / "o.txt", "--report", tmp_path / "r.json") == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert expected in error
    assert sorted(os.listdir(tmp_path)) == ["bad.txt"]


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        ("relax trefoil.txt o.txt --method magic", "lbfgs"),
        ("relax trefoil.txt o.txt --tolerance -1", "tolerance"),
        ("relax trefoil.txt o.txt --tolerance x", "--tolerance"),
        ("relax trefoil.txt o.txt --max-iterations -3", "max_iterations"),
        ("relax trefoil.txt o.txt --vertices 5", "vertices"),
        ("relax trefoil.txt o.txt --nonsense", "option --nonsense is unknown"),
        ("--nonsense", "option --nonsense is unknown"),
        ("energy", "IN"),
        ("relax trefoil.txt o.gif", "--format"),
        ("relax trefoil.txt no/such/o.txt", "does not exist"),
        ("relax trefoil.txt .", "is a directory"),
        ("relax . o.obj", "mobius-flow: .: is a directory; name a file\n"),
        ("relax trefoil.txt o.txt --report no/such", "no/such"),
        ("relax trefoil.txt o.txt --trajectory no/such", "no/such"),
        ("energy none.txt", "none.txt"),
        ("energy trefoil.txt --energy gravity", "moebius"),
        ("energy a.obj", "a.obj"),
    ],
)
def test_refusals_are_one_line_and_leave_nothing(command, expected, trefoil, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    with open("a.obj", "wb") as array:
        np.save(array, np.zeros(3))
    before = set(os.listdir())
    assert run(*command.split()) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert expected in error
    assert set(os.listdir()) == before


def test_names_with_line_ends_stay_on_one_line(capsys):
    for arguments in (["relax", "a.txt", "b\nc"], ["energy", "no\nfile.txt"], ["no\ncommand"]):
        assert main(arguments) == 2
        assert capsys.readouterr().err.count("\n") == 1
