"""Growth on the command line: ``--grow``, and the container among the examples."""

import json
from pathlib import Path

import pytest
from mobius_flow.cli import main
from mobius_flow.core import read_curve, write_curve
from mobius_flow.core.knots import knot

BALL = Path(__file__).resolve().parents[2] / "examples/ball.obj"


def run(*words):
    return main([str(word) for word in words])


def test_a_knot_grows_in_the_ball_of_the_examples(tmp_path, capsys):
    trefoil, packed, report = (tmp_path / name for name in ("trefoil.obj", "packed.obj", "report.json"))
    write_curve(trefoil, knot("3_1", vertices=60))
    outputs = [packed, "--report", report, "--trajectory", tmp_path / "path.npz"]
    assert (
        run("relax", trefoil, *outputs, "--avoid", BALL, "--grow", 1.3, "--vertices", 60, "--max-iterations", 15) == 0
    )
    assert "grew to 1.3 of 1.3 times its length" in capsys.readouterr().err
    values = json.loads(report.read_text())
    assert values["grown"] == pytest.approx(1.3, rel=1e-12)
    assert values["certified"]
    assert read_curve(packed).length == pytest.approx(1.3 * read_curve(trefoil).length, rel=1e-6)
    assert run("verify", tmp_path / "path.npz") == 0


@pytest.mark.parametrize("factor", ["0", "-2", "nan", "1e9", "twice"])
def test_no_factor_no_run(factor, tmp_path, capsys):
    write_curve(tmp_path / "trefoil.obj", knot("3_1"))
    assert run("relax", tmp_path / "trefoil.obj", tmp_path / "o.obj", f"--grow={factor}") == 2
    assert "grow" in capsys.readouterr().err
    assert not (tmp_path / "o.obj").exists()
