"""A metric serves several steps, as long as they go well."""

from dataclasses import dataclass, field, replace

import numpy as np
from descent_cases import narrow, start
from descent_contracts import taken
from mobius_flow.core import Curve
from mobius_flow.core.descent import NoStep, Point, State, Step
from mobius_flow.core.descent.directions import LimitedMemoryBFGS
from mobius_flow.core.descent.searches import Armijo, LineSearch
from mobius_flow.core.metrics import InnerProduct, MoebiusMetric
from mobius_flow.core.types import FloatArray


@dataclass(frozen=True)
class Counted(MoebiusMetric):
    """J_C, which remembers the curves that it was made for."""

    curves: list[Curve] = field(default_factory=list)

    def at(self, curve: Curve) -> InnerProduct:
        self.curves.append(curve)
        return super().at(curve)


def counted(point: Point) -> tuple[Point, list[Curve]]:
    metric = Counted()
    return point.within(replace(point.problem, metric=metric)), metric.curves


def test_a_metric_serves_several_steps() -> None:
    point, curves = counted(start())
    state, steps = State(), []
    for _ in range(7):
        steps.append(point)
        step, state = taken(LineSearch(LimitedMemoryBFGS(), Armijo(), metric_steps=3).step(point, state))
        point = step.point
    for curve, p in zip(curves, steps[::3], strict=True):
        np.testing.assert_array_equal(curve.vertices, p.vertices)
    assert [p.metric_age for p in steps] == [0, 1, 2, 0, 1, 2, 0]
    assert steps[2].inner_product is steps[0].inner_product


def test_a_metric_serves_no_longer_where_contact_limits_a_step() -> None:
    point, curves = counted(start())
    point, state = narrow(point, 1e-3), State()
    for _ in range(3):
        step, state = taken(LineSearch(LimitedMemoryBFGS(), Armijo(), metric_steps=3).step(point, state))
        assert step.limited_by is not None
        point = step.point
    assert len(curves) == 3


@dataclass(frozen=True)
class Unless:
    """A search that finds nothing while the metric is an old one."""

    def along(self, point: Point, direction: FloatArray, natural: float, last: float) -> Step | NoStep:
        return NoStep("old") if point.metric_age else Armijo().along(point, direction, natural, last)


def test_a_search_that_fails_gets_the_metric_of_its_curve() -> None:
    rule = LineSearch(LimitedMemoryBFGS(), Unless(), metric_steps=3)
    step, state = taken(rule.step(start(), State()))
    assert step.point.metric_age == 1
    step, _ = taken(rule.step(step.point, state))
    assert step.point.metric_age == 1  # that of the point at which the search succeeded
