"""A rope's barrier: its derivatives, where it acts and where not."""

import numpy as np
import pytest
from mobius_flow.core import Curve
from mobius_flow.core.collision import is_rope, thickness
from mobius_flow.core.curve import subdivide
from mobius_flow.core.energies.edge_pairs import EdgePairs
from mobius_flow.core.energies.rope import Rope, distance, phi
from mobius_flow.core.knots import knot, overhand
from mobius_flow.core.knots.shapes import smooth_knot
from shapes import regular_polygon
from taylor import derivative_slope, hessian_slope, taylor_slope


def tight(curve, share=0.9):
    radius = np.full(len(curve.mesh.component_sizes), share * thickness(curve))
    return Rope(radius).frozen_at(curve)


CURVES = {
    "knot": lambda: knot("5_2", 120),
    "link": lambda: knot("L6a4", 120),
    "arc": lambda: overhand(60),
    "plane": lambda: Curve(smooth_knot("3_1", 60).vertices[:, :2] * [1, 0.3] + [[0, 0]]),
    "bends": lambda: Curve(regular_polygon(24).vertices * [1.0, 0.5, 1.0]),
}


@pytest.mark.parametrize("name", [name for name in CURVES if name != "plane"])
def test_derivatives(name):
    curve = CURVES[name]()
    rope, v = tight(curve), np.random.default_rng(7).standard_normal(curve.vertices.shape)
    assert rope.value(curve) > 0.0
    assert derivative_slope(rope, curve, v, 1e-4 * curve.length) == pytest.approx(2.0, abs=0.05)
    assert hessian_slope(rope, curve, v, 1e-5 * curve.length) >= 2.9
    product = rope.sparse_hessian(curve) @ v.ravel()
    np.testing.assert_allclose(
        product, rope.hessian_product(curve, v).ravel(), rtol=1e-9, atol=1e-9 * abs(product).max()
    )


def test_two_dimensions():
    curve = Curve(regular_polygon(30, 2).vertices * [1.0, 0.4])
    rope, v = tight(curve), np.random.default_rng(9).standard_normal((30, 2))
    assert rope.value(curve) > 0.0
    assert derivative_slope(rope, curve, v, 1e-5) == pytest.approx(2.0, abs=0.05)


def test_thin_ropes_cost_nothing_and_thick_ones_everything():
    curve = knot("4_1", 150)
    thick = thickness(curve)
    assert Rope(np.array([0.4 * thick])).value(curve) == 0.0
    costs = [Rope(np.array([share * thick])).value(curve) for share in (0.8, 0.9, 0.99)]
    assert 0.0 < costs[0] < costs[1] < costs[2] < np.inf
    value, derivative = Rope(np.array([1.001 * thick])).value_and_derivative(curve)
    assert value == np.inf
    assert not derivative.any()  # rather than NaN


def test_straight_pieces_feel_nothing():
    """However far along they are; other strands are felt from four radii on."""
    t = np.linspace(0.0, 4.0, 41)
    straight = np.stack([t, 0 * t, 0 * t], axis=1)
    assert Rope(np.array([0.3])).value(Curve.from_components([straight], closed=(False,))) == 0.0
    costs = []
    for z in (1.1, 1.3):
        back = straight[::-1] + np.array([0.0, z, 0.0])
        costs.append(Rope(np.array([0.3, 0.3])).value(Curve.from_components([straight, back], closed=(False, False))))
    assert costs[0] > costs[1] == 0.0


def test_it_is_the_sum_of_its_formula():
    """Two straight strands side by side, of which pairs of edges k apart are as far apart as closest ends, or sides."""
    n, h, z, r = 40, 0.1, 0.8, 0.3
    line = h * np.arange(n + 1)[:, None] * [1.0, 0.0, 0.0]
    curve = Curve.from_components([line, line + np.array([0.0, z, 0.0])], closed=(False, False))
    gap = h * (abs(np.subtract.outer(np.arange(n), np.arange(n))) - 1).clip(0)
    share = ((np.hypot(z, gap) - 2.0 * r) / (2.0 * r)).clip(None, 1.0)  # of the way from 2r to 4r
    wanted = 0.05 * (h / r) ** 2 * np.sum(-((1.0 - share) ** 2) * np.log(share))
    assert Rope(np.array([r, r])).value(curve) == pytest.approx(wanted, rel=1e-9)


