"""Curves and options as nobody wants them: a good run or one clear sentence; never NaN, a hang or a traceback."""

import itertools
import math
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from mobius_flow.cli import main
from mobius_flow.core import METHODS, Curve, CurveError, Mesh, OptionError, RelaxOptions, relax
from mobius_flow.core.collision import is_free
from mobius_flow.core.driver.options import EDGE_LENGTHS, MESHES
from mobius_flow.core.energies import ENERGIES
from mobius_flow.core.knots.diagrams import quick_invariants
from mobius_flow.core.solve.metrics import METRICS
from shapes import regular_polygon, torus_trefoil

Array = npt.NDArray[np.float64]
TREFOIL = torus_trefoil(40).vertices
SQUARE = np.array([[0.0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]])
TWICE = np.linspace(0, 2 * np.pi, 41)


def check_run(curve, options):
    """Run, and check every iterate and every motion."""
    before = None
    relaxation = relax(curve, options)
    for iterate in relaxation:
        assert np.isfinite(iterate.curve.vertices).all()
        assert math.isfinite(iterate.energy)
        assert iterate.energy > 0
        assert math.isfinite(iterate.gradient_norm)
        assert iterate.certified
        if before is not None and iterate.path:
            frames = [before.curve.vertices, *iterate.path]
            assert all(is_free(before.curve.mesh, a, b) for a, b in itertools.pairwise(frames))
        before = iterate
    if curve.dimension == 3:
        assert quick_invariants(before.curve) == quick_invariants(curve)


