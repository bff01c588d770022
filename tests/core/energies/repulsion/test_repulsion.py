"""The repulsion as a term of the objective: derivatives, invariances, divergence, and what a line search sees."""

import numpy as np
import pytest
from mobius_flow.core import Curve, MoebiusEnergy, Objective
from mobius_flow.core.curve.obstacle import Obstacle
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.energies import Weighted
from mobius_flow.core.energies.repulsion import Repulsion
from mobius_flow.core.energies.repulsion.repulsion import OUTDATED, THETA
from repulsion_references import potential_by_quadrature, repulsion, soup, sphere, wavy
from tasks import wanted
from taylor import derivative_slope, hessian_slope

BALL = sphere(2)
FRAME = Obstacle([[1.2, -1, -1], [1.2, 1, -1], [1.2, 1, 1], [1.1, -1, 1]], [[0, 1], [1, 2], [2, 3], [3, 0]])
TRIANGLE = Obstacle([[0, 0, 0], [1, 0, 0], [0.2, 0.9, 0]], [[0, 1, 2]], "triangle")
SEGMENT = Obstacle([[0, 0, 0], [1, 0, 0]], [[0, 1]], "segment")
FAR, H = 1e4, 0.01
PLANE = Obstacle([[-FAR, -FAR, 0], [FAR, -FAR, 0], [0, FAR, 0]], [[0, 1, 2]])
LINE = Obstacle([[-FAR, 0, 0], [FAR, 0, 0]], [[0, 1]])
STRIP = Curve([[0.0, 0, H], [1.0, 0, H], [0.5, 0, H + 40.0]])  # an edge along both at the distance h, others far away
ARCS = Curve.from_components([wavy(20).vertices, wavy(30).vertices + 5.0], [False, True])


def over_triangle(gap, shape="face"):
    """A curve that comes as near as ``gap`` to a face, with an edge along it or a vertex towards it, or to a side."""
    far = [[0.8, 0.4, 0.9], [0.1, 0.5, 1.1], [-0.3, -0.2, 0.8]]
    near = {
        "face": [[0.3, 0.15, gap], [0.5, 0.2, gap], [0.5, 0.3, 0.4]],
        "vertex": [[0.2, 0.1, 0.5], [0.4, 0.25, gap], [0.6, 0.2, 0.5]],
        "side": [[0.3, -gap, -0.4], [0.4, -gap, 0.4], [0.6, -0.2, 0.6]],
    }[shape]
    return Curve([*near, *far])


def assert_slopes(term, curve, largest=1e-3):
    """Of both derivatives; the second one is symmetric as a matrix too."""
    v = np.random.default_rng(11).normal(size=curve.vertices.shape)
    assert derivative_slope(term, curve, v, largest) == pytest.approx(2, abs=0.05)
    assert hessian_slope(term, curve, v, largest) == pytest.approx(3, abs=0.1)
    product = term.hessian_product(curve, v).ravel()
    matrix = term.hessian(curve) if isinstance(term, Objective) else term.sparse_hessian(curve).toarray()
    np.testing.assert_allclose(matrix, matrix.T, rtol=0, atol=1e-13 * np.abs(matrix).max())
    np.testing.assert_allclose(matrix @ v.ravel(), product, rtol=0, atol=1e-11 * np.abs(product).max())


CASES = {
    "in a ball": (BALL, wavy(24)),
    "near a ball": (BALL, wavy(24, 0.9)),
    "far from a ball": (BALL, Curve(wavy(24).vertices + np.array([50.0, 0, 0]))),
    "by a frame": (FRAME, wavy(24)),
    "far from a frame": (FRAME, Curve(wavy(24).vertices - np.array([50.0, 0, 0]))),
    "arcs in a ball": (BALL, ARCS),
    "arcs by a frame": (FRAME, ARCS),
}
CASE = pytest.mark.parametrize(("obstacle", "curve"), CASES.values(), ids=CASES)


def test_a_sum_over_edges_and_simplices():
    curve = Curve([[0.0, 0, 0], [0.5, 0.1, 0], [0.3, 0.6, 0.2]])
    triangles = Obstacle([[1, 0, 1], [2, 0, 1], [1, 1, 1.5], [-1, 0, 1]], [[0, 1, 2], [0, 2, 3]])
    points, weights = np.polynomial.legendre.leggauss(6)
    for obstacle in (triangles, FRAME):
        expected = 0.0
        for a, e in zip(curve.vertices, curve.edge_vectors, strict=True):
            for point, weight in zip(points, weights, strict=True):
                potentials = [potential_by_quadrature(c, a + 0.5 * (1 + point) * e) for c in obstacle.corners]
                expected += 0.5 * weight * np.linalg.norm(e) * sum(potentials)
        assert repulsion(obstacle).value(curve) == pytest.approx(expected, rel=1e-7)


