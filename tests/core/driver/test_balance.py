"""Of the Möbius images of a relaxed curve, the one that bends least, and the proved way there."""

import itertools

import numpy as np
import pytest
from mobius_flow.core import Curve, MoebiusEnergy, RelaxOptions, Status, minimize
from mobius_flow.core.collision import thickness
from mobius_flow.core.curve.measures import bending
from mobius_flow.core.driver.moves import balance
from mobius_flow.core.driver.moves.balance import CUT_OFF, Balance, MoebiusImages
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.driver.run import Run
from mobius_flow.core.knots import knot, torus_knot
from mobius_flow.core.solve.constraints import Constraints
from shapes import regular_polygon, torus_trefoil
from smooth_curves import dual_circles
from tasks import proved
from taylor import taylor_slope


def unbalanced(curve, *v):
    """A Möbius image whose edges are about as even as the curve's."""
    return MoebiusImages(curve, curve.edge_lengths).at(np.array([1.0, *v]))


def point(curve, **options):
    return start_problem(curve, RelaxOptions(**options)).at_curve(curve)


def run_at(start):
    return Run(start.problem, Curve(start.placed, start.problem.mesh), RelaxOptions())


def way_to_balance(start):
    return Balance(run_at(start)).way(start)


def rope_of(at):
    """Nine tenths of its thickness, in the user's units; (1,)."""
    return np.array([0.9 * thickness(at.curve) * at.problem.units.scale])


def largest_chord(curve):
    return float(np.linalg.norm(curve.vertices[:, None] - curve.vertices[None], axis=2).max())


def test_the_balanced_image_by_itself():
    given = unbalanced(torus_trefoil(120), 0.3, 0.1, -0.2)
    image = balance.balanced(given)
    assert bending(image) < 0.9 * bending(given)
    assert bending(image) <= 1.001 * bending(torus_trefoil(120))
    assert MoebiusEnergy().value(image) == pytest.approx(MoebiusEnergy().value(given), rel=5e-3)


@pytest.mark.parametrize("curve", [torus_trefoil(120), dual_circles(60)], ids=["trefoil", "Hopf link"])
def test_images_keep_length_place_and_the_ratios_of_edges(curve):
    images = MoebiusImages(curve, curve.edge_lengths)
    image = images.at(np.array([1.0, 0.2, -0.1, 0.3]))
    assert image.length == pytest.approx(curve.length)
    for part in curve.mesh.slices:
        ratio = image.edge_lengths[part] / curve.edge_lengths[part]
        assert ratio.max() / ratio.min() < 1.03, "but for arcs that are longer than their chords"
    barycenters = [each.edge_lengths @ each.midpoints / each.length for each in (curve, image)]
    np.testing.assert_allclose(*barycenters, atol=1e-10)
    itself = images.at(np.array([1.0, 0.0, 0.0, 0.0]))
    assert np.abs(itself.vertices - curve.vertices).max() < 5e-3 * largest_chord(curve)


def test_derivative_that_is_minimised_with():
    images = MoebiusImages(torus_trefoil(60), torus_trefoil(60).edge_lengths)
    q, u = np.array([0.8, 0.1, 0.2, -0.3]), np.array([0.3, -0.2, 0.5, 0.1])
    value, derivative = images.of_vertices(q)
    slope = taylor_slope(lambda t: images.of_vertices(q + t * u)[0], [value, derivative @ u])
    assert slope == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("v", [(0.3, 0.1, 0.2), (-0.1, 0.3, 0.0), (0.4, 0.3, -0.7)])
def test_a_symmetric_knot_is_found_again_by_a_proved_way(v):
    """The Clifford torus knot bends least of all its images; a map and the way back leave nothing of the map."""
    symmetric = torus_knot(2, 3, 200)
    start = point(unbalanced(symmetric, *v))
    assert bending(start.curve) > 1.05 * bending(symmetric)
    steps = way_to_balance(start)
    assert bending(steps[-1].point.curve) == pytest.approx(bending(symmetric), rel=1e-3)
    assert len(steps) > 5
    assert all(step.certified and len(step.legs) == 1 for step in steps)
    for a, b in itertools.pairwise([start.placed, *(step.point.placed for step in steps)]):
        assert start.problem.free_motion(a, b).proved
        assert np.linalg.norm(b - a, axis=1).max() < 0.1 * largest_chord(start.curve)


@pytest.mark.parametrize("curve", [regular_polygon(60), torus_knot(2, 3, 120)], ids=["circle", "trefoil"])
def test_what_bends_least_stays(curve):
    assert way_to_balance(point(curve)) == ()


def uneven_circle():
    angles = np.sort(np.random.default_rng(0).uniform(0.0, 2.0 * np.pi, 30))
    return Curve.from_components([np.stack([np.cos(angles), np.sin(angles), np.zeros(30)], axis=1)])


def test_the_identity_is_no_gain(monkeypatch):
    """Its image, smooth and even, bends less than an uneven polygon; but there is no way to go, and no axis of it."""
    bumpy = uneven_circle().with_vertices(uneven_circle().vertices * np.where(np.arange(30) % 3, 1.0, 1.03)[:, None])
    start, identity = point(bumpy, edge_lengths="equal"), np.array([1.0, 0.0, 0.0, 0.0])
    image = MoebiusImages(start.curve, start.problem.constraints.lengths).at(identity)
    assert bending(image) < 0.95 * bending(start.curve)
    monkeypatch.setattr(balance, "least_bending", lambda *_: [identity])
    assert way_to_balance(start) == ()


