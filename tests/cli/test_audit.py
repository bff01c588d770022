"""``mobius-flow audit`` from the terminal's point of view."""

import json

import numpy as np
import pytest
from shapes import regular_polygon

CIRCLE = regular_polygon(12).vertices
HOPF = np.concatenate([CIRCLE, CIRCLE[:, [0, 2, 1]] + [1.0, 0.07, 0.03]])
APART = HOPF + np.repeat([[0.0, 0, 0], [5, 0, 0]], 12, axis=0)


def xyz(*frames):
    rows = ("".join(f"C {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist()) for points in frames)
    return "".join(f"{len(points)}\n\n{text}" for points, text in zip(frames, rows, strict=True))


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "link.xyz"
    path.write_text(xyz(HOPF, APART, APART), encoding="utf-8")
    return path


def test_passings_are_told_as_a_table_and_as_json(path, run):
    status, told, said = run("audit", path, "--chains", "2x12")
    assert (status, said) == (0, "")
    lines = [line.split() for line in told.splitlines()]
    assert lines[0] == ["✓", "audited", "2", "legs", "·", "2", "rings"]
    assert ["changed", "1,", "2:", "L2a1", "→", "unknot", "⊔", "unknot"] in lines
    assert any(line[:3] == ["1,", "2", "1"] for line in lines)
    (row,) = [line for line in lines if line[-1:] == ["passing"]]
    status, told, _ = run("audit", path, "--chains", "12", "--json")
    report = json.loads(told)
    (contact,), (meeting,) = report["contacts"], report["meetings"]
    assert (report["legs"], report["problem"], report["chains"]) == (2, None, [12, 12])
    assert (contact["frames"], contact["chains"], contact["kind"]) == ([0, 1], [1, 2], "passing")
    assert row[:2] == ["0–1", f"{contact['time']:.6f}"]
    assert meeting["before"] == {"name": "L2a1", "names": ["L2a1"], "proved": True}
    assert abs(meeting["linking"]) == 1
    (a, b), (c, d) = contact["beads"]
    edges = (1 - contact["time"]) * HOPF + contact["time"] * APART
    for first, last in ((a, b), (c, d)):
        way = edges[last - 1] - edges[first - 1]
        along = (contact["place"] - edges[first - 1]) @ way / (way @ way)
        assert np.allclose(edges[first - 1] + along * way, contact["place"])
    status, told, _ = run("audit", path, "--chains", "12", "--open", "--types", "0")
    assert status == 0
    assert "2 open chains" in told
    assert "L2a1" not in told
    assert run("audit", path, "--chains", "1x12")[1].splitlines()[0] == "✓ audited     2 legs · 1 ring · 12 other beads"


def test_what_was_found_is_told_when_the_file_breaks_off(path, run):
    path.write_text(xyz(HOPF, APART, APART[:-1]), encoding="utf-8")
    status, told, _ = run("audit", path, "--chains", "12", "--json")
    report = json.loads(told)
    assert (status, report["legs"], len(report["contacts"])) == (1, 1, 1)
    assert report["problem"] == f"{path}: frame 2 has 23 beads and the first one 24; none may come or go"
    status, told, _ = run("audit", path, "--chains", "12")
    assert (status, told.splitlines()[0]) == (1, "✗ broken off  1 leg · 2 rings")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--chains", "2y12"), "chains are '2y12'; give numbers and sizes, such as 50x200"),
        (("--chains", "12", "--box", "1,b"), "box is '1,b'; give three lengths"),
        (("--chains", "12", "--box", "1,1,1"), "half the box or more"),
        ((), "does not say which beads are chains"),
    ],
)
def test_bad_questions_are_one_line(path, run, words, said):
    status, told, line = run("audit", path, *words)
    assert (status, told) == (2, "")
    assert said in line
    assert line.count("\n") <= 1
