"""``mobius-flow tighten`` from the terminal's point of view."""

import json

import pytest
from mobius_flow.core import read_curve, write_curve
from mobius_flow.core.collision import thickness
from mobius_flow.core.knots import knot
from mobius_flow.core.proof import verify


@pytest.fixture
def trefoil(tmp_path):
    path = tmp_path / "trefoil.txt"
    write_curve(path, knot("3_1", 40))
    return path


def test_a_trefoil_is_written_with_report_and_proof(trefoil, tmp_path, run):
    outputs = tmp_path / "out.obj", tmp_path / "r.json", tmp_path / "t.npz", tmp_path / "map.svg"
    words = ("--vertices", "100", "--report", outputs[1], "--trajectory", outputs[2], "--contacts", outputs[3])
    status, _, said = run("tighten", trefoil, outputs[0], *words)
    assert status == 0
    assert "ropelength 32.8" in said
    assert "a rope of radius" in said
    verdict = verify(outputs[2])
    assert verdict.accepted
    curve, report = read_curve(outputs[0]), json.loads(outputs[1].read_text(encoding="utf-8"))
    assert report["ropelength"] == pytest.approx(curve.length / thickness(curve), rel=1e-6)
    assert report["radius"] == pytest.approx(verdict.radius)
    assert report["energy"][0] > report["energy"][-1] == pytest.approx(report["ropelength"], rel=1e-5)
    assert report["gap"] <= 1e-6
    assert report["options"]["vertices"] == report["vertices"] == 100
    assert all(0 <= a < b < 100 for a, b, _ in report["struts"])
    dots = outputs[3].read_text(encoding="utf-8").count("<path")
    assert dots == 2 * len(report["struts"]) + 4  # both ways, in a frame


@pytest.mark.parametrize(
    ("words", "said"),
    [(("--vertices", "7"), "vertices is 7"), (("--starts", "0"), "starts is 0"), (("--contacts", "map.txt"), ".svg")],
)
def test_bad_input_is_one_line(trefoil, tmp_path, refused, words, said):
    assert said in refused("tighten", trefoil, tmp_path / "o.txt", *words)
