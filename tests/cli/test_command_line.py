"""The command line's contract: names, formats, exit statuses, one line for every error."""

import hashlib
import json
import os
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from commands import PROGRAM, SHORT
from mobius_flow import __version__
from mobius_flow.core import METHODS, read_curve, write_curve
from mobius_flow.core.descent import Method
from mobius_flow.core.driver.info import measure
from mobius_flow.core.knots import knot, knot_names, smooth_knot
from mobius_flow.core.proof import verify
from processes import finished
from shapes import regular_polygon

pytestmark = pytest.mark.usefixtures("room")


def test_relax_writes_curve_report_and_trajectory(run):
    words = "relax trefoil.txt o.obj --report r.json --trajectory t.npz --vertices 80"
    status, out, err = run(*words.split())
    assert (status, out) == (0, "")
    said = dict(line[2:].split(maxsplit=1) for line in err.splitlines())
    assert said["converged"].endswith(" · 80 vertices")
    assert said["wrote"].split() == ["o.obj", "r.json", "t.npz"]
    assert said["next"] == "mobius-flow verify t.npz"
    assert re.fullmatch(r"a rope of radius 0\.75\d* on the whole path", said["certified"])
    values = json.loads(Path("r.json").read_text())
    assert (values["status"], values["vertices"], len(read_curve("o.obj"))) == ("converged", 80, 80)
    assert run("verify", "t.npz")[0] == 0
    assert run("relax", "trefoil.txt", "o.txt", "--quiet", *SHORT) == (0, "", "")


def test_results_tell_where_they_come_from(run):
    run("relax", "trefoil.txt", "o.txt", "--report", "r.json", "--trajectory", "t.npz", "--tolerance", "0.25", *SHORT)
    values = json.loads(Path("r.json").read_text())
    assert (values["version"], values["numpy"], values["blas_threads"]) == (__version__, np.__version__, 1)
    assert (values["options"]["tolerance"], values["options"]["method"]) == (0.25, "lbfgs")
    sha256 = hashlib.sha256(Path("trefoil.txt").read_bytes()).hexdigest()
    assert values["input"] == {"name": "trefoil.txt", "sha256": sha256}
    with np.load("t.npz", allow_pickle=False) as archive:
        origin = json.loads(str(archive["provenance"]))
    assert origin.items() <= values.items()
    assert set(origin) == {"version", "options", "input", "blas_threads", "python", "numpy", "scipy"}
    assert verify("t.npz").accepted


def test_energies_have_the_digits_that_the_mesh_leaves_them(run):
    write_curve("in.txt", knot("8_19", vertices=60))
    words = "relax in.txt out.txt --report r.json --vertices 60 --max-iterations 5"
    said, values = run(*words.split())[2], json.loads(Path("r.json").read_text())
    energy = float(run("energy", "out.txt")[1])
    assert values["final_energy"] == pytest.approx(energy)
    assert said.startswith("– iteration limit  5 iterations · ")
    first, last, share = map(float, re.search(r"energy +(\S+) → (\S+) \(mesh error about (\S+) %\)", said).groups())
    assert first == pytest.approx(measure(read_curve("in.txt")), rel=0.01)
    assert last == pytest.approx(energy, abs=0.1 * share / 100 * energy)
    assert last != energy
    first, last = map(float, re.search(r"objective +(\S+) → (\S+), which is minimised", said).groups())
    assert [first, last] == pytest.approx([values["energy"][0], values["energy"][-1]], rel=0.1 * share / 100)


def test_energy(run):
    write_curve("circle.xyz", regular_polygon(50))
    assert float(run("energy", "circle.xyz")[1]) == pytest.approx(4)
    found = json.loads(run("energy", "circle.xyz", "--json", "--energy", "moebius")[1])
    assert found == {"name": "moebius", "energy": pytest.approx(4)}


