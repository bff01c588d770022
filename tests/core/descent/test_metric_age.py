"""A metric serves several steps, as long as they go well, but none says of another curve that it is critical."""

from dataclasses import dataclass, field, replace

import numpy as np
from descent_cases import narrow, start
from descent_contracts import point_on, taken
from mobius_flow.core import Curve, RelaxOptions, Status, minimize, relax
from mobius_flow.core.descent import NoStep, SearchState
from mobius_flow.core.descent.directions import LimitedMemoryBFGS
from mobius_flow.core.descent.line_searches import Armijo, LineSearch
from mobius_flow.core.solve.metrics import MoebiusMetric


@dataclass(frozen=True)
class Counted(MoebiusMetric):
    """J_C, which remembers the curves that it was made for."""

    curves: list[Curve] = field(default_factory=list)

    def at(self, curve):
        self.curves.append(curve)
        return super().at(curve)


def counted(point):
    metric = Counted()
    return point.within(replace(point.problem, metric=metric)), metric.curves


def test_a_metric_serves_several_steps():
    point, curves = counted(start())
    state, steps = SearchState(), []
    for _ in range(7):
        steps.append(point)
        step, state = taken(LineSearch(LimitedMemoryBFGS(), Armijo(), metric_steps=3).step(point, state))
        point = step.point
    for curve, p in zip(curves, steps[::3], strict=True):
        np.testing.assert_array_equal(curve.vertices, p.vertices)
    assert [p.metric_age for p in steps] == [0, 1, 2, 0, 1, 2, 0]
    assert steps[2].inner_product is steps[0].inner_product


def test_a_metric_serves_no_longer_where_contact_limits_a_step():
    point, curves = counted(start())
    point, state = narrow(point, 1e-3), SearchState()
    for _ in range(3):
        step, state = taken(LineSearch(LimitedMemoryBFGS(), Armijo(), metric_steps=3).step(point, state))
        assert step.limited_by is not None
        point = step.point
    assert len(curves) == 3


@dataclass(frozen=True)
class Unless:
    """A search that finds nothing while the metric is an old one."""

    def along(self, point, direction, natural, last):
        return NoStep("old") if point.metric_age else Armijo().along(point, direction, natural, last)


def test_a_search_that_fails_gets_the_metric_of_its_curve():
    rule = LineSearch(LimitedMemoryBFGS(), Unless(), metric_steps=3)
    step, state = taken(rule.step(start(), SearchState()))
    assert step.point.metric_age == 1
    step, _ = taken(rule.step(step.point, state))
    assert step.point.metric_age == 1  # that of the point at which the search succeeded


def test_a_curve_has_converged_only_in_its_own_metric():
    """The gradient may be small enough in the metric of the step before, and not in that of the curve."""
    curve, options = start().curve, RelaxOptions(vertices=60, tolerance=1e-3)
    early = list(relax(curve, replace(options, max_iterations=2)))[-1]
    old, own = relative_gradient(early, early.gradient_norm), relative_gradient(early)
    assert 1.1 * old < own
    result = minimize(curve, replace(options, tolerance=0.5 * (old + own)))
    assert result.status is Status.CONVERGED
    assert relative_gradient(result.last) <= 0.5 * (old + own)


def relative_gradient(iterate, norm=None):
    """What tolerances bound: the norm of the projected gradient, by default in the curve's own metric, to √E."""
    norm = point_on(iterate.curve).gradient_norm if norm is None else norm
    return norm / float(np.sqrt(iterate.energy))
