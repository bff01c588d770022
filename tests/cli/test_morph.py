"""``mobius-flow morph`` and ``same`` from the terminal's point of view."""

import json

import pytest
from mobius_flow.core import read_curve
from mobius_flow.core.proof import verify

QUICK = ("--tolerance", "1e-3", "--untangle", "never", "--vertices", "70")


@pytest.fixture
def curves(tmp_path, run):
    """Files of a few knots, by name."""

    def made(name, suffix=".txt", *options):
        path = tmp_path / f"{name}{len(list(tmp_path.iterdir()))}{suffix}"
        assert run("knot", name, path, *options)[0] == 0
        return path

    return made


def test_a_motion_is_written_as_relax_writes_one(curves, tmp_path, run):
    a, b = curves("3_1"), curves("3_1", ".obj", "--smooth", "--vertices", 60)
    outputs = tmp_path / "out.txt", tmp_path / "r.json", tmp_path / "t.npz"
    status, _, said = run("morph", a, b, outputs[0], "--report", outputs[1], "--trajectory", outputs[2], *QUICK)
    assert status == 0
    assert "met" in said
    assert "a rope of radius" in said
    assert (read_curve(outputs[0]).vertices == read_curve(b).vertices).all()
    assert verify(outputs[2]).accepted
    report = json.loads(outputs[1].read_text(encoding="utf-8"))
    assert report["status"] == "converged"
    assert report["certified"]
    assert report["vertices"] == 60
    assert (report["input"]["name"], report["to"]["name"]) == (str(a), str(b))


def test_what_differs_is_refused_with_the_reason(curves, tmp_path, run):
    a, b = curves("3_1"), curves("m3_1")
    status, _, said = run("morph", a, b, tmp_path / "o.txt")
    assert status == 1
    assert said.endswith("B its mirror image m3_1: no motion leads from one to the other (signatures −2 and 2)\n")
    assert not (tmp_path / "o.txt").exists()
    assert run("same", a, b)[:2] == (1, "different: " + said.removeprefix("mobius-flow: "))


def test_sameness_by_invariants_and_by_a_motion(curves, tmp_path, run):
    assert run("same", curves("4_1"), curves("m4_1"))[:2] == (
        0, "same: both are 4_1, by the Jones polynomial, the Alexander polynomial\n"
    )  # fmt: skip
    square = tmp_path / "square.txt"
    square.write_text("0 0\n1 0\n1 1\n0 1\n", encoding="utf-8")
    status, text, _ = run("same", square, square, "--vertices", 8)
    assert status == 0
    assert text.startswith("same: a motion of ")


def test_bad_input_names_the_file(curves, tmp_path, run):
    crossing = tmp_path / "crossing.txt"
    crossing.write_text("0 0 0\n1 1 0\n1 0 0\n0 1 0\n", encoding="utf-8")
    trefoil = curves("3_1")
    for words in (("morph", trefoil, crossing, tmp_path / "o.txt"), ("same", trefoil, crossing)):
        status, _, said = run(*words)
        assert status == 2
        assert str(crossing) in said
        assert "touch or cross" in said
    status, _, said = run("same", trefoil, curves("hopf"))
    assert (status, said) == (
        2, "mobius-flow: A is 1 closed component, B is 2 closed components; motions neither open, close, join nor "
        "divide components\n"
    )  # fmt: skip
    assert run("morph", "-", "-", tmp_path / "o.txt")[0] == 2