def test_methods_are_names_and_descriptions_and_a_table_in_a_terminal(monkeypatch, run):
    lines = [line.split("\t") for line in run("methods")[1].splitlines()]
    assert [name for name, _ in lines] == list(METHODS)
    for name, words in lines:
        assert words == METHODS[name].sentence
        assert words.startswith(f"{METHODS[name].label}: ")
    assert [METHODS[name].comparison for name, _ in lines] == sorted(METHODS[name].comparison for name, _ in lines)
    assert finished([*PROGRAM, "methods"]).stdout.startswith("lbfgs\t")
    for module in ("lab.compare.command", "cli.terminal"):
        monkeypatch.setattr(f"mobius_flow.{module}.width_of", lambda _: 80)
    lines = run("methods")[1].splitlines()
    assert lines[0].split() == ["method", "what", "it", "is"]
    assert len(lines) > len(METHODS) + 1
    assert max(map(len, lines)) < 80


def test_a_method_without_a_label_is_called_by_its_name():
    bare = Method("bare", "nothing but what it is", METHODS["cg"].rule)
    assert (bare.label, bare.sentence, bare.comparison) == ("bare", "nothing but what it is", False)


def test_knots_are_listed_written_smooth_and_in_directories(run, refused):
    assert run("knot", "--list")[1].splitlines() == knot_names()
    said = "✓ wrote       '$(touch x).txt'\n  next        mobius-flow relax '$(touch x).txt' relaxed.obj\n"
    assert run("knot", "3_1", "$(touch x).txt") == (0, "", said)
    assert len(read_curve("$(touch x).txt")) > 10
    assert run("knot", "m7_4", "k.vect", "--smooth", "--vertices", "150")[0] == 0
    np.testing.assert_allclose(read_curve("k.vect").vertices, smooth_knot("m7_4", 150).vertices)
    assert "none of the table" in refused("knot", "T(2,3)", "t.vect", "--smooth")
    for smooth in ([], ["--smooth"]):
        said = refused("knot", "nonsense", "k.vect", *smooth)
        assert "no knot is called 'nonsense'" in said
        assert said.endswith("; see mobius-flow knot --list\n")
    Path("list.txt").write_text("3_1\n4_1\n")
    assert run("knot", "list.txt", "new/knots") == (0, "", "✓ 2 knots     new/knots\n")
    assert sorted(os.listdir("new/knots")) == ["3_1.txt", "4_1.txt"]


def test_version(run):
    assert run("--version")[1] == f"mobius-flow {__version__}\n"
    project = tomllib.loads((Path(__file__).resolve().parents[2] / "pyproject.toml").read_text(encoding="utf-8"))
    assert __version__ == project["project"]["version"]


def test_the_bare_command_prints_help(run):
    status, out, err = run()
    assert (status, err) == (2, "mobius-flow: name a command\n")
    assert "exit status" in out


@pytest.mark.parametrize("command", ["relax", "energy", "verify", "compare", "knot", "methods"])
def test_help_has_exit_statuses_and_no_markup(command, run):
    status, text, _ = run(command, "--help")
    assert status == 0
    assert "exit status" in text
    assert command == "methods" or "example" in text
    assert "``" not in text


