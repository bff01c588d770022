"""The repulsion as a term of the objective: derivatives, invariances, divergence, and what a line search sees."""

import numpy as np
import pytest
from mobius_flow.core import Curve, MoebiusEnergy, Objective, OptionError
from mobius_flow.core.curve.obstacle import Obstacle
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.energies import ENERGIES, Bending, Weighted
from mobius_flow.core.energies.repulsion import Repulsion
from mobius_flow.core.energies.repulsion.repulsion import OUTDATED, THETA
from repulsion_references import potential_by_quadrature, repulsion, soup, sphere, wavy
from shapes import hopf_link
from tasks import wanted
from taylor import derivative_slope, hessian_slope

BALL = sphere(2)
FRAME = Obstacle([[1.2, -1, -1], [1.2, 1, -1], [1.2, 1, 1], [1.1, -1, 1]], [[0, 1], [1, 2], [2, 3], [3, 0]])
TRIANGLE = Obstacle([[0, 0, 0], [1, 0, 0], [0.2, 0.9, 0]], [[0, 1, 2]], "triangle")
SEGMENT = Obstacle([[0, 0, 0], [1, 0, 0]], [[0, 1]], "segment")


def over_triangle(gap: float, shape: str = "face") -> Curve:
    """A curve that comes as near as ``gap`` to a face, with an edge along it or a vertex towards it, or to a side."""
    far = [[0.8, 0.4, 0.9], [0.1, 0.5, 1.1], [-0.3, -0.2, 0.8]]
    near = {
        "face": [[0.3, 0.15, gap], [0.5, 0.2, gap], [0.5, 0.3, 0.4]],
        "vertex": [[0.2, 0.1, 0.5], [0.4, 0.25, gap], [0.6, 0.2, 0.5]],
        "side": [[0.3, -gap, -0.4], [0.4, -gap, 0.4], [0.6, -0.2, 0.6]],
    }[shape]
    return Curve([*near, *far])


def direction_for(curve: Curve) -> np.ndarray:
    return np.random.default_rng(11).normal(size=curve.vertices.shape)


CASES = {
    "in a ball": (BALL, wavy(24)),
    "near a ball": (BALL, wavy(24, 0.9)),
    "far from a ball": (BALL, Curve(wavy(24).vertices + np.array([50.0, 0, 0]))),
    "by a frame": (FRAME, wavy(24)),
    "far from a frame": (FRAME, Curve(wavy(24).vertices - np.array([50.0, 0, 0]))),
}
CASE = pytest.mark.parametrize(("obstacle", "curve"), CASES.values(), ids=CASES)


def test_a_sum_over_edges_and_simplices() -> None:
    """By Gauss points on each edge and adaptive quadrature over each simplex."""
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
def test_derivatives(obstacle: Obstacle, curve: Curve, theta: float) -> None:
    term, v = repulsion(obstacle, theta).frozen_at(curve), direction_for(curve)
    assert derivative_slope(term, curve, v, largest=1e-3) == pytest.approx(2, abs=0.01)
    assert hessian_slope(term, curve, v, largest=1e-3) == pytest.approx(3, abs=0.05)