@CASE
@pytest.mark.parametrize("theta", [0.0, THETA])
def test_derivatives(obstacle, curve, theta):
    assert_slopes(repulsion(obstacle, theta).frozen_at(curve), curve)


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize(
    ("obstacle", "shape"), [(TRIANGLE, "face"), (TRIANGLE, "vertex"), (TRIANGLE, "side"), (SEGMENT, "side")]
)
def test_derivatives_near_contact(obstacle, shape, gap):
    curve = over_triangle(gap, shape)
    assert_slopes(repulsion(obstacle).frozen_at(curve), curve, 0.02 * gap)


@CASE
@pytest.mark.parametrize("scale", [1e-30, 1e-3, 1e30])
def test_similarities_and_midpoints_of_edges(obstacle, curve, scale):
    rotation = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
    offset = scale * np.array([1.0, -2.0, 3.0])
    value, derivative = repulsion(obstacle, THETA).value_and_derivative(curve)
    moved = Obstacle(scale * obstacle.vertices @ rotation + offset, obstacle.faces)
    same = curve.with_vertices(scale * curve.vertices @ rotation + offset)
    moved_value, moved_derivative = repulsion(moved, THETA).value_and_derivative(same)
    # the tree is cut along other axes
    assert moved_value == pytest.approx(value, rel=2e-3)
    expected = derivative @ rotation / scale
    np.testing.assert_allclose(moved_derivative, expected, rtol=0, atol=1e-2 * np.abs(expected).max())
    exact = repulsion(obstacle).value(curve)
    assert repulsion(moved).value(same) == pytest.approx(exact, rel=1e-8)
    if curve.mesh.all_closed:
        halved = Curve(np.stack([same.vertices, same.midpoints], axis=1).reshape(-1, 3))
        assert repulsion(moved).value(halved) == pytest.approx(exact, rel=1e-8)


@pytest.mark.parametrize(("obstacle", "rate"), [(TRIANGLE, 2 * np.pi), (SEGMENT, 4 * np.pi)])
def test_contact_takes_infinitely_much(obstacle, rate):
    """Past the side of a triangle 2π/sin θ · log(1/gap), past a segment twice that, as past a strand of the curve.

    Along a face it takes 2π/gap on each unit of length.
    """
    values = [repulsion(obstacle).value(over_triangle(10.0**-k, "side")) for k in range(4, 10)]
    sine = 0.8 / np.hypot(0.1, 0.8)
    assert np.diff(values)[-1] == pytest.approx(rate / sine * np.log(10), rel=1e-3)
    length = np.hypot(0.2, 0.05)
    for gap in (1e-5, 1e-7):
        assert gap * repulsion(TRIANGLE).value(over_triangle(gap)) == pytest.approx(2 * np.pi * length, rel=200 * gap)


@pytest.mark.parametrize("obstacle", [BALL, FRAME], ids=["ball", "frame"])
def test_a_search_sees_one_smooth_function_while_its_schedule_suits(obstacle):
    curve, term = wavy(40, 0.8), repulsion(obstacle, THETA)
    frozen = term.frozen_at(curve)
    assert frozen.value(curve) == term.value(curve)
    assert frozen.frozen_at(curve.with_vertices(curve.vertices)) is frozen
    near = curve.with_vertices(curve.vertices * 1.001)
    assert frozen.frozen_at(near) is frozen
    assert frozen.value(near) == pytest.approx(term.value(near), rel=1e-5)
    far = wavy(40, 0.3)
    assert frozen.frozen_at(far) is not frozen or frozen.schedule.suits(far, term.clusters, OUTDATED)
    assert len(frozen.frozen_at(wavy(41)).schedule.curve) == 41
    far, near = over_triangle(0.3), over_triangle(1e-5)
    frozen = repulsion(TRIANGLE).frozen_at(far)
    assert not frozen.schedule.suits(near, frozen.clusters, OUTDATED)
    assert frozen.value(near) == repulsion(TRIANGLE).value(near)


