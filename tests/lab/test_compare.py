"""Methods are compared: their runs, tables, figures and strips."""

import csv
import json
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from changed_moves import change
from mobius_flow.core import METHODS, Curve, MobiusFlowError, RelaxOptions, minimize, relax
from mobius_flow.core.curve.measures import writhe_and_crossings
from mobius_flow.core.driver.moves import CoarseStart
from mobius_flow.core.driver.run import Run
from mobius_flow.core.knots import knot
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


# evening its edges out costs energy, and their lengths cost a penalised method much to begin with
UNEVEN = Curve(np.delete(torus_trefoil(80).vertices, slice(1, 40, 2), axis=0))


def alone(curve, method, stages=(), **options):
    (history,) = compare(curve, [method], RelaxOptions(**{"vertices": 60} | options), 60.0, stages)
    return history


def test_steps_are_compared_on_one_mesh(monkeypatch):
    """Also of curves that `relax` would begin with fewer vertices, or untangle."""
    change(monkeypatch, CoarseStart, min_vertices=100)
    options = RelaxOptions(radius="none", vertices=600, max_iterations=40)
    (history,) = compare(torus_trefoil(600), ["cg"], options, 60.0)
    fixed = minimize(torus_trefoil(600), replace(options, method="cg", mesh="fixed", edge_lengths="keep"))
    assert (history.energy, history.status) == (fixed.energies, fixed.status.value)
    assert alone(knot("tuzun-sikora"), "lbfgs", max_iterations=2, vertices=None).iterations == 2


def test_methods_are_compared_as_they_are():
    """L-BFGS alone, without the Newton steps that it ends with elsewhere."""
    history = alone(torus_trefoil(60), "lbfgs", tolerance=1e-4)
    usual = minimize(torus_trefoil(60), RelaxOptions(radius="none", vertices=60, mesh="fixed", edge_lengths="keep"))
    assert history.status == "converged"
    assert history.gradient_norm[-1] > 1e3 * usual.last.gradient_norm


def test_methods_are_compared_in_several_metrics():
    """Names are patterns, too; a metric that is the method's own is not said."""
    methods = ["flow-h*", "cg", "penalty-cg:h[12]", "paper:*2"]
    found = compare(torus_trefoil(20), methods, RelaxOptions(vertices=20, max_iterations=0), 60.0)
    labels = ["flow-h1", "flow-h3-2", "flow-h2", "cg", "penalty-cg:h1", "penalty-cg:h2"]
    labels += ["paper:l2", "paper:h3-2", "paper:h2"]
    kinds = ["flow"] * 3 + ["cg"] + ["penalty-cg"] * 2 + ["paper"] * 3
    assert [(each.label, each.kind) for each in found] == list(zip(labels, kinds, strict=True))


def test_lengths_stay_and_penalties_are_left_out():
    history = alone(UNEVEN, "flow-l2", (0, 3), max_iterations=3)
    np.testing.assert_allclose(history.stages[3].edge_lengths, history.stages[0].edge_lengths, rtol=1e-9)
    assert history.rises == 0
    penalised = alone(UNEVEN, "penalty-cg", max_iterations=2)
    start = next(relax(UNEVEN, RelaxOptions(vertices=60, method="penalty-cg")))
    assert penalised.energy[0] == pytest.approx(history.energy[0], rel=1e-12)
    assert start.energy > penalised.energy[0] + 1.0


TAKES_OTHER_STEPS = ({"hops": 3}, {"mesh": "finer"}, {"stability": True}, {"time_limit": 3.0}, {"untangle": "always"})


@pytest.mark.parametrize(
    ("methods", "options", "said"),
    [
        *(
            (["cg"], each, f"{next(iter(each))}=.* has no part in a comparison of methods")
            for each in TAKES_OTHER_STEPS
        ),
        ("lbfgs", {}, "methods is 'lbfgs'; give a list"),
        (["lbfgs", "cg", "lbfgs"], {}, "methods are lbfgs,cg,lbfgs; give each of them once"),
        (["cg", "cg:moe*"], {}, "methods are cg,cg:moe.*; give each of them once"),
        (["cg:h5"], {}, "metric 'h5' is unknown"),
    ],
    ids=str,
)
def test_what_cannot_be_compared_is_refused(methods, options, said):
    with pytest.raises(MobiusFlowError, match=said):
        compare(torus_trefoil(20), methods, RelaxOptions(**options), 60.0)
