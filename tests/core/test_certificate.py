"""What a certificate is about, and where refusals and stalled runs point."""

from dataclasses import replace

import numpy as np
import pytest
from mobius_flow.core import METHODS, Curve, CurveError, RelaxOptions, Status, WithOutcome, relax
from mobius_flow.core.base.errors import Place
from mobius_flow.core.collision import Contact, FreeMotion, survives_rounding
from mobius_flow.core.descent import NoStep, Step, problem
from mobius_flow.core.driver import run as driver
from mobius_flow.core.driver.run import Run
from shapes import regular_polygon, torus_trefoil


def test_the_start_is_the_input_to_the_last_digit():
    vertices = torus_trefoil(36).vertices + np.random.default_rng(83).uniform(1.0, 3.0, size=3)
    vertices[0, 0] = 1.1e-13
    start = Curve(vertices)
    first = next(relax(start, RelaxOptions(vertices=36)))
    assert first.curve.vertices.tobytes() == start.vertices.tobytes()
    units = problem.Units.of(start)
    assert not np.array_equal(units.to_user(units.from_user(start.vertices)), start.vertices)


class Forgetful:
    """A rule that now and then takes a step and proves nothing of it."""

    second_order, other_metrics = False, ()

    def __init__(self):
        self._rule, self._count = METHODS["lbfgs"].rule, 0

    def step(self, point, state):
        step, state = self._rule.step(point, state)
        self._count += 1
        if self._count == 3:
            assert isinstance(step, Step)
            step = replace(step, legs=(step.legs[-1]._replace(proof=FreeMotion(1.0, proved=False)),))
        return step, state


def test_one_step_without_proof_and_nothing_after_it_is_certified(monkeypatch):
    monkeypatch.setattr(driver, "METHODS", {"lbfgs": replace(METHODS["lbfgs"], rule=Forgetful())})
    iterates = relax(torus_trefoil(60), RelaxOptions(max_iterations=6, vertices=60))
    assert [iterate.certified for iterate in iterates] == [True] * 3 + [False] * 4


def test_nothing_is_certified_in_four_dimensions():
    lifted = Curve(np.column_stack([torus_trefoil(30).vertices, 0.1 * np.cos(np.arange(30))]))
    assert not any(each.certified for each in relax(lifted, RelaxOptions(max_iterations=3, vertices=30)))


def test_rounding_that_matters():
    curve = torus_trefoil(40)
    assert survives_rounding(curve)
    assert not survives_rounding(curve.with_vertices(curve.vertices + 1e15))
    near = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0.5, 1e-15, 0.0], [0, 1, 0]])
    assert not survives_rounding(Curve(near))
    near[3, 1] = 1e-12
    assert survives_rounding(Curve(near))


SQUARE = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]


def place(*components):
    """Where a link is refused."""
    with pytest.raises(CurveError) as error:
        relax(Curve.from_components(components))
    return error.value.place


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
