"""A run calls certified what was proved, from the input's last digit on, and nothing after a step that was not."""

from dataclasses import replace

import numpy as np
import pytest
from mobius_flow.core import METHODS, Curve, RelaxOptions, relax
from mobius_flow.core.collision import FreeMotion, Limit, survives_rounding
from mobius_flow.core.descent import NoStep, Point, SearchState, Step, problem
from mobius_flow.core.driver import run as driver
from shapes import torus_trefoil


def test_the_start_is_the_input_to_the_last_digit() -> None:
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

    def __init__(self, limit: Limit) -> None:
        self._rule, self._limit, self._count = METHODS["lbfgs"].rule, limit, 0

    def step(self, point: Point, state: SearchState) -> tuple[Step | NoStep, SearchState]:
        step, state = self._rule.step(point, state)
        self._count += 1
        if self._count == 3:
            assert isinstance(step, Step)
            step = replace(step, legs=(step.legs[-1]._replace(proof=FreeMotion(1.0, None, self._limit)),))
        return step, state


@pytest.mark.parametrize("limit", [Limit.UNTESTED, Limit.CONTACT])
def test_one_step_without_proof_and_nothing_after_it_is_certified(
    limit: Limit, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(driver, "METHODS", {"lbfgs": replace(METHODS["lbfgs"], rule=Forgetful(limit))})
    iterates = relax(torus_trefoil(60), RelaxOptions(max_iterations=6, vertices=60))
    assert [iterate.certified for iterate in iterates] == [True] * 3 + [False] * 4


def test_nothing_is_certified_in_four_dimensions() -> None:
    lifted = Curve(np.column_stack([torus_trefoil(30).vertices, 0.1 * np.cos(np.arange(30))]))
    assert not any(each.certified for each in relax(lifted, RelaxOptions(max_iterations=3, vertices=30)))


def test_rounding_that_matters() -> None:
    curve = torus_trefoil(40)
    assert survives_rounding(curve)
    assert not survives_rounding(curve.with_vertices(curve.vertices + 1e15))
    near = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0.5, 1e-15, 0.0], [0, 1, 0]])
    assert not survives_rounding(Curve(near))
    near[3, 1] = 1e-12
    assert survives_rounding(Curve(near))