def test_it_does_not_depend_on_the_unit():
    curve = knot("L6a4", 90)
    scaled = curve.with_vertices(1e3 * curve.vertices)
    radius = np.full(3, 0.9 * thickness(curve))
    assert Rope(1e3 * radius).value(scaled) == pytest.approx(Rope(radius).value(curve), rel=1e-9)


def test_radii_of_components():
    """Two straight strands a distance of 1 apart are ropes of .3 and .6, but not of .5 each."""
    t = np.linspace(0.0, 4.0, 41)
    strands = [np.stack([t, 0 * t, np.full(41, z)], axis=1) for z in (0.0, 1.0)]
    curve = Curve.from_components(strands, closed=(False, False))
    assert 0.0 < Rope(np.array([0.3, 0.6])).value(curve) < np.inf
    assert Rope(np.array([0.3, 0.71])).value(curve) == np.inf
    assert [Rope(np.array([0.3, r])).meets(curve) for r in (0.6, 0.71)] == [False, True]
    assert Rope(np.array([0.1, 0.2])).value(curve) == 0.0


def test_what_is_frozen_stays_until_lengths_change():
    curve = knot("3_1", 60)
    rope = tight(curve)
    assert rope.frozen_at(curve) is rope
    assert rope.frozen_at(curve.with_vertices(1.001 * curve.vertices)) is rope
    assert rope.frozen_at(curve.with_vertices(1.1 * curve.vertices)) is not rope


def test_split_edges_may_bend_as_they_do():
    """A polygon whose edges have been split looks twice as sharp at its old corners: no wall, until it gets smooth."""
    curve = regular_polygon(12)
    middle = 0.5 * (curve.vertices + np.roll(curve.vertices, -1, axis=0))
    finer = Curve(np.stack([curve.vertices, middle], axis=1).reshape(-1, 3))
    rope = Rope(np.array([0.9 * thickness(curve)]))
    assert rope.value(finer) == np.inf
    allowed = rope.frozen_at(finer)
    assert np.isfinite(allowed.value(finer))
    smooth = allowed.frozen_at(regular_polygon(24))
    assert (smooth.tightest == rope.radius).all()
    assert smooth.frozen_at(finer) is smooth, "what has become smooth stays so"


@pytest.mark.parametrize("share", [0.5, 0.8, 1.001])
def test_pairs_in_reach_are_found_by_a_tree_among_all(share):
    curve = knot("7_7", 150)
    rope, r = tight(curve, share), share * thickness(curve)
    walls, every = rope._strands(curve, rope.reach), np.triu_indices(150, 1)
    found = walls(distance(EdgePairs.of(curve.mesh, curve.vertices, walls.i, walls.j)))
    d, way = distance(EdgePairs.of(curve.mesh, curve.vertices, *every)).value, rope._way(*every)
    end = np.minimum(4.0 * r, rope.share * way)
    costs = np.where(way > np.pi * r, phi((d - 2.0 * r) / (end - 2.0 * r))[0], 0.0)
    weight = rope.weight * np.prod([curve.edge_lengths[each] for each in every], axis=0) / r**2
    assert found.value.sum() == pytest.approx((weight * costs).sum(), rel=1e-9)
    assert rope.meets(curve) == np.isinf(costs).any() == (share > 1.0)


@pytest.mark.parametrize("pieces", [10, 20, 40])
def test_a_lone_sharp_corner_has_room_wherever_the_proof_says_so(pieces):
    """Near one of 120° strands half a circle apart along the polygon come nearer than two radii."""
    triangle = Curve([[0.0, 0, 0], [1, 0, 0], [0.5, 0.75**0.5, 0]])
    curve, ropes = subdivide(triangle, np.full(3, pieces)), 0
    for radius in ([0.01], [0.02], [0.05]):
        if is_rope(curve.mesh, curve.vertices, curve.vertices, np.array(radius)):
            assert np.isfinite(Rope(np.array(radius)).frozen_at(curve).value(curve))
            ropes += 1
    assert ropes


@pytest.mark.parametrize("z", [0.02, 0.3, 0.9])
def test_the_barrier_function_has_its_derivatives(z):
    def value(t):
        return float(phi(np.array(z + t))[0])

    assert taylor_slope(value, [float(each) for each in phi(np.array(z))], largest=0.01) > 2.9
    assert [list(each) for each in phi(np.array([-1.0, 0.0, 1.0, 2.0]))] == [[np.inf, np.inf, 0, 0], [0] * 4, [0] * 4]
