"""Pins on the command line: counted from 1, as the file counts its vertices."""

import json
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.cli import main
from mobius_flow.core import Curve, read_curve, write_curve
from shapes import torus_trefoil

BENT = torus_trefoil(60).with_vertices(torus_trefoil(60).vertices * [1.0, 1.3, 1.1])
SHORT = ["--vertices", "120", "--max-iterations", "4", "--quiet"]


@pytest.fixture(autouse=True)
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_curve("bent.obj", BENT)


def places(curve: Curve) -> set[tuple[float, ...]]:
    return {tuple(vertex) for vertex in curve.vertices.tolist()}


@pytest.mark.parametrize("words", [["--pin", "12,40"], ["--pin=12", "--pin", " 40 "]])
def test_pinned_vertices_are_in_the_result_and_in_the_report(words: list[str]) -> None:
    outputs = ["out.obj", "--report", "report.json", "--trajectory", "path.npz"]
    assert main(["relax", "bent.obj", *outputs, *words, *SHORT]) == 0
    assert main(["verify", "path.npz"]) == 0
    report, end = json.loads(Path("report.json").read_text()), read_curve("out.obj")
    assert report["options"]["pins"] == [11, 39]
    np.testing.assert_array_equal(end.vertices[report["pins"]], BENT.vertices[[11, 39]])
    assert not places(BENT) <= places(end)


def test_tangents_are_pinned_by_neighbours() -> None:
    assert main(["relax", "bent.obj", "out.obj", "--report", "r.json", "--pin", "12", "--pin-tangents", *SHORT]) == 0
    report = json.loads(Path("r.json").read_text())
    first, middle, last = report["pins"]
    assert (last - middle, middle - first) == (1, 1)
    assert tuple(read_curve("out.obj").vertices[middle]) == tuple(BENT.vertices[11])


def test_vertices_are_counted_as_the_file_does() -> None:
    """OBJ lists vertices in any order, and those of other things among them; lines say how the curve runs."""
    order = np.random.default_rng(107).permutation(60)
    number = np.argsort(order) + 2  # after one that is on no line
    lines = ["v 9 9 9", *(f"v {x!r} {y!r} {z!r}" for x, y, z in BENT.vertices[order].tolist())]
    lines += [f"l {number[k]} {number[(k + 1) % 60]}" for k in range(60)]
    Path("shuffled.obj").write_text("\n".join(lines))
    words = ["--pin", f"{number[11]},{number[39]}", "--report", "r.json"]
    assert main(["relax", "shuffled.obj", "out.obj", *words, *SHORT]) == 0
    assert {tuple(BENT.vertices[11].tolist()), tuple(BENT.vertices[39].tolist())} <= places(read_curve("out.obj"))
    assert len(json.loads(Path("r.json").read_text())["pins"]) == 2


def test_a_vertex_that_closes_a_polygon_is_its_first() -> None:
    points = [*BENT.vertices.tolist(), BENT.vertices[0].tolist()]
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points] + [f"l {' '.join(map(str, range(1, 62)))}"]
    Path("closed.obj").write_text("\n".join(lines))
    assert main(["relax", "closed.obj", "out.obj", "--pin", "61", *SHORT]) == 0
    assert tuple(BENT.vertices[0]) in places(read_curve("out.obj"))


def test_compare_takes_pins() -> None:
    words = ["--methods", "lbfgs,cg", "--pin", "12,40", "--max-iterations", "2", "-o", "table.csv"]
    assert main(["compare", "bent.obj", *words]) == 0
    assert len(Path("table.csv").read_text().splitlines()) == 7


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--pin", "0"], "'0' is not a vertex number; count from 1, such as 12,40"),
        (["--pin", "3,"], "'' is not a vertex number; count from 1, such as 12,40"),
        (["--pin", "a"], "'a' is not a vertex number; count from 1, such as 12,40"),
        (["--pin", "9" * 30], "there is no vertex 9"),
        (["--pin", "61"], "bent.obj: there is no vertex 61 on the curve"),
        (["--pin", "5,7,5"], "pins names vertex 5 more than once"),
        (["--pin", "5", "--pin", "5"], "pins names vertex 5 more than once"),
        (["--pin", "5", "--balance"], "balance would move pins, as Möbius maps do; leave one of the two out"),
    ],
)
def test_pins_that_cannot_be_are_refused_in_one_line(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["relax", "bent.obj", "out.obj", *words]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
    assert not Path("out.obj").exists()