RUN: dict[str, Curve] = {
    "float32's largest": Curve(1e38 * TREFOIL),
    "tiny": Curve(1e-39 * TREFOIL),
    "a billion away": Curve(TREFOIL + 1e9),
    "ten trillions away": Curve(TREFOIL + 1e13),
    "collinear vertices": Curve(np.concatenate([np.linspace([0, 0, 0], [4, 0, 0], 9), SQUARE[2:]])),
    "a triangle": Curve(np.eye(3)),
    "a short edge": Curve(np.concatenate([TREFOIL, TREFOIL[:1] + 1e-13])),
    "long and thin": Curve(SQUARE * [1e9, 1, 1]),
    "a billionth apart": Curve.from_components([SQUARE, SQUARE + np.array([0, 0, 1e-9])]),
    "nested triangles": Curve.from_components([2.0**k * (np.eye(3) - 1 / 3) for k in range(12)]),
    "nested in the plane": Curve.from_components([2.0**k * regular_polygon(5, dimension=2).vertices for k in range(6)]),
    "300 triangles": Curve.from_components(
        [np.eye(3) + np.array([3 * (k % 20), 3 * (k // 20), 0]) for k in range(300)]
    ),
}


@pytest.mark.parametrize("name", RUN)
def test_hostile_curves_that_run(name):
    curve = RUN[name]
    check_run(curve, RelaxOptions(max_iterations=2, vertices=max(60, len(curve))))


REFUSED: dict[str, tuple[Array, str]] = {
    "beyond range": (1e300 * TREFOIL, r"vertex 1, .* has a coordinate beyond 1e\+40; use a larger unit"),
    "below range": (1e-300 * TREFOIL, "only 5.6.*e-300 wide, less than 1e-40; use a smaller unit"),
    "denormal": (np.ldexp(np.round(4 * TREFOIL), -1074), "use a smaller unit"),
    "too far away": (TREFOIL + 1e15, "too far from the origin, .* move it closer"),
    "much too far away": (TREFOIL + 1e18, "the same point"),
    "one point": (np.zeros((5, 3)), "vertex 1 of component 1 and vertex 2 of component 1 are the same point"),
    "closed up to rounding": (np.stack([np.cos(TWICE), np.sin(TWICE)], 1), "vertex 41 .* and vertex 1 .* are the same"),
    "repeated": (TREFOIL[[*range(20), 19, *range(20, 40)]], "vertex 20 .* and vertex 21 .* are the same point"),
    "met again": (TREFOIL[[*range(20), 0, *range(20, 40)]], "touch or cross"),
    "a spike": (np.insert(SQUARE, 1, [[2, 0, 0], [2, 1, 0], [2, 0.5, 0]], axis=0), "doubles back"),
    "a line": (np.linspace([0, 0, 0], [1, 2, 3], 5), "doubles back"),
    "thinner than digits": (SQUARE * [1e12, 1, 1], "strands are only 4 apart .* move them apart"),
    "nearer than digits beside a short edge": (
        np.concatenate([SQUARE, SQUARE[::-1] + np.array([0, 0, 5e-12]), [[0, -4e-14, 5e-12 + 4e-14]]]),
        "strands are only 5e-12 apart",
    ),
    "not a number": (np.where(TREFOIL[3, 1] == TREFOIL, np.nan, TREFOIL), "vertex 4 is not finite"),
    "infinite": (np.where(TREFOIL[3, 1] == TREFOIL, -np.inf, TREFOIL), "vertex 4 is not finite"),
}


@pytest.mark.parametrize(
    ("parts", "reason"),
    [
        (
            [TREFOIL * 1e5, TREFOIL + 1e6, TREFOIL * 1e-5 - 1e6],
            r"component 3 is only 0.0003.* long in a link 2.*e\+06 wide",
        ),
        ([TREFOIL, TREFOIL + 1e6], r"component . is only 31.* long in a link 1e\+06 wide"),
    ],
)
def test_parts_too_small_for_their_distances_are_named(parts, reason):
    """Far apart as they are, moving strands would not help."""
    with pytest.raises(CurveError, match=reason + ", too small or too far away .* relax it by itself"):
        relax(Curve.from_components(parts))


@pytest.mark.parametrize("name", REFUSED)
def test_hostile_curves_that_are_refused(name):
    vertices, reason = REFUSED[name]
    with pytest.raises(CurveError, match=reason) as caught:
        relax(Curve(vertices))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("words", [("relax", "IN", "OUT.txt"), ("energy", "IN")])
def test_the_command_line_says_it_in_one_line(words, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("below range", "met again", "infinite"):
        Path("IN").with_suffix(".txt").write_text(text(REFUSED[name][0]))
        assert main([word.replace("IN", "IN.txt") for word in words]) == 2
        captured = capsys.readouterr()
        assert captured.out == ""
        assert captured.err.count("\n") == 1
        assert captured.err.startswith("mobius-flow: ")
        assert not Path("OUT.txt").exists()


def text(vertices):
    return "".join(" ".join(map(repr, point)) + "\n" for point in vertices.tolist())


ANYTHING = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8)
ANYTHING |= st.just(10**400) | st.just(3.0) | st.just([])
VALUES: dict[str, st.SearchStrategy[object]] = {
    "method": st.sampled_from(list(METHODS)),
    "max_iterations": st.integers(-1, 5),
    "tolerance": st.floats(-1e-3, 1.0),
    "vertices": st.none() | st.integers(0, 100),
    "energy": st.sampled_from(list(ENERGIES)),
    "metric": st.none() | st.sampled_from(list(METRICS)),
    "quadrature_points": st.integers(0, 3),
    "penalty": st.none() | st.floats(-1.0, 1e6),
    "mesh": st.sampled_from(MESHES),
    "edge_lengths": st.sampled_from(EDGE_LENGTHS),
    "stability": st.booleans(),
    "escape_saddles": st.booleans(),
}


@given(wanted=st.fixed_dictionaries({}, optional={name: value | ANYTHING for name, value in VALUES.items()}))
@example(wanted={"max_iterations": None})
@example(wanted={"tolerance": "1e-3"})
@example(wanted={"tolerance": 10**400})
@example(wanted={"vertices": 100.5})
@example(wanted={"method": []})
@example(wanted={"quadrature_points": 10**30})
@settings(max_examples=300, deadline=None)
def test_any_options_are_valid_or_refused_in_one_sentence(wanted):
    try:
        options = RelaxOptions(**wanted)
        relax(regular_polygon(5), options)
    except OptionError as error:
        said = str(error)
        assert "\n" not in said
        assert any(name in said for name in VALUES)
    else:
        assert options.max_iterations >= 0
        assert options.tolerance > 0


@st.composite
def polygons(draw):
    """Small polygons and links with corners on a grid, which touch often, or at random, in any units and place."""
    sizes = draw(st.lists(st.integers(3, 7), min_size=1, max_size=2))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    dimension, count = draw(st.sampled_from([2, 3, 3, 3])), sum(sizes)
    points = rng.normal(size=(count, dimension)) if draw(st.booleans()) else rng.integers(0, 4, (count, dimension))
    scale, shift = 10.0 ** draw(st.integers(-6, 6)), draw(st.sampled_from([0.0, 1.0, -1e3, 1e6, 1e9]))
    return Curve(scale * (points + shift), Mesh(tuple(sizes)))


@given(
    curve=polygons(),
    method=st.sampled_from(list(METHODS)),
    more=st.integers(0, 40),
    iterations=st.integers(0, 4),
    mesh=st.sampled_from(MESHES),
)
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_short_flows(curve, method, more, iterations, mesh):
    options = RelaxOptions(method=method, vertices=len(curve) + more, max_iterations=iterations, mesh=mesh)
    try:
        check_run(curve, options)
    except (CurveError, OptionError) as error:
        said = str(error)
        assert "\n" not in said


VOCABULARY = """
    relax energy verify compare knot methods IN OUT.txt OUT.obj 3_1 T(2,99999999999) braid(1,2 T(2,3)
    --help --report --trajectory --quiet --json --method lbfgs magic --max-iterations 0 1 -1 --tolerance nan inf 1e-3
    --vertices 70 0 99999999999999999999 --energy vertex --metric l2 --quadrature-points 2 --penalty 1e999 --adaptive
    --edge-lengths keep --stability --only --methods --time-limit --output X.csv --
"""
WORDS = st.sampled_from(VOCABULARY.split())


@given(words=st.lists(WORDS | st.text(st.characters(codec="utf-8", exclude_characters="\0/"), max_size=6), max_size=7))
@example(words=["knot", "T(2,99999999999)", "OUT.txt"])
@example(words=["knot", "3_1", "OUT.txt", "--vertices", "99999999999999999999"])
@example(words=["relax", "IN", "OUT.txt", "--vertices", "99999999999999999999"])
@settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow]
)
def test_any_arguments_give_an_exit_status_and_one_line(words, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in.txt").write_text(text(TREFOIL))
    words = ["in.txt" if word == "IN" else word for word in words]
    if "relax" in words or "compare" in words:
        words += ["--max-iterations=1"]
    capsys.readouterr()
    status = main(words)
    captured = capsys.readouterr()
    assert status in (0, 1, 2)
    if status == 2:
        assert captured.err.count("\n") == 1
        assert captured.err.startswith("mobius-flow")
    assert "Traceback" not in captured.err