@pytest.mark.parametrize("gap", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize(
    ("obstacle", "shape"), [(TRIANGLE, "face"), (TRIANGLE, "vertex"), (TRIANGLE, "side"), (SEGMENT, "side")]
)
def test_derivatives_near_contact(obstacle: Obstacle, shape: str, gap: float) -> None:
    curve = over_triangle(gap, shape)
    term, v = repulsion(obstacle).frozen_at(curve), direction_for(curve)
    largest = 0.02 * gap
    assert derivative_slope(term, curve, v, largest) == pytest.approx(2, abs=0.05)
    assert hessian_slope(term, curve, v, largest) == pytest.approx(3, abs=0.1)


@CASE
def test_hessian_is_symmetric_and_has_the_right_product(obstacle: Obstacle, curve: Curve) -> None:
    term, v = repulsion(obstacle, THETA), direction_for(curve)
    matrix = term.sparse_hessian(curve).toarray()
    np.testing.assert_allclose(matrix, matrix.T, rtol=0, atol=1e-13 * np.abs(matrix).max())
    product = term.hessian_product(curve, v).ravel()
    np.testing.assert_allclose(matrix @ v.ravel(), product, rtol=0, atol=1e-12 * np.abs(product).max())


@CASE
@pytest.mark.parametrize("scale", [1e-30, 1e-3, 1e30])
def test_similarities(obstacle: Obstacle, curve: Curve, scale: float) -> None:
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


@CASE
def test_midpoints_of_edges_change_nothing(obstacle: Obstacle, curve: Curve) -> None:
    halved = np.stack([curve.vertices, curve.midpoints], axis=1).reshape(-1, 3)
    assert repulsion(obstacle).value(Curve(halved)) == pytest.approx(repulsion(obstacle).value(curve), rel=1e-8)


@pytest.mark.parametrize(("obstacle", "rate"), [(TRIANGLE, 2 * np.pi), (SEGMENT, 4 * np.pi)])
def test_crossing_takes_infinitely_much(obstacle: Obstacle, rate: float) -> None:
    """Past the side of a triangle 2π/sin θ · log(1/gap), past a segment twice that, as past a strand of the curve."""
    values = [repulsion(obstacle).value(over_triangle(10.0**-k, "side")) for k in range(4, 10)]
    sine = 0.8 / np.hypot(0.1, 0.8)
    assert np.diff(values)[-1] == pytest.approx(rate / sine * np.log(10), rel=1e-3)


def test_sliding_takes_infinitely_much() -> None:
    """2π/gap on each unit of length."""
    length = np.hypot(0.2, 0.05)
    for gap in (1e-5, 1e-7):
        assert gap * repulsion(TRIANGLE).value(over_triangle(gap)) == pytest.approx(2 * np.pi * length, rel=200 * gap)


@pytest.mark.parametrize("obstacle", [BALL, FRAME], ids=["ball", "frame"])
def test_a_search_sees_one_smooth_function(obstacle: Obstacle) -> None:
    curve = wavy(40, 0.8)
    term = repulsion(obstacle, THETA)
    frozen = term.frozen_at(curve)
    assert frozen.value(curve) == term.value(curve)
    assert frozen.frozen_at(curve.with_vertices(curve.vertices)) is frozen
    near = curve.with_vertices(curve.vertices * 1.001)
    assert frozen.frozen_at(near) is frozen
    assert frozen.value(near) == pytest.approx(term.value(near), rel=1e-5)
    far = wavy(40, 0.3)
    assert frozen.frozen_at(far) is not frozen or frozen.schedule.suits(far, term.clusters, OUTDATED)
    assert len(frozen.frozen_at(wavy(41)).schedule.curve) == 41


def test_a_schedule_that_does_not_suit_is_not_used() -> None:
    far, near = over_triangle(0.3), over_triangle(1e-5)
    term = repulsion(TRIANGLE)
    frozen = term.frozen_at(far)
    assert not frozen.schedule.suits(near, term.clusters, OUTDATED)
    assert frozen.value(near) == term.value(near)


def test_objective_is_the_sum_of_its_terms() -> None:
    curve = wavy(30)
    obstacles = [BALL, FRAME, sphere(1, radius=2.0)]
    plain, whole = Objective.of(MoebiusEnergy()), Objective.of(MoebiusEnergy(), obstacles)
    parts = [Repulsion.of([obstacle])[0] for obstacle in obstacles]
    assert [len(term.clusters.simplices.corners) for term, _ in whole.further] == [3, 2]
    assert whole.value(curve) == pytest.approx(plain.value(curve) + sum(part.value(curve) for part in parts), rel=1e-3)
    v = direction_for(curve)
    frozen = whole.frozen_at(curve)
    assert frozen.frozen_at(curve) is frozen
    assert derivative_slope(frozen, curve, v, largest=1e-3) == pytest.approx(2, abs=0.01)
    assert hessian_slope(frozen, curve, v, largest=1e-3) == pytest.approx(3, abs=0.05)
    product = frozen.hessian_product(curve, v).ravel()
    np.testing.assert_allclose(frozen.hessian(curve) @ v.ravel(), product, atol=1e-11 * np.abs(product).max())


def test_without_obstacles_nothing_is_new() -> None:
    assert Objective.of(MoebiusEnergy()).further == ()
    assert Objective.of(MoebiusEnergy()).value(wavy(30)) == Objective().value(wavy(30))


def test_obstacles_have_second_derivatives_only_if_all_terms_have() -> None:
    assert Objective.of(ENERGIES["edge"], [TRIANGLE]).has_hessian
    objective = Objective.of(ENERGIES["edge"], [TRIANGLE], [Weighted(Bending())])
    assert not objective.has_hessian
    with pytest.raises(OptionError, match="'bending' has no second derivative"):
        objective.hessian_product(over_triangle(0.1), np.zeros((6, 3)))


def test_weight() -> None:
    curve, v = wavy(20), direction_for(wavy(20))
    none, once, heavy = (
        Objective(further=[Weighted(wall, weight) for wall in Repulsion.of([BALL])]) for weight in (0.0, 1.0, 2.5)
    )
    for each in ("value", "hessian", "clearance"):
        a, b, c = (np.asarray(getattr(objective, each)(curve)) for objective in (none, once, heavy))
        expected = b if each == "clearance" else a + 2.5 * (b - a)
        np.testing.assert_allclose(c, expected, rtol=1e-9, atol=1e-9 * np.abs(b).max())
    products = [np.asarray(objective.hessian_product(curve, v)) for objective in (none, once, heavy)]
    np.testing.assert_allclose(products[2] - products[0], 2.5 * (products[1] - products[0]), atol=1e-9)
    derivatives = [objective.value_and_derivative(curve)[1] for objective in (none, once, heavy)]
    np.testing.assert_allclose(derivatives[2] - derivatives[0], 2.5 * (derivatives[1] - derivatives[0]), atol=1e-9)
    stiffness = [objective.stiffness(curve).diagonal() for objective in (once, heavy)]
    np.testing.assert_allclose(stiffness[1], 2.5 * stiffness[0])


def test_thin_triangles_give_numbers() -> None:
    rng = np.random.default_rng(6)
    corners = rng.normal(size=(50, 3, 3))
    corners[:, 2] = corners[:, 0] + 0.4 * (corners[:, 1] - corners[:, 0]) + 1e-9 * rng.normal(size=(50, 3))
    value, derivative = repulsion(soup(corners), THETA).value_and_derivative(wavy(30, 2.0))
    assert np.isfinite(value)
    assert np.isfinite(derivative).all()


def test_second_derivatives_of_arcs() -> None:
    """Which have fewer edges than vertices."""
    curve = Curve.from_components([wavy(20).vertices, wavy(30).vertices + 5.0], [False, True])
    for obstacle in (BALL, FRAME):
        term, v = repulsion(obstacle), np.random.default_rng(5).normal(size=curve.vertices.shape)
        product = term.hessian_product(curve, v)
        np.testing.assert_allclose(term.sparse_hessian(curve) @ v.ravel(), product.ravel(), atol=1e-10)
        assert hessian_slope(term.frozen_at(curve), curve, v, largest=1e-3) == pytest.approx(3.0, abs=0.1)


def test_stiffness_is_the_second_derivative_away_from_a_plane_or_a_line() -> None:
    """Φ'' = 4π/h³ of both, integrated along an edge at the distance h, beside which others count little."""
    far, h = 1e4, 0.01
    plane = Obstacle([[-far, -far, 0], [far, -far, 0], [0, far, 0]], [[0, 1, 2]])
    line = Obstacle([[-far, 0, 0], [far, 0, 0]], [[0, 1]])
    strip = Curve([[0.0, 0, h], [1.0, 0, h], [0.5, 0, h + 40.0]])
    up = np.array([[0.0, 0, 1], [0.0, 0, 1], [0.0, 0, 0]])
    for obstacle in (plane, line):
        term = repulsion(obstacle)
        assert term.stiffness(strip).diagonal()[0] == pytest.approx(0.5 * 4 * np.pi / h**3, rel=1e-2)
        assert np.sum(up * term.hessian_product(strip, up)) == pytest.approx(4 * np.pi / h**3, rel=2e-2)
        assert np.all(term.stiffness(strip).diagonal() >= 0.0)


def test_clearance_is_the_distance_of_a_plane_or_a_line() -> None:
    """On an edge that is along it; the others are further away. Of several obstacles the nearest counts."""
    far, h = 1e4, 0.01
    plane = Obstacle([[-far, -far, 0], [far, -far, 0], [0, far, 0]], [[0, 1, 2]])
    line = Obstacle([[-far, 0, 0], [far, 0, 0]], [[0, 1]])
    strip = Curve([[0.0, 0, h], [1.0, 0, h], [0.5, 0, h + 40.0]])
    for obstacles in ([plane], [line], [plane, Obstacle(line.vertices - [0, 0, h], line.faces)]):
        clearance = Objective.of(MoebiusEnergy(), obstacles).clearance(strip)
        assert clearance[0] == pytest.approx(h, rel=1e-2)
        assert (clearance[1:] > 2.0 * h).all()
    assert np.array_equal(Objective.of(MoebiusEnergy()).clearance(strip), np.full(3, np.inf))


def test_clearance_is_in_the_units_of_the_user() -> None:
    curve = wavy(24).with_vertices(1000.0 * wavy(24).vertices + 7.0)
    ball = Obstacle(1000.0 * BALL.vertices + 7.0, BALL.faces)
    clearance = start_problem(*wanted(curve, vertices=24, avoid=[ball])).clearance(curve)
    assert clearance == pytest.approx(1000.0 * Objective.of(MoebiusEnergy(), [BALL]).clearance(wavy(24)), rel=1e-3)


def test_stiffness_becomes_part_of_the_metric() -> None:
    curve = wavy(24)
    point = start_problem(*wanted(curve, vertices=24, avoid=[BALL])).at_curve(curve)
    ((term, _),) = point.problem.objective.further
    expected = point.problem.metric.at(point.curve).dense() + term.stiffness(point.curve).toarray()
    assert np.allclose(point.inner_product.dense(), expected, rtol=1e-12, atol=0.0)


@pytest.mark.parametrize("named", [[0, 1, 1], [0, 0, 1], [1, 0, 1]])
def test_segments_among_triangles_repel_as_segments(named: list[int]) -> None:
    """They are triangles that name a vertex twice."""
    mixed = Obstacle(
        np.concatenate([BALL.vertices, FRAME.vertices]), [*BALL.faces, *(FRAME.faces[:, named] + len(BALL.vertices))]
    )
    curve, v = wavy(24), direction_for(wavy(24))
    objective = Objective.of(MoebiusEnergy(), [mixed])
    assert [len(term.clusters.simplices.corners) for term, _ in objective.further] == [3, 2]
    assert objective.value(curve) == pytest.approx(Objective.of(MoebiusEnergy(), [BALL, FRAME]).value(curve), rel=1e-12)
    frozen = objective.frozen_at(curve)
    assert derivative_slope(frozen, curve, v, largest=1e-3) == pytest.approx(2, abs=0.01)
    assert hessian_slope(frozen, curve, v, largest=1e-3) == pytest.approx(3, abs=0.05)


def test_a_polyline_repels_as_another_component_does() -> None:
    """What the two have in common of the Möbius energy, of which the midpoint sums leave an error of second order."""
    energy, (curve, other) = MoebiusEnergy(), hopf_link(300).components
    alone = sum(energy.value(Curve(each)) for each in (curve, other))
    following = np.arange(len(other)) + 1
    polyline = Obstacle(other, np.stack([following - 1, following % len(other)], axis=1))
    expected = energy.value(Curve.from_components([curve, other])) - alone
    assert repulsion(polyline, THETA).value(Curve(curve)) == pytest.approx(expected, rel=1e-3)


def test_what_has_no_area_repels_nothing() -> None:
    """Clusters of it alone have no centroid; meshes have some."""
    point, needle = [[5.0, 0.0, 0.0]] * 3, [[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [5.5, 0.0, 0.0]]
    corners = np.array([point, point, needle])
    flat = Obstacle(corners.reshape(-1, 3), np.arange(9).reshape(3, 3))
    assert Repulsion.of([flat]) == ()
    both = Obstacle(np.concatenate([sphere(3).corners.reshape(-1, 3), flat.vertices]), _counted(sphere(3), flat))
    alone = Repulsion.of([sphere(3)])[0].clusters
    np.testing.assert_array_equal(Repulsion.of([both])[0].clusters.spread, alone.spread)


def _counted(*obstacles: Obstacle) -> np.ndarray:
    """Faces of the obstacles' corners, one after the other."""
    return np.arange(3 * sum(len(obstacle.faces) for obstacle in obstacles)).reshape(-1, 3)
