"""Relaxing arcs: they become straight, slip out of knots, and stay in place in links; all of it is proved."""

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, Mesh, RelaxOptions, Status, minimize
from mobius_flow.core.descent.task import Units
from mobius_flow.core.knots import knot_type, overhand
from mobius_flow.core.knots.composite import knotted_ball
from mobius_flow.core.knots.diagrams import linking_numbers, quick_invariants
from shapes import half_circle, opened, regular_polygon, torus_trefoil
from tasks import proved


@pytest.mark.parametrize(
    ("arc", "options"),
    [
        (half_circle(30, 2), {"vertices": 60}),
        (half_circle(30), {"vertices": 60}),
        *((half_circle(20), {"energy": each, "vertices": 50}) for each in ("edge", "moebius-k2", "tangent-point")),
        (half_circle(2), {"vertices": 3}),  # with so few edges that there is no pair, or one, that makes up the energy
        (half_circle(3), {"vertices": 4}),
        (overhand(60), {}),
        pytest.param(overhand(200), {"solver": "hierarchical"}, marks=pytest.mark.slow),
    ],
)
def test_arcs_become_straight(arc, options):
    result, _ = proved(arc, **options)
    assert result.status is Status.CONVERGED
    distance = np.linalg.norm(result.curve.vertices[-1] - result.curve.vertices[0])
    assert result.curve.length / distance - 1.0 < (1e-4 if "energy" in options else 1e-6)
    assert "energy" in options or result.final_energy < 1e-6


def test_single_edges():
    edges = Curve([[0, 0, 0], [1, 0, 0], [0, 0.1, 1], [0, 1, 1]], Mesh((2, 2), (False, False)))
    result, _ = proved(edges, vertices=4, max_iterations=50)
    assert result.final_energy < 0.1 * result.energies[0]  # they drift apart for ever
    np.testing.assert_allclose(result.curve.edge_lengths, [1.0, 0.9])


def test_overhand_arcs_are_knotted():
    for vertices in (40, 120):
        points = overhand(vertices).vertices
        ends = [3 * points[end] - 2 * points[inner] for end, inner in ((-1, -5), (0, 4))]
        closed = Curve([*points, ends[0], (ends[0] + ends[1]) / 2 + [0, 40, 0], ends[1]])
        assert str(knot_type(closed)) == "3_1"


def test_an_arc_leaves_a_ring_that_it_is_not_linked_with():
    height = np.linspace(-1.5, 1.5, 21)
    rod = np.stack([np.full(21, 0.2), 0.1 * np.sin(height + 1.5), height], axis=1)
    curve = Curve.from_components([regular_polygon(60).vertices, rod], [True, False])
    result, _ = proved(curve, vertices=120)
    assert result.energies[0] > 25
    assert result.status is Status.CONVERGED
    assert "unlinked parts" in result.message
    parts = result.curve.components
    middles = [part.mean(axis=0) for part in parts]
    radii = [np.linalg.norm(part - middle, axis=1).max() for part, middle in zip(parts, middles, strict=True)]
    assert np.linalg.norm(middles[1] - middles[0]) > sum(radii)  # balls around them do not meet


def test_what_only_closed_components_have():
    arc = opened(torus_trefoil(60), 0)
    for function in (quick_invariants, linking_numbers):
        with pytest.raises(CurveError, match=r"^component 1 is open; .* are for closed components$"):
            function(arc)
    assert knot_type(arc).names == ()
    assert knotted_ball(arc) is None
    with pytest.raises(CurveError, match=r"component 1 is open; Möbius images of equal energy"):
        minimize(arc, RelaxOptions(balance=True))


def test_units_of_arcs():
    arc = Curve(1e6 * half_circle(30).vertices + 1e7, Mesh((31,), (False,)))
    assert 4 <= arc.length / Units.of(arc).scale <= 8