@pytest.mark.parametrize(
    ("error", "status", "words"),
    [
        (MemoryError(), 1, "not enough memory"),
        (OSError(28, "No space left on device", "x.txt"), 2, "x.txt: No space left on device"),
        (ZeroDivisionError("oh"), 1, "ZeroDivisionError: oh"),
        (KeyboardInterrupt(), 130, "interrupted"),
    ],
)
def test_whatever_a_command_raises(monkeypatch, run, error, status, words):
    def failing(*_):
        raise error

    monkeypatch.setattr("mobius_flow.cli.info.measure", failing)
    found, _, said = run("energy", "trefoil.txt")
    assert (found, said.count("\n")) == (status, 1)
    assert words in said


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("relx", "did you mean relax"),
        ("relax IN OUT --vertice 5", "did you mean --vertices"),
        ("relax IN o.txt --max 5", "did you mean --max-iterations"),
        ("relax IN o.txt --method trust", "did you mean trust-region"),
        ("--verison", "did you mean --version"),
        ("relax IN o.txt --method lbgfs", "did you mean lbfgs"),
        ("relax IN o.txt --energy moebus", "did you mean moebius"),
        ("relax IN o.txt --metric moebus", "did you mean moebius"),
        ("relax IN o.obk", "did you mean .obj"),
        ("energy a.jsn", "did you mean .json"),
        ("energy IN --energy vertx", "did you mean vertex"),
        ("energy IN --format jsn", "did you mean json"),
        ("compare IN -o a.cvs", "did you mean .csv"),
        ("knot figure-eigth k.txt", "did you mean figure eight"),
        ("--vers", "--vers"),  # there are no abbreviations
        ("energy IN --js", "--js"),
        ("relax IN o.txt --method magic", "lbfgs"),
        ("relax IN o.txt --tolerance -1", "tolerance"),
        ("relax IN o.txt --tolerance x", "--tolerance"),
        ("relax IN o.txt --max-iterations -3", "max_iterations"),
        ("relax IN o.txt --vertices 5", "vertices"),
        ("relax IN o.txt --nonsense", "option --nonsense is unknown"),
        ("--nonsense", "option --nonsense is unknown"),
        *((f"{command} --vertices {n}", f"vertices is {n}") for command in ("relax IN o.txt", "compare IN -o c.csv")
          for n in ("200001", "1000000", "9" * 40)),
        ("energy", "IN"),
        ("relax IN o.gif", "--format"),
        ("relax . o.obj", "mobius-flow: .: is a directory; name a file\n"),
        ("energy none.txt", "none.txt"),
        ("energy IN --energy gravity", "moebius"),
        ("energy a.obj", "a.obj"),
        ("relax IN o.txt --pin-tangents", "pin_tangents pins the neighbours of pins, but there are none; give pins"),
    ],
)  # fmt: skip
def test_refusals_are_one_line_and_leave_nothing(command, said, refused):
    with open("a.obj", "wb") as array:
        np.save(array, np.zeros(3))
    before = sorted(os.listdir())
    assert said in refused(*["trefoil.txt" if word == "IN" else word for word in command.split()])
    assert sorted(os.listdir()) == before


def test_names_with_line_ends_stay_on_one_line(refused):
    for arguments in (["relax", "a.txt", "b\nc"], ["energy", "no\nfile.txt"], ["no\ncommand"]):
        refused(*arguments)


BAD = {  # what is in a file, and what is said, with the line where there is one
    "number.txt": ("0 0 0\n1 x 0\n0 1 0\n", "line 2"),
    "repeated.txt": ("0 0 0\n1 0 0\n# more\n1 1 0\n1 1 0\n0 1 0\n", ", line 4: "),
    "back.obj": ("v 0 0 0\nv 2 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3 4 1\n", ", line 2: "),
    "empty.txt": ("", "empty"),
    # refused after something was noted
    "faces.obj": ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2 1\n", ", line "),
    "closing.txt": ("0 0 0\n1 0 0\n1 0 0\n0 1 0\n0 0 0\n", ", line "),
}


@pytest.mark.parametrize("name", BAD)
@pytest.mark.parametrize("command", ["relax IN o.txt --report r.json", "energy IN", "compare IN -o o.csv"])
def test_bad_curves_are_one_line_that_names_the_file_and_leave_nothing(name, command, refused):
    text, expected = BAD[name]
    Path(name).write_text(text)
    said = refused(*command.replace("IN", name).split())
    assert said.startswith(f"mobius-flow: {name}")
    assert expected in said
    assert sorted(os.listdir()) == sorted([name, "trefoil.txt"])


def test_notes_are_printed_unless_quiet(run):
    Path("closing.txt").write_text("0 0 0\n1 0 0\n1 1 0\n0 1 1\n0 0 0\n")
    words = ["relax", "closing.txt", "o.txt", "--max-iterations", "1"]
    assert run(*words, "--quiet")[2] == ""
    assert "repeats its first; dropped" in run(*words)[2].splitlines()[0]
    assert "repeats its first; dropped" in run("energy", "closing.txt")[2]