def test_what_the_flow_takes_back_is_not_told_as_a_gain():
    result = minimize(uneven_circle(), RelaxOptions(balance=True, vertices=30, edge_lengths="keep"))
    assert result.status is Status.CONVERGED
    assert "balanced: " not in result.message


def test_no_way_leads_through_a_strand():
    """The pole inside a circle, in its plane: it would have to come through the circle from wherever it comes."""
    start, inside = point(regular_polygon(60)), np.array([1.0, -2.0, 0.0, 0.0])
    images = MoebiusImages(start.curve, start.curve.edge_lengths)
    way = Balance(run_at(start))._way
    assert way(start, images, inside, start.problem) == ()
    assert way(start, images, -inside, start.problem) == ()
    outside = np.array([1.0, -0.5, 0.0, 0.0])
    assert way(start, images, outside, start.problem)
    assert way(start, images, -outside, start.problem) == (), "the long way is through the circle"


def test_the_next_best_where_there_is_no_way_to_the_best(monkeypatch):
    start = point(unbalanced(torus_knot(2, 3, 120), 0.3, 0.1, 0.2))
    asked = []

    def no_way(*arguments):
        asked.append(arguments[3])
        return ()

    monkeypatch.setattr(Balance, "_way", no_way)
    assert way_to_balance(start) == ()
    assert len(asked) >= 4
    np.testing.assert_array_equal(asked[::2], -np.array(asked[1::2]))


def test_images_that_bend_more_than_their_vertices_promised_are_passed_over(monkeypatch):
    start = point(unbalanced(torus_knot(2, 3, 120), 0.3, 0.1, 0.2))
    start = start.within(start.problem.as_rope(rope_of(start)))
    found = balance.least_bending(MoebiusImages(start.curve, start.curve.edge_lengths), 3)
    monkeypatch.setattr(balance, "least_bending", lambda *_: [np.array([0.6, 0.8, 0.0, 0.0]), *found])
    end = way_to_balance(start)[-1].point
    assert bending(end.curve) < 0.96 * bending(start.curve)
    assert 0.0 < end.problem.radius <= rope_of(end), "a rope that only keeps its thickness stays one"


def test_lengths_of_links_follow_their_images():
    """Components shrink and grow in a Möbius image: the targets are what they have there, and as even as before."""
    start = point(unbalanced(dual_circles(80), 0.3, 0.4, 0.0))
    steps = way_to_balance(start)
    end = steps[-1].point
    assert isinstance(end.problem.constraints, Constraints)
    assert end.problem.constraints.length_error(end.curve) < 0.01
    assert np.abs(end.residual[len(end.vertices) :]).max() < 1e-10
    shares = [each.curve.edge_lengths[:80].sum() / each.curve.length for each in (start, end)]
    assert abs(shares[1] - 0.5) < abs(shares[0] - 0.5)


@pytest.fixture(scope="module")
def runs():
    return {
        balanced: proved(knot("8_19"), balance=balanced, mesh="fixed", tolerance=1e-3) for balanced in (False, True)
    }


def test_a_balanced_run_bends_less_at_no_more_energy(runs):
    (plain, before), (result, iterates) = runs[False], runs[True]
    assert result.status is Status.CONVERGED
    assert bending(result.curve) < 0.7 * bending(plain.curve)
    assert result.final_energy < plain.final_energy + 1e-3
    assert result.last.edge_length_error < 1e-6
    least, most = bending(result.curve), bending(plain.curve)
    assert f"; balanced: bending reduced from {most:.4g} to {least:.4g} (4π² for a round circle)" in result.message
    assert "energy rose" not in result.message, "that is about the flow's own steps"
    for a, b in zip(before, iterates, strict=False):
        assert np.array_equal(a.curve.vertices, b.curve.vertices), "until it is balanced it is the same run"


@pytest.mark.parametrize(
    ("part", "more", "said"),
    [
        (0.5, 0, False),  # cut off before it is on the way
        pytest.param(1.0, 0, True, marks=pytest.mark.slow),
        pytest.param(1.0, 11, True, marks=pytest.mark.slow),
    ],
)
def test_the_limit_of_iterations_holds_on_the_way(part, more, said, runs):
    limit = int(part * runs[False][0].last.index) + more
    result = minimize(knot("8_19"), RelaxOptions(balance=True, mesh="fixed", tolerance=1e-3, max_iterations=limit))
    assert result.status is Status.ITERATION_LIMIT
    assert result.last.index == limit
    assert result.certified
    assert np.array_equal(result.curve.vertices, runs[True][1][limit].curve.vertices)
    assert (CUT_OFF in result.message) is said
    assert "balanced: " not in result.message


def test_what_is_balanced_already_is_said_to_be():
    result = minimize(knot("3_1"), RelaxOptions(balance=True))
    assert result.message.endswith("; no other shape of the same energy that can be reached bends less")


@pytest.mark.parametrize("method", ["flow-moebius", "penalty-lbfgs"])
def test_every_geometry_goes_there(method):
    start = unbalanced(torus_knot(2, 3, 120), 0.3, 0.1, 0.2)
    result = minimize(start, RelaxOptions(balance=True, method=method, tolerance=1e-2))
    assert result.status is Status.CONVERGED
    assert result.certified
    assert bending(result.curve) < 0.95 * bending(start)
