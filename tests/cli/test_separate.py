"""``mobius-flow separate`` from the terminal's point of view."""

import json

import pytest
from mobius_flow.core import read_curve
from mobius_flow.core.proof import verify

CROSS = "# open\n-6 0 0\n-3 0 0\n0 0 0\n3 0 0\n6 0 0\n\n# open\n0 -6 0\n0 -3 0\n0 0 0\n0 3 0\n0 6 0\n"


@pytest.fixture
def cross(tmp_path):
    path = tmp_path / "cross.txt"
    path.write_text(CROSS, encoding="utf-8")
    return path


def test_ropes_are_written_with_report_and_proof(cross, tmp_path, run):
    outputs = tmp_path / "out.obj", tmp_path / "r.json", tmp_path / "t.npz"
    words = ("--radius", "0.5,1", "--over=-z", "--report", outputs[1], "--trajectory", outputs[2])
    status, _, said = run("separate", cross, outputs[0], *words)
    assert status == 0
    assert "all ropes keep clear" in said
    assert "component 2 went over component 1 near (0, 0, 0)" in said
    verdict = verify(outputs[2])
    assert verdict.accepted
    radii = said.partition("a rope of radius ")[2].partition(" on the whole path")[0]  # not those in the end
    assert str(verdict).endswith(f"a rope of radius {radii}")
    assert [float(each) for each in radii.split(", ")] == pytest.approx(verdict.radius, rel=1e-3)
    report = json.loads(outputs[1].read_text(encoding="utf-8"))
    assert report["crossings"] == [{"over": 1, "under": 0, "place": [0.0, 0.0, 0.0]}]
    assert (report["status"], report["share"], report["radius"]) == ("converged", 1.0, [0.5, 1.0])
    lower, upper = read_curve(outputs[0]).components
    assert lower[2, 2] - upper[2, 2] >= 1.5


def test_what_is_too_thick_ends_with_its_place(cross, tmp_path, run):
    status, _, said = run("separate", cross, tmp_path / "o.txt", "--radius", "9", "--lengths", "free")
    assert status == 1
    assert "% of the radius only; it is tight" in said
    assert (tmp_path / "o.txt").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--radius", "thick"), "radius is 'thick'; give a number"),
        (("--radius", "-1"), "a number above 0"),
        (("--radius", "1", "--over", "w"), "over is 'w'"),
        (("--radius", "1", "--lengths", "keep"), "cross.txt, line 4: component 1 and component 2 are both held"),
        (("--radius", "1,2,3"), "3 numbers for 2 components"),
    ],
)
def test_bad_input_is_one_line(cross, tmp_path, refused, words, said):
    assert said in refused("separate", cross, tmp_path / "o.txt", *words)