def test_an_objective_is_the_weighted_sum_of_its_terms():
    curve = wavy(20)
    obstacles = [BALL, FRAME, sphere(1, radius=2.0)]
    plain, whole = Objective.of(MoebiusEnergy()), Objective.of(MoebiusEnergy(), obstacles)
    assert plain.further == ()
    assert plain.value(curve) == Objective().value(curve)
    parts = [Repulsion.of([obstacle])[0] for obstacle in obstacles]
    assert [len(term.clusters.simplices.corners) for term, _ in whole.further] == [3, 2]
    assert whole.value(curve) == pytest.approx(plain.value(curve) + sum(part.value(curve) for part in parts), rel=1e-3)
    frozen = whole.frozen_at(curve)
    assert frozen.frozen_at(curve) is frozen
    heavy = Objective(further=tuple(Weighted(term, 2.5) for term, _ in whole.further)).frozen_at(curve)
    assert_slopes(frozen, curve)
    assert_slopes(heavy, curve)
    difference = whole.value(curve) - plain.value(curve)
    assert heavy.value(curve) - plain.value(curve) == pytest.approx(2.5 * difference, rel=1e-9)
    np.testing.assert_allclose(heavy.clearance(curve), whole.clearance(curve), rtol=1e-9)
    np.testing.assert_allclose(heavy.stiffness(curve).toarray(), 2.5 * whole.stiffness(curve).toarray())


@pytest.mark.parametrize("obstacle", [PLANE, LINE], ids=["plane", "line"])
def test_stiffness_and_clearance_of_a_plane_or_a_line(obstacle):
    """Φ'' = 4π/h³ of both, integrated along an edge at the distance h.  Of several obstacles the nearest counts."""
    term, up = repulsion(obstacle), np.array([[0.0, 0, 1], [0.0, 0, 1], [0.0, 0, 0]])
    stiffness = term.stiffness(STRIP).diagonal()
    assert stiffness[0] == pytest.approx(0.5 * 4 * np.pi / H**3, rel=1e-2)
    assert np.all(stiffness >= 0.0)
    assert np.sum(up * term.hessian_product(STRIP, up)) == pytest.approx(4 * np.pi / H**3, rel=2e-2)
    for obstacles in ([obstacle], [PLANE, Obstacle(LINE.vertices - [0, 0, H], LINE.faces)]):
        clearance = Objective.of(MoebiusEnergy(), obstacles).clearance(STRIP)
        assert clearance[0] == pytest.approx(H, rel=1e-2)
        assert (clearance[1:] > 2.0 * H).all()
    assert np.array_equal(Objective.of(MoebiusEnergy()).clearance(STRIP), np.full(3, np.inf))


def test_a_run_has_stiffness_in_its_metric_and_clearance_in_the_units_of_the_user():
    curve = wavy(24)
    point = start_problem(*wanted(curve, vertices=24, avoid=[BALL])).at_curve(curve)
    ((term, _),) = point.problem.objective.further
    expected = point.problem.metric.at(point.curve).dense() + term.stiffness(point.curve).toarray()
    assert np.allclose(point.inner_product.dense(), expected, rtol=1e-12, atol=0.0)
    large, ball = Curve(1000.0 * curve.vertices + 7.0), Obstacle(1000.0 * BALL.vertices + 7.0, BALL.faces)
    clearance = start_problem(*wanted(large, vertices=24, avoid=[ball])).clearance(large)
    assert clearance == pytest.approx(1000.0 * Objective.of(MoebiusEnergy(), [BALL]).clearance(curve), rel=1e-3)


@pytest.mark.parametrize("named", [[0, 1, 1], [0, 0, 1], [1, 0, 1]])
def test_segments_among_triangles_repel_as_segments(named):
    """They are triangles that name a vertex twice."""
    mixed = Obstacle(
        np.concatenate([BALL.vertices, FRAME.vertices]), [*BALL.faces, *(FRAME.faces[:, named] + len(BALL.vertices))]
    )
    objective = Objective.of(MoebiusEnergy(), [mixed])
    assert [len(term.clusters.simplices.corners) for term, _ in objective.further] == [3, 2]
    expected = Objective.of(MoebiusEnergy(), [BALL, FRAME]).value(wavy(24))
    assert objective.value(wavy(24)) == pytest.approx(expected, rel=1e-12)


def test_thin_triangles_give_numbers_and_what_has_no_area_repels_nothing():
    """Clusters of what has no area alone have no centroid; meshes have some."""
    rng = np.random.default_rng(6)
    corners = rng.normal(size=(50, 3, 3))
    corners[:, 2] = corners[:, 0] + 0.4 * (corners[:, 1] - corners[:, 0]) + 1e-9 * rng.normal(size=(50, 3))
    value, derivative = repulsion(soup(corners), THETA).value_and_derivative(wavy(30, 2.0))
    assert np.isfinite(value)
    assert np.isfinite(derivative).all()
    flat = np.array([[[5.0, 0, 0]] * 3, [[5.0, 0, 0]] * 3, [[5.0, 0, 0], [6, 0, 0], [5.5, 0, 0]]])
    assert Repulsion.of([soup(flat)]) == ()
    both, alone = (Repulsion.of([soup(c)])[0] for c in (np.concatenate([BALL.corners, flat]), BALL.corners))
    np.testing.assert_array_equal(both.clusters.spread, alone.clusters.spread)
