"""``mobius-flow separate`` and ``tighten`` from the terminal's point of view."""

import json
from pathlib import Path

import pytest
from mobius_flow.core import read_curve
from mobius_flow.core.collision import thickness
from mobius_flow.core.proof import verify

CROSS = "# open\n-6 0 0\n-3 0 0\n0 0 0\n3 0 0\n6 0 0\n\n# open\n0 -6 0\n0 -3 0\n0 0 0\n0 3 0\n0 6 0\n"


@pytest.fixture(autouse=True)
def cross(room):
    (room / "cross.txt").write_text(CROSS, encoding="utf-8")
    (room / "two.txt").write_text("# open\n-6 0 0\n6 0 0\n\n# open\n0 -6 0\n0 6 0\n", encoding="utf-8")


def test_ropes_are_written_with_report_and_proof(room, run):
    words = ("--radius", "0.5,1", "--over=-z", "--report", "r.json", "--trajectory", "t.npz")
    status, _, said = run("separate", "cross.txt", "out.obj", *words)
    assert status == 0
    assert "all ropes keep clear" in said
    assert "component 2 went over component 1 near (0, 0, 0)" in said
    verdict = verify("t.npz")
    assert verdict.accepted
    radii = said.partition("a rope of radius ")[2].partition(" on the whole path")[0]  # not those in the end
    assert str(verdict).endswith(f"a rope of radius {radii}")
    assert [float(each) for each in radii.split(", ")] == pytest.approx(verdict.radius, rel=1e-3)
    report = json.loads(Path("r.json").read_text(encoding="utf-8"))
    assert report["crossings"] == [{"over": 1, "under": 0, "place": [0.0, 0.0, 0.0]}]
    assert (report["status"], report["share"], report["radius"]) == ("converged", 1.0, [0.5, 1.0])
    lower, upper = read_curve("out.obj").components
    assert lower[2, 2] - upper[2, 2] >= 1.5


def test_what_is_too_thick_ends_with_its_place(room, run):
    status, _, said = run("separate", "cross.txt", "o.txt", "--radius", "9", "--lengths", "free")
    assert status == 1
    assert "% of the radius only; it is tight" in said
    assert Path("o.txt").exists()


def test_a_trefoil_is_written_with_report_and_proof(room, run):
    words = ("--vertices", "100", "--report", "r.json", "--trajectory", "t.npz", "--contacts", "map.svg")
    status, _, said = run("tighten", "trefoil.txt", "out.obj", *words)
    assert status == 0
    assert "ropelength 32.8" in said
    assert "a rope of radius" in said
    verdict = verify("t.npz")
    assert verdict.accepted
    curve, report = read_curve("out.obj"), json.loads(Path("r.json").read_text(encoding="utf-8"))
    assert report["ropelength"] == pytest.approx(curve.length / thickness(curve), rel=1e-6)
    assert report["radius"] == pytest.approx(verdict.radius)
    assert report["energy"][0] > report["energy"][-1] == pytest.approx(report["ropelength"], rel=1e-5)
    assert report["gap"] <= 1e-6
    assert report["options"]["vertices"] == report["vertices"] == 100
    assert all(0 <= a < b < 100 for a, b, _ in report["struts"])
    dots = Path("map.svg").read_text(encoding="utf-8").count("<path")
    assert dots == 2 * len(report["struts"]) + 4  # both ways, in a frame


def test_without_an_equilibrium_there_is_no_map_of_contacts(room, run):
    words = ("--vertices", "20000", "--time-limit", "4", "--contacts", "map.svg", "--report", "r.json")
    status, _, said = run("tighten", "trefoil.txt", "out.obj", *words)
    assert status == 0
    assert "no map of contacts" in said
    assert "no map of contacts" in json.loads(Path("r.json").read_text(encoding="utf-8"))["message"]
    assert not Path("map.svg").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("separate two.txt o.txt --radius 0.5 --lengths keep", "two.txt: component 1 and component 2 are both held"),
        ("separate cross.txt o.txt --radius thick", "radius is 'thick'; give a number"),
        ("separate cross.txt o.txt --radius -1", "radius is -1.0; it must be a number above 0"),
        ("separate cross.txt o.txt --radius 1 --over w", "over is 'w'"),
        ("separate cross.txt o.txt --radius 1 --lengths keep", "line 4: component 1 and component 2 are both held"),
        ("separate cross.txt o.txt --radius 1,2,3", "3 numbers for 2 components"),
        ("tighten trefoil.txt o.txt --vertices 7", "vertices is 7"),
        ("tighten trefoil.txt o.txt --starts 0", "starts is 0"),
        ("tighten trefoil.txt o.txt --contacts map.txt", ".svg"),
        ("tighten trefoil.txt o.txt --contacts map.svg --report map.svg", "are the same file"),
    ],
)
def test_bad_input_is_one_line(refused, words, said):
    assert said in refused(*words.split())
