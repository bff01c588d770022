"""Scrambled knots, and closures of open ones."""

import numpy as np
import pytest
from curve_checks import exact, exactly_pierced
from hypothesis import given, settings
from hypothesis import strategies as st
from knot_diagrams import pairwise_linking
from knot_type import knot_invariants
from mobius_flow.core import Curve, CurveError
from mobius_flow.core.collision import check_embedded
from mobius_flow.core.curve import Mesh
from mobius_flow.core.knots import knot, knot_type, scramble
from mobius_flow.core.knots.closures import closed_far_away, closures
from mobius_flow.core.knots.scrambles import triangle_distances

POINTS = st.lists(st.integers(-6, 6), min_size=3, max_size=3).map(lambda p: np.array(p, dtype=np.float64) / 2)


@pytest.mark.parametrize("name", ["0_1", "3_1", "m3_1", "4_1", "6_2", "hopf", "whitehead", "borromean"])
@pytest.mark.parametrize("seed", [1, 3])
def test_the_type_is_kept(name, seed):
    curve = knot(name)
    messy = scramble(curve, seed, moves=3 * len(curve))
    assert messy.mesh == curve.mesh
    assert pairwise_linking(messy.components) == pairwise_linking(curve.components)
    for part, before in zip(messy.components, curve.components, strict=True):
        assert knot_invariants(part) == knot_invariants(before)


@given(triangle=st.tuples(POINTS, POINTS, POINTS), p=POINTS, q=POINTS)
@settings(max_examples=100, deadline=None)
def test_triangle_distance_is_never_too_large(triangle, p, q):
    corners = np.stack(triangle)
    found = float(triangle_distances(corners, p[None], q[None])[0])
    weights = np.array([(i, j, 12 - i - j) for i in range(13) for j in range(13 - i)]) / 12
    on_segment = p + np.linspace(0, 1, 25)[:, None] * (q - p)
    sampled = np.linalg.norm((weights @ corners)[:, None] - on_segment[None], axis=2).min()
    assert found <= sampled + 1e-12
    assert found >= sampled - np.ptp(corners, axis=0).max() / 6 - np.ptp(on_segment, axis=0).max() / 24
    pierced = exactly_pierced((exact(triangle[0]), exact(triangle[1]), exact(triangle[2])), exact(p), exact(q))
    assert not pierced or found <= 1e-12


@pytest.mark.parametrize(
    ("option", "value"),
    [("moves", -1), ("reach", 0.0), ("reach", np.inf), ("gap", 0.0), ("gap", 1e-9), ("gap", np.nan)],
)
def test_what_is_refused(option, value):
    with pytest.raises(CurveError, match=f"{option} is|and {option}"):
        scramble(knot("3_1"), 1, **{option: value})
    with pytest.raises(CurveError, match="dimension 2"):
        scramble(Curve([[0, 0], [1, 0], [0, 1]]), 1)


def test_deep_knots_stay_and_shallow_ones_depend_on_the_direction():
    assert closures(knot("overhand"), 20) == {"3_1": 20}
    trefoil = knot("3_1", 120)
    cut = Curve(trefoil.vertices[: len(trefoil) * 2 // 3], Mesh((len(trefoil) * 2 // 3,), (False,)))
    types = closures(cut, 60, seed=3)
    assert types == closures(cut, 60, seed=3)
    assert types != closures(cut, 60, seed=4)
    assert set(types) == {"3_1", "unknot"}


def test_links_close_component_by_component():
    hopf = knot("hopf", 80)
    arc = Curve(hopf.vertices[:-1], Mesh((40, 39), (True, False)))
    closed = closed_far_away(arc, (0.0, 0.6, 0.8))
    check_embedded(closed)
    assert closed.mesh.all_closed
    np.testing.assert_array_equal(closed.components[0], hopf.components[0])
    both = Curve(hopf.vertices[1:-1], Mesh((39, 39), (False, False)))
    check_embedded(closed_far_away(both, (0.0, 0.6, 0.8)))


def test_parallel_segments_in_a_plane_are_closed_past_each_other():
    ends = [[x, float(k), 0.0] for k in range(3) for x in (0.0, 2.0)]
    segments = Curve(np.array(ends), Mesh((2, 2, 2), (False,) * 3))
    assert str(knot_type(closed_far_away(segments))) == "unknot ⊔ unknot ⊔ unknot"


@pytest.mark.parametrize(
    ("curve", "count", "said"),
    [
        (knot("3_1"), 5, "all components are closed"),
        (knot("overhand"), 0, "number of closures is 0"),
        (Curve(np.eye(4)[:, :2] + [[0.0, 3.0]], Mesh((4,), (False,))), 5, "dimension 2"),
    ],
)
def test_refusals(curve, count, said):
    with pytest.raises(CurveError, match=said):
        closures(curve, count)
