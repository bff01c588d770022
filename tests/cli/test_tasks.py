"""Pins, obstacles, growth and open components on the command line; what they do to curves is tested in the core."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.cli import places
from mobius_flow.core import read_curve, write_curve
from mobius_flow.core.knots import knot
from shapes import half_circle, regular_polygon, torus_trefoil
from solids import plate

BENT = torus_trefoil(60).with_vertices(torus_trefoil(60).vertices * [1.0, 1.3, 1.1])
SHORT = ["--vertices", "120", "--max-iterations", "4", "--quiet"]
BOTH = ["--report", "r.json", "--trajectory", "t.npz"]


@pytest.fixture(autouse=True)
def walls(room):
    write_curve("bent.obj", BENT)
    trefoil = torus_trefoil(60)
    write_curve("trefoil.txt", trefoil.with_vertices(trefoil.vertices * [1.0, 1.0, 0.9]))
    for name, height in (("ceiling", 0.95), ("floor", -0.95), ("wall", 0.3)):
        obstacle = plate(height)
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in obstacle.vertices.tolist()]
        lines += ["f " + " ".join(str(k + 1) for k in face) for face in obstacle.faces.tolist()]
        Path(f"{name}.obj").write_text("\n".join(lines) + "\n")
    write_curve("ring.json", regular_polygon(30).with_vertices(9.0 * regular_polygon(30).vertices))


def report():
    return json.loads(Path("r.json").read_text())


def vertices_of(path):
    return {tuple(vertex) for vertex in read_curve(path).vertices.tolist()}


def test_obstacles_are_avoided_reported_and_verified(run):
    write_curve("ring.txt", read_curve("ring.json"))
    avoid = [word for name in ("ceiling.obj", "floor.obj", "ring.txt") for word in ("--avoid", name)]
    assert run("relax", "trefoil.txt", "o.txt", *BOTH, "--max-iterations", 8, *avoid)[0] in (0, 1)
    assert np.abs(read_curve("o.txt").vertices[:, 2]).max() < 0.95
    assert report()["obstacles"] == 3
    assert report()["options"]["avoid"] == ["ceiling.obj", "floor.obj", "ring.txt"]
    status, told, _ = run("verify", "t.npz")
    assert status == 0
    assert "in 1 stage, nor with 3 obstacles; a rope of radius" in told
    verdict = json.loads(run("verify", "t.npz", "--json")[1])
    assert (verdict["obstacles"], verdict["obstacle"]) == (3, None)


def test_a_verdict_names_the_obstacle_counted_from_one(run):
    arrays = {"stage_000": torus_trefoil(60).vertices[None], "component_sizes_000": np.array([60])}
    wall = plate(0.2)
    np.savez("t.npz", **arrays, obstacle_000_vertices=wall.vertices, obstacle_000_faces=wall.faces)
    status, told, _ = run("verify", "t.npz", "--json")
    verdict = json.loads(told)
    assert (status, verdict["obstacle"]) == (1, 1)
    assert verdict["reason"] == f"edge {verdict['edges'][0]} meets obstacle 1 (counted from 1)"


@pytest.mark.parametrize("words", [["--pin", "12,40"], ["--pin=12", "--pin", " 40 "]])
def test_pinned_vertices_are_in_the_result_and_in_the_report(words, run):
    assert run("relax", "bent.obj", "out.obj", *BOTH, *words, *SHORT)[0] == 0
    assert run("verify", "t.npz")[0] == 0
    assert report()["options"]["pins"] == [11, 39]
    np.testing.assert_array_equal(read_curve("out.obj").vertices[report()["pins"]], BENT.vertices[[11, 39]])
    assert not vertices_of("bent.obj") <= vertices_of("out.obj")


def test_tangents_are_pinned_by_neighbours(run):
    assert run("relax", "bent.obj", "out.obj", "--report", "r.json", "--pin", "12", "--pin-tangents", *SHORT)[0] == 0
    first, middle, last = report()["pins"]
    assert (last - middle, middle - first) == (1, 1)
    assert tuple(read_curve("out.obj").vertices[middle]) == tuple(BENT.vertices[11])


def test_vertices_are_counted_as_the_file_does(run):
    """OBJ lists vertices in any order, those of other things among them; one that closes a polygon is its first."""
    order = np.random.default_rng(107).permutation(60)
    number = np.argsort(order) + 2  # after one that is on no line
    lines = ["v 9 9 9", *(f"v {x!r} {y!r} {z!r}" for x, y, z in BENT.vertices[order].tolist())]
    lines += [f"l {number[k]} {number[(k + 1) % 60]}" for k in range(60)]
    Path("shuffled.obj").write_text("\n".join(lines))
    words = ["--pin", f"{number[11]},{number[39]}", "--report", "r.json"]
    assert run("relax", "shuffled.obj", "out.obj", *words, *SHORT)[0] == 0
    assert set(map(tuple, BENT.vertices[[11, 39]].tolist())) <= vertices_of("out.obj")
    assert len(report()["pins"]) == 2
    points = [*BENT.vertices.tolist(), BENT.vertices[0].tolist()]
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points] + [f"l {' '.join(map(str, range(1, 62)))}"]
    Path("closed.obj").write_text("\n".join(lines))
    assert run("relax", "closed.obj", "out.obj", "--pin", "61", *SHORT)[0] == 0
    assert tuple(BENT.vertices[0]) in vertices_of("out.obj")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("bent.obj out.obj --pin 0", "'0' is not a vertex number; count from 1, such as 12,40"),
        ("bent.obj out.obj --pin 3,", "'' is not a vertex number; count from 1, such as 12,40"),
        (f"bent.obj out.obj --pin {'9' * 30}", "there is no vertex 9"),
        ("bent.obj out.obj --pin 61", "bent.obj: there is no vertex 61 on the curve"),
        ("bent.obj out.obj --pin 5,7,5", "pins names vertex 5 more than once"),
        ("bent.obj out.obj --pin 5 --balance", "balance would move pins, as Möbius maps do; leave one"),
        ("trefoil.txt out.txt --avoid wall.obj", "pierces obstacle wall.obj at ("),
        ("trefoil.txt out.txt --avoid none.obj", "none.obj: cannot be read"),
        ("trefoil.txt out.txt --avoid bad.obj", "bad.obj, line 2: vertex 3 does not exist; there are 1"),
        ("trefoil.txt out.txt --avoid pipe.obj", "obstacles are not read from pipes"),
        ("trefoil.txt ring.json --avoid ring.json", "ring.json: --avoid ring.json and "),
        *((f"trefoil.txt out.txt --grow={factor}", "grow") for factor in ("0", "twice")),
        ("back.txt out.txt", "line 3: the curve doubles back at vertex 2 of component 1, (2, 0, 0); move or"),
        *((f"arc.txt out{each}", "component 1 is open; codes of diagrams are for") for each in (".pd", ".gauss")),
        ("arc.txt out.txt --balance", "Möbius images of equal energy"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(words, said, monkeypatch, refused):
    monkeypatch.setattr(places.export, "require_blender", lambda: None)
    Path("bad.obj").write_text("v 0 0 0\nf 1 2 3\n")
    Path("back.txt").write_text("# open\n0 0 0\n2 0 0\n1 0 0\n")
    write_curve("arc.txt", knot("overhand", 50))
    if "pipe.obj" in words:
        pytest.importorskip("fcntl")
        os.mkfifo("pipe.obj")
    before = Path("ring.json").read_text()
    assert said in refused("relax", *words.split(" "))
    if "ring.json" in words:
        refused("compare", "trefoil.txt", "-o", "ring.json", "--avoid", "ring.json")
    assert Path("ring.json").read_text() == before
    assert not list(Path().glob("out.*"))


def test_an_arc_has_enough_vertices_and_the_energy_of_half_a_circle_is_known(run, refused):
    assert "39 vertices are too few for this arc; give 40 or more" in refused(
        "knot", "overhand", "a.txt", "--vertices", 39
    )
    write_curve("half.txt", half_circle(400))
    assert float(run("energy", "half.txt")[1]) == pytest.approx(2 * np.log(np.pi / 2), rel=1e-5)
