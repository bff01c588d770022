"""Open components on the command line: from every format to every other, and what is for closed ones alone."""

import json

import numpy as np
import pytest
from curve_formats import OF_VERTICES
from mobius_flow.cli import main, places
from mobius_flow.core import read_curve, write_curve
from shapes import half_circle


def run(*arguments):
    return main([str(argument) for argument in arguments])


@pytest.mark.parametrize("suffix", OF_VERTICES)
def test_overhand_arcs_in_every_format(tmp_path, suffix):
    arc, out, report, path = (tmp_path / name for name in (f"arc{suffix}", f"out{suffix}", "r.json", "t.npz"))
    assert run("knot", "overhand", arc, "--vertices", 50) == 0
    limits = "--vertices", 50, "--max-iterations", 3
    assert run("relax", arc, out, "--report", report, "--trajectory", path, "--quiet", *limits) == 0
    assert read_curve(out).mesh == read_curve(arc).mesh
    assert read_curve(out).mesh.closed == (False,)
    assert json.loads(report.read_text())["certified"]
    assert run("verify", path) == 0
    with np.load(path) as arrays:
        assert arrays["component_closed_000"].tolist() == [False]


def test_files_of_closed_curves_are_as_they_were(tmp_path):
    assert run("knot", "3_1", tmp_path / "k.txt", "--vertices", 60) == 0
    path = tmp_path / "t.npz"
    assert run("relax", tmp_path / "k.txt", tmp_path / "o.json", "--trajectory", path, "--max-iterations", 1) == 0
    with np.load(path) as arrays:
        assert not [name for name in arrays if "closed" in name]
    assert "#" not in (tmp_path / "k.txt").read_text()
    assert set(json.loads((tmp_path / "o.json").read_text())) == {"components"}


def test_energy_of_half_a_circle(tmp_path, capsys):
    write_curve(tmp_path / "h.txt", half_circle(400))
    assert run("energy", tmp_path / "h.txt") == 0
    assert float(capsys.readouterr().out) == pytest.approx(2 * np.log(np.pi / 2), rel=1e-5)


def test_arcs_that_double_back_are_refused_with_their_line(tmp_path, capsys):
    (tmp_path / "a.txt").write_text("# open\n0 0 0\n2 0 0\n1 0 0\n")
    assert run("relax", tmp_path / "a.txt", tmp_path / "o.txt") == 2
    reason = "line 3: the curve doubles back at vertex 2 of component 1, (2, 0, 0); move or remove it"
    assert reason in capsys.readouterr().err


def test_what_is_for_closed_components(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(places.export, "require_blender", lambda: None)
    assert run("knot", "overhand", tmp_path / "a.txt", "--vertices", 50) == 0
    for output in ("o.blend", "o.mp4", "o.png"):
        assert run("relax", tmp_path / "a.txt", tmp_path / output) == 2
        assert "component 1 is open; scenes, films and pictures are for closed components" in capsys.readouterr().err
    for output in ("o.pd", "o.gauss"):
        assert run("relax", tmp_path / "a.txt", tmp_path / output) == 2
        assert "component 1 is open; codes of diagrams are for closed components" in capsys.readouterr().err
    assert run("relax", tmp_path / "a.txt", tmp_path / "o.txt", "--balance") == 2
    assert "Möbius images of equal energy" in capsys.readouterr().err


def test_too_few_vertices(tmp_path, capsys):
    assert run("knot", "overhand", tmp_path / "a.txt", "--vertices", 39) == 2
    assert "39 vertices are too few for this arc; give 40 or more" in capsys.readouterr().err
