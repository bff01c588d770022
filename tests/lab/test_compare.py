"""What ``compare`` writes: tables, figures and strips."""

import csv
import json
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mobius_flow.core import METHODS, RelaxOptions
from mobius_flow.core.curve.measures import writhe_and_crossings
from mobius_flow.core.driver.run import Run
from mobius_flow.lab.compare.command import WRITERS, usual
from mobius_flow.lab.compare.comparison import History, compare, least_energy
from mobius_flow.lab.compare.figures import draw_curve, figure_class
from shapes import torus_trefoil

HELPED = History("flow-l2", "stalled", (0.0, 0.1, 0.2, 0.3), (9.0, 8.0, 7.0, 6.5), (1.0, 0.9, 0.8, 0.7), (2, 3), "l2")


def test_fallback_steps_in_tables(tmp_path):
    WRITERS[".csv"](tmp_path / "a.csv", [HELPED])
    rows = list(csv.DictReader((tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()))
    assert [row["fallback"] for row in rows] == ["0", "0", "1", "1"]
    assert {row["metric"] for row in rows} == {"l2"}
    WRITERS[".json"](tmp_path / "a.json", [HELPED])
    (plain,) = json.loads((tmp_path / "a.json").read_text())
    assert plain["fallback"] == [2, 3]
    assert set(plain) == {"method", "status", "seconds", "energy", "gradient_norm", "fallback", "metric"}


def test_figures_show_energy_its_distance_to_the_least_and_the_gradient(tmp_path, monkeypatch):
    axes, figure = pytest.importorskip("matplotlib.axes"), pytest.importorskip("matplotlib.figure")
    drawn, said = [], []
    plot, title = axes.Axes.plot, figure.Figure.suptitle
    monkeypatch.setattr(axes.Axes, "plot", lambda *a, **k: drawn.append((*a[1:], k)) or plot(*a, **k))
    monkeypatch.setattr(figure.Figure, "suptitle", lambda *a, **k: said.append(a[1]) or title(*a, **k))
    rising = replace(
        HELPED, method="cg", metric="moebius", status="time_limit", energy=(9.0, 8.0, 8.5, 7.0), fallback=()
    )
    WRITERS[".png"](tmp_path / "a.png", [HELPED, rising, replace(rising, method="flow-moebius")])
    lines, ends = [each for each in drawn if len(each) == 3], [each for each in drawn if len(each) == 4]
    heights = [list(y) for _, y, _ in lines[::6]]
    assert heights[0] == [9.0, 8.0, 7.0, 6.5]
    assert heights[1][:3] == [2.5, 1.5, 0.5]
    assert np.isnan(heights[1][3])  # the least one itself has no logarithm
    assert heights[2] == [1.0, 0.9, 0.8, 0.7]
    assert [list(x) for x, *_ in lines[:4:3]] == [[0, 1, 2, 3], [0.0, 0.1, 0.2, 0.3]]
    assert [keywords.get("markevery") for *_, keywords in lines] == 6 * [[2, 3], None, None]
    colors, dashes = ([keywords[name] for *_, keywords in lines[:3]] for name in ("color", "linestyle"))
    assert colors[0] != colors[1] == colors[2], "one for each metric"
    assert dashes[0] == dashes[2] != dashes[1], "one for each kind of method"
    assert {mark for *_, mark, _ in ends} == {"x"}, "where it is stuck"
    assert said == ["E rises: cg in 1 of 3 steps, flow-moebius in 1 of 3 steps"]
    assert (tmp_path / "a.png").stat().st_size > 1000

    drawn.clear()
    every = [replace(HELPED, method=name, metric=method.metric.name) for name, method in METHODS.items()]
    WRITERS[".png"](tmp_path / "b.png", every)
    styles = {(keywords["color"], str(keywords["linestyle"])) for *_, keywords in drawn if "linestyle" in keywords}
    assert len(styles) == len(every), "no two methods look the same"


def test_the_least_energy_is_that_of_methods_that_keep_lengths():
    other = replace(HELPED, method="penalty-cg", energy=(9.0, 5.0))
    assert least_energy([HELPED, other]) == 6.5
    assert least_energy([other]) == 5.0


@pytest.mark.parametrize("mirror", [[1, 1, 1], [1, 1, -1]])
def test_nearer_strands_cover_farther_ones(mirror):
    """The picture is no mirror image."""
    pytest.importorskip("matplotlib")
    axes = figure_class()().subplots()
    curve = torus_trefoil(30)
    curve = curve.with_vertices(mirror * curve.vertices)
    draw_curve(axes, curve, "C0", 2.0)
    (lines,) = axes.collections
    assert _writhe_sign(np.array(lines.get_segments())[::2]) == np.sign(writhe_and_crossings(curve)[0])


def _writhe_sign(segments):
    """Sign of the crossings of a drawing whose segments come from far to near."""
    signs = []
    for near, (a, b) in enumerate(segments):
        for c, d in segments[:near]:
            u, v = b - a, d - c
            cross = u[0] * v[1] - u[1] * v[0]
            if abs(cross) > 1e-12:
                s, t = np.linalg.solve(np.column_stack([u, -v]), c - a)
                if 0.01 < s < 0.99 and 0.01 < t < 0.99:
                    signs.append(np.sign(cross))
    assert len(set(signs)) == 1
    return int(signs[0])


@pytest.mark.usefixtures("room")
def test_a_strip_has_a_row_for_each_method_and_ends_with_its_last_stage(run):
    pytest.importorskip("matplotlib")
    words = "compare trefoil.txt -o s.png --methods cg,flow-l2 --strip 2,0,9 --max-iterations 3"
    shown = run(*words.split())[1]
    assert Path("s.png").stat().st_size > 5000
    assert [line.split()[1:4] for line in shown.splitlines()[1:]] == 2 * [["iteration", "limit", "3"]]
    shown = run(*["compare", "trefoil.txt", "-o", "s.png", "--methods", "cg", "--strip", "2,0"])[1]
    assert " iteration limit           2 " in shown


@pytest.mark.usefixtures("room")
def test_what_is_compared_is_announced_and_a_table_needs_no_file(run):
    words = ["compare", "trefoil.txt", "--max-iterations", "1"]
    _, shown, said = run(*words, "--time-limit", "7")
    every = f"--methods '*' takes all {len(METHODS)}"
    assert said == f"comparing {', '.join(usual())}: at most 7 s each, {7 * len(usual())} s in all; {every}\n"
    assert [line.split()[0] for line in shown.splitlines()] == ["method", *usual()]
    _, shown, said = run(*words, "--methods", "*", "-o", "c.csv")
    assert [line.split()[0] for line in shown.splitlines()[1:]] == list(METHODS)
    assert said.endswith("✓ wrote       c.csv\n")


def test_the_time_limit_is_the_clocks(monkeypatch):
    """What is recorded is processor time, which a busy machine does not change."""
    step = Run.step
    monkeypatch.setattr(Run, "step", lambda self: time.sleep(0.2) or step(self))
    (run,) = compare(torus_trefoil(20), ["cg"], RelaxOptions(vertices=20, tolerance=1e-12), 0.3)
    assert run.status == "time_limit"
    assert run.iterations <= 2
    assert run.seconds[-1] < 0.3


@pytest.mark.usefixtures("room")
@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--strip 0,x -o s.png", "strip has 'x'; give numbers of iterations, such as 0,10,50"),
        ("--strip 0,5 -o s.csv", "s.csv: a strip is a picture; let OUT end in .png or .svg"),
        ("--time-limit 0 -o s.csv", "time_limit is 0.0; it must be a finite number above 0"),
        ("--time-limit inf -o s.csv", "time_limit is inf; it must be a finite number above 0"),
    ],
)
def test_what_cannot_be_is_refused(words, said, refused):
    pytest.importorskip("matplotlib")
    assert said in refused("compare", "trefoil.txt", *words.split())
