"""Each condition of a search is needed: what would pass without it is rejected."""

from dataclasses import replace

import numpy as np
import pytest
from descent_cases import GEOMETRIES, start
from descent_contracts import assert_armijo, assert_certified, assert_weak_wolfe, taken
from mobius_flow.core import Objective
from mobius_flow.core.descent import SearchState, Step
from mobius_flow.core.descent.directions import SteepestDescent
from mobius_flow.core.descent.hessian import lagrangian_hessian
from mobius_flow.core.descent.line_searches import Armijo, FirstTrial, LineSearch
from mobius_flow.core.descent.second_order import TrustRegion, step_off
from mobius_flow.lab.methods import Accelerated, BackwardEuler, WeakWolfe


def test_armijo_asks_for_half_of_the_predicted_decrease():
    """There are trials that gain, but less than half of what the slope promises: they are not taken."""
    far = FirstTrial(max_displacement=10.0)
    strict = LineSearch(SteepestDescent(), Armijo(first=far))
    lenient = LineSearch(SteepestDescent(), Armijo(decrease=1e-4, first=far))
    point, seen = start(), 0
    for _ in range(6):
        direction = -point.gradient
        first, _ = taken(lenient.step(point, SearchState()))
        slope = first.size * float(np.sum(point.derivative * direction))
        if first.point.energy > point.energy + 0.45 * slope:
            step, _ = taken(strict.step(point, SearchState()))
            assert_armijo(point, step, direction)
            assert step.size < first.size
            seen += 1
        point = first.point
    assert seen


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_wolfe_does_not_take_steps_that_are_too_short(geometry):
    """A first trial of 10⁻⁴ of a good step gains, but the slope is still what it was."""
    point = start(geometry)
    direction = -1e-4 * point.gradient
    step = WeakWolfe().along(point, direction, 1.0, np.inf)
    assert isinstance(step, Step)
    assert step.size > 100
    assert_weak_wolfe(point, step, direction)


class Underestimating(Objective):
    """An objective whose second derivative is half of what it should be: models of it promise too much."""

    def hessian(self, curve):
        return 0.5 * super().hessian(curve)


def test_trust_region_rejects_what_the_model_did_not_foresee():
    """Nothing is taken whose actual reduction is less than the required fraction of the predicted one."""
    point = start()
    point = point.within(replace(point.problem, objective=Underestimating()))
    lenient = TrustRegion(first_radius=30.0, newton_threshold=1e-12, first=FirstTrial(max_displacement=30.0))
    step, _ = taken(lenient.step(point, SearchState()))
    assert 0.05 < ratio(point, step.point) < 0.85
    strict = replace(lenient, accept=0.9, poor=0.9, good=0.95)
    shorter, _ = taken(strict.step(point, SearchState()))
    assert ratio(point, shorter.point) > 0.89


def ratio(start, end):
    """Actual to predicted reduction, the prediction made from the tangential part of the step."""
    s = start.tangent_space.project(end.vertices - start.vertices)
    predicted = -float(np.sum(start.derivative * s) + 0.5 * np.sum(s * lagrangian_hessian(start)(s)))
    return (start.energy - end.energy) / predicted


def test_trust_region_uses_the_last_gradient():
    """Far from the minimum steps lie in the plane of this gradient and the last one, not in the line of this one."""
    rule = TrustRegion(newton_threshold=1e-12)
    point, state = start(), SearchState()
    first, state = taken(rule.step(point, state))
    last, point = point.gradient, first.point
    step, _ = taken(rule.step(point, state))
    # (42) adds a normal part of second order
    s = point.tangent_space.project(step.point.vertices - point.vertices)
    basis = np.stack([point.gradient.ravel(), point.transport(last).ravel()], axis=1)
    for columns, inside in ((basis, True), (basis[:, :1], False)):
        rest = s.ravel() - columns @ np.linalg.lstsq(columns, s.ravel(), rcond=None)[0]
        assert (np.linalg.norm(rest) < 0.02 * np.linalg.norm(s)) == inside


def test_backward_euler_takes_the_gradient_at_the_end():
    """w + τ S_P DE(Q) = 0 to a few per cent; with the gradient at the start it is not even near."""
    point = start()
    step, _ = taken(BackwardEuler(first_step=1.0).step(point, SearchState()))
    w = point.tangent_space.project(step.point.vertices - point.vertices)
    explicit = -step.size * point.gradient
    implicit = -step.size * point.tangent_space.gradient(step.point.derivative)[0]
    norm = point.tangent_space.norm
    assert norm(w - implicit) < 0.05 * norm(w)
    assert norm(w - explicit) > 0.2 * norm(w)


def test_nesterov_goes_on_in_the_direction_of_the_last_step():
    rule = Accelerated()
    point, state = start("penalised"), SearchState()
    points = [point]
    for _ in range(4):
        step, state = taken(rule.step(points[-1], state))
        points.append(step.point)
    assert state.memory is not None
    step, _ = taken(rule.step(points[-1], state))
    assert len(step.legs) == 2
    momentum = points[-1].vertices - points[-2].vertices
    ahead = step.legs[0].end.vertices - points[-1].vertices
    beta = float(np.sum(ahead * momentum) / np.sum(momentum**2))
    np.testing.assert_allclose(ahead, beta * momentum, atol=1e-12)
    t = 1.0
    for _ in range(4):
        t = 0.5 * (1 + np.sqrt(1 + 4 * t * t))
    assert beta == pytest.approx((t - 1.0) / (0.5 * (1 + np.sqrt(1 + 4 * t * t))), rel=1e-6)


def test_escape_leaves_a_maximum_along_a_line():
    """From a point of negative curvature both ways lead down by the required decrease."""
    point = start()
    direction = point.gradient / point.gradient_norm  # not critical, but one of the two ways leads down all the same
    step = step_off(point, direction, -1.0)
    assert isinstance(step, Step)
    assert step.point.energy < point.energy - 0.05 * step.size**2
    assert_certified(point, step)
