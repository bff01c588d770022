"""Errors and outcomes point at the vertices that their sentences are about."""

import numpy as np
import pytest
from mobius_flow.core import Curve, CurveError, RelaxOptions, Status, WithOutcome, relax
from mobius_flow.core.base.errors import Place
from mobius_flow.core.collision import Contact
from mobius_flow.core.descent import NoStep
from mobius_flow.core.driver.run import Run
from shapes import regular_polygon, torus_trefoil

SQUARE = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]
AWAY = [[9.0, 0.0, 0.0], [9.0, 2.0, 0.0], [9.0, 0.0, 2.0]]
CROSSED = [[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]


def place(*components):
    """Where a link is refused."""
    with pytest.raises(CurveError) as error:
        relax(Curve.from_components(components))
    return error.value.place


@pytest.mark.parametrize(
    ("component", "vertices", "position"),
    [
        ([*SQUARE, SQUARE[3]], (6, 7), (0, 2, 0)),
        ([*SQUARE[1:], SQUARE[0], SQUARE[0]], (6, 7), (0, 0, 0)),
        ([*SQUARE, [0.0, -1.0, 0.0]], (7,), (0, -1, 0)),
        (CROSSED, (3, 4, 5, 6), (1, 1, 0)),
        ([*SQUARE[:3], [0.0, 2e41, 0.0]], (6,), (0, 2e41, 0)),
    ],
    ids=["the same point", "the same point, across the end", "doubled back", "crossing", "too far"],
)
def test_a_refusal_points_at_its_vertices(component, vertices, position):
    found = place(AWAY, component)
    assert found.vertices == vertices
    np.testing.assert_allclose(found.position, position, rtol=1e-6, atol=1e-2)


def test_strands_that_are_too_near_are_found_on_the_refined_curve():
    """What is the matter with the whole curve is nowhere."""
    found = place(SQUARE, [[x, y, 1e-12] for x, y, _ in SQUARE])
    x, y, z = found.position
    assert found.vertices == ()
    assert abs(z) <= 1e-12
    assert min(x, 2 - x, y, 2 - y) == 0
    assert place(1e-60 * regular_polygon(30).vertices) is None


def test_a_stalled_run_points_at_the_edges_in_the_way(monkeypatch):
    monkeypatch.setattr(Run, "step", lambda _: NoStep.because(Contact((3, 39))))
    run = WithOutcome(relax(torus_trefoil(40), RelaxOptions(vertices=40)))
    last = list(run)[-1].curve
    assert run.outcome.status is Status.STALLED
    assert "edge 4 and edge 40 are so close" in run.outcome.message
    assert run.outcome.place == Place((3, 4, 39, 0), tuple(last.midpoints[[3, 39]].mean(axis=0)))
