"""What every search promises on every geometry, and that each of its conditions is needed."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from descent_contracts import (
    assert_armijo,
    assert_certified,
    assert_feasible,
    assert_weak_wolfe,
    point_on,
    taken,
    with_geometry,
)
from mobius_flow.core import Curve, Objective, OptionError
from mobius_flow.core.collision import FreeMotion, Limit
from mobius_flow.core.descent import NoStep, Point, Problem, State, Step
from mobius_flow.core.descent.constrained import Constrained
from mobius_flow.core.descent.directions import ConjugateGradient, LimitedMemoryBFGS, SteepestDescent
from mobius_flow.core.descent.directions.newton import lagrangian_hessian
from mobius_flow.core.descent.methods import StepRule
from mobius_flow.core.descent.penalised import Penalised
from mobius_flow.core.descent.problem import Geometry
from mobius_flow.core.descent.searches import (
    Accelerated,
    Armijo,
    BackwardEuler,
    Escape,
    FirstTrial,
    LineSearch,
    TowardsTargets,
    TrustRegion,
    WeakWolfe,
)
from mobius_flow.core.descent.step import Leg, Rejected, attempt
from mobius_flow.core.metrics import InnerProduct, MoebiusMetric
from mobius_flow.core.taylor import taylor_slope
from mobius_flow.core.types import FloatArray
from shapes import hopf_link, torus_trefoil

GEOMETRIES: dict[str, Geometry] = {"constrained": Constrained(), "penalised": Penalised(50.0)}
SEARCHES = {"armijo": Armijo(), "wolfe": WeakWolfe()}
DIRECTIONS = {"steepest": SteepestDescent(), "cg": ConjugateGradient(), "lbfgs": LimitedMemoryBFGS()}


@cache
def start(geometry: str = "constrained") -> Point:
    """A trefoil that is far from its minimum."""
    rng = np.random.default_rng(31)
    curve = torus_trefoil(60)
    bent = curve.vertices * [1.0, 1.3, 1.1] + 0.02 * rng.normal(size=curve.vertices.shape)
    return with_geometry(point_on(curve.with_vertices(bent)), GEOMETRIES[geometry])


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("search", SEARCHES)
def test_line_searches_keep_their_promises(search: str, direction: str, geometry: str) -> None:
    point, state = start(geometry), State()
    for _ in range(4):
        along, _ = DIRECTIONS[direction].propose(point, state.memory)
        step, state = taken(LineSearch(DIRECTIONS[direction], SEARCHES[search]).step(point, state))
        if search == "armijo":
            assert_armijo(point, step, along)
        else:
            assert_weak_wolfe(point, step, along)
        assert_certified(point, step)
        assert_feasible(step)
        point = step.point


RULES: dict[str, tuple[StepRule, str]] = {
    "trust region": (TrustRegion(), "constrained"),
    "backward Euler": (BackwardEuler(), "constrained"),
    "accelerated": (Accelerated(), "penalised"),
    "accelerated, constrained": (Accelerated(), "constrained"),
}


@pytest.mark.parametrize("name", RULES)
def test_other_rules_keep_theirs(name: str) -> None:
    rule, geometry = RULES[name]
    point, state = start(geometry), State()
    for _ in range(4):
        step, state = taken(rule.step(point, state))
        assert step.point.energy < point.energy
        assert_certified(point, step)
        assert_feasible(step)
        point = step.point


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


class Narrow(Problem):
    """A world in which vertices must not move by more than a given length at once."""

    width: float

    def free_motion(self, start: np.ndarray, end: np.ndarray) -> FreeMotion:
        way = float(np.abs(end - start).max()) / self.units.scale
        return FreeMotion(1.0) if way <= self.width else FreeMotion(self.width / way, (0, 2), Limit.CONTACT)


def narrow(point: Point, width: float) -> Point:
    problem = Narrow(**{name: getattr(point.problem, name) for name in Problem.__dataclass_fields__})
    object.__setattr__(problem, "width", width)
    return point.within(problem)


@pytest.mark.parametrize("name", [*RULES, *(f"{s} {g}" for s in SEARCHES for g in GEOMETRIES)])
def test_no_leg_is_taken_that_is_not_proved(name: str) -> None:
    rule, geometry = RULES.get(name) or (LineSearch(SteepestDescent(), SEARCHES[name.split()[0]]), name.split()[1])
    width = 1e-3
    point = narrow(start(geometry), width)
    step, _ = taken(rule.step(point, State()))
    corners = [point, *(leg.end for leg in step.legs)]
    for a, b in pairwise(corners):
        assert np.abs(b.placed - a.placed).max() / point.problem.units.scale <= width
    assert step.limited_by == (0, 2)


@pytest.mark.parametrize("name", [*RULES, *(f"{s} {g}" for s in SEARCHES for g in GEOMETRIES)])
def test_what_can_not_be_proved_is_said(name: str) -> None:
    rule, geometry = RULES.get(name) or (LineSearch(SteepestDescent(), SEARCHES[name.split()[0]]), name.split()[1])
    step, _ = rule.step(narrow(start(geometry), 0.0), State())
    assert isinstance(step, NoStep)
    assert step.limited_by == (0, 2)
    assert "edges 1 and 3 are so near" in step.reason


def test_a_chord_through_a_strand_is_rejected() -> None:
    """Both ends are good, the straight way between them is not."""
    link = hopf_link(20)
    point = with_geometry(point_on(link), Penalised())
    apart = point.vertices + (np.arange(40) >= 20)[:, None] * [3.0, 0.0, 0.0]
    trial = attempt(point, apart, point.residual, lambda q: True)
    assert isinstance(trial, Rejected)
    assert trial.proof is not None
    assert 0.0 < trial.proof.time < 1.0
    assert trial.in_the_way is not None
    nearer = point.vertices + 0.5 * trial.proof.time * (apart - point.vertices)
    assert isinstance(attempt(point, nearer, point.residual, lambda q: True), Leg)


# -- the first trial ---------------------------------------------------------------------------------------------------


def crossed_rods() -> Point:
    """Two thin triangles with a gap of 1 between edges that cross when seen from above."""
    lower = [[-2.0, 0, 0], [2, 0, 0], [0, 0, -3]]
    upper = [[0.0, -2, 1], [0, 2, 1], [0, 0.5, 4]]
    return point_on(Curve.from_components([lower, upper]))


def test_the_first_trial_is_two_thirds_of_the_first_contact() -> None:
    point = crossed_rods()
    down = (np.arange(6) >= 3)[:, None] * [0.0, 0.0, -1.0]
    contact = 1.0 / point.problem.units.scale
    tau, pair = FirstTrial(max_displacement=100.0)(point, down, np.inf)
    assert tau == pytest.approx(2 / 3 * contact, rel=0.02)
    assert pair is not None
    assert sorted(pair) == [0, 3]


def test_the_first_trial_is_bounded() -> None:
    point = crossed_rods()
    up = (np.arange(6) >= 3)[:, None] * [0.0, 0.0, 4.0]
    assert FirstTrial()(point, up, np.inf) == (0.5 / 4.0, None)
    assert FirstTrial()(point, up, 0.01) == (0.01, None)
    assert FirstTrial()(point, 0.0 * up, np.inf) == (0.0, None)


@pytest.mark.parametrize(("lengths", "bounded"), [("keep", True), ("equal", False)])
def test_step_sizes_recover_where_the_way_to_the_lengths_made_them_short(lengths: str, bounded: bool) -> None:
    point = point_on(start().curve, edge_lengths=lengths)
    step = Armijo().along(point, -point.gradient, np.inf, 1e-100)
    assert isinstance(step, Step) != bounded  # a motion of 10⁻¹⁰⁰ changes no coordinate
    if isinstance(step, Step):
        assert 1e-5 < np.abs(step.size * point.gradient).max() <= 1e-3


def test_steps_grow_by_a_bounded_factor() -> None:
    point = start()
    step, _ = taken(LineSearch(SteepestDescent(), Armijo()).step(point, State(None, 1e-5)))
    assert step.size <= 4e-5


# -- each condition is needed ------------------------------------------------------------------------------------------


def test_armijo_asks_for_half_of_the_predicted_decrease() -> None:
    """There are trials that gain, but less than half of what the slope promises: they are not taken."""
    far = FirstTrial(max_displacement=10.0)
    strict = LineSearch(SteepestDescent(), Armijo(first=far))
    lenient = LineSearch(SteepestDescent(), Armijo(decrease=1e-4, first=far))
    point, seen = start(), 0
    for _ in range(6):
        direction = -point.gradient
        first, _ = taken(lenient.step(point, State()))
        slope = first.size * float(np.sum(point.derivative * direction))
        if first.point.energy > point.energy + 0.45 * slope:
            step, _ = taken(strict.step(point, State()))
            assert_armijo(point, step, direction)
            assert step.size < first.size
            seen += 1
        point = first.point
    assert seen


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_wolfe_does_not_take_steps_that_are_too_short(geometry: str) -> None:
    """A first trial of 10⁻⁴ of a good step gains, but the slope is still what it was."""
    point = start(geometry)
    direction = -1e-4 * point.gradient
    step = WeakWolfe().along(point, direction, 1.0, np.inf)
    assert isinstance(step, Step)
    assert step.size > 100
    assert_weak_wolfe(point, step, direction)


class Underestimating(Objective):
    """An objective whose second derivative is half of what it should be: models of it promise too much."""

    def hessian(self, curve: Curve) -> FloatArray:
        return 0.5 * super().hessian(curve)


def test_trust_region_rejects_what_the_model_did_not_foresee() -> None:
    """Nothing is taken whose actual reduction is less than the required fraction of the predicted one."""
    point = start()
    point = point.within(replace(point.problem, objective=Underestimating()))
    lenient = TrustRegion(first_radius=30.0, newton_threshold=1e-12, first=FirstTrial(max_displacement=30.0))
    step, _ = taken(lenient.step(point, State()))
    assert 0.05 < ratio(point, step.point) < 0.85
    strict = replace(lenient, accept=0.9, poor=0.9, good=0.95)
    shorter, _ = taken(strict.step(point, State()))
    assert ratio(point, shorter.point) > 0.89


def ratio(start: Point, end: Point) -> float:
    """Actual to predicted reduction, the prediction made from the tangential part of the step."""
    s = start.tangent_space.project(end.vertices - start.vertices)
    predicted = -float(np.sum(start.derivative * s) + 0.5 * np.sum(s * lagrangian_hessian(start)(s)))
    return (start.energy - end.energy) / predicted


def test_trust_region_uses_the_last_gradient() -> None:
    """Far from the minimum steps lie in the plane of this gradient and the last one, not in the line of this one."""
    rule = TrustRegion(newton_threshold=1e-12)
    point, state = start(), State()
    first, state = taken(rule.step(point, state))
    last, point = point.gradient, first.point
    step, _ = taken(rule.step(point, state))
    # (42) adds a normal part of second order
    s = point.tangent_space.project(step.point.vertices - point.vertices)
    basis = np.stack([point.gradient.ravel(), point.transport(last).ravel()], axis=1)
    for columns, inside in ((basis, True), (basis[:, :1], False)):
        rest = s.ravel() - columns @ np.linalg.lstsq(columns, s.ravel(), rcond=None)[0]
        assert (np.linalg.norm(rest) < 0.02 * np.linalg.norm(s)) == inside


def test_backward_euler_takes_the_gradient_at_the_end() -> None:
    """w + τ S_P DE(Q) = 0 to a few per cent; with the gradient at the start it is not even near."""
    point = start()
    step, _ = taken(BackwardEuler(first_step=1.0).step(point, State()))
    w = point.tangent_space.project(step.point.vertices - point.vertices)
    explicit = -step.size * point.gradient
    implicit = -step.size * point.tangent_space.gradient(step.point.derivative)[0]
    norm = point.tangent_space.norm
    assert norm(w - implicit) < 0.05 * norm(w)
    assert norm(w - explicit) > 0.2 * norm(w)


def test_nesterov_goes_on_in_the_direction_of_the_last_step() -> None:
    rule = Accelerated()
    point, state = start("penalised"), State()
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


# -- directions --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_conjugate_gradients_by_their_formula(geometry: str) -> None:
    rule = ConjugateGradient()
    last = start(geometry)
    before, memory = rule.propose(last, None)
    np.testing.assert_array_equal(before, -last.gradient)
    betas = []
    for _ in range(8):
        step = Armijo().along(last, before, np.inf, np.inf)
        assert isinstance(step, Step)
        point = step.point
        direction, memory = rule.propose(point, memory)
        u, inner = point.gradient, point.tangent_space.apply
        overlap = np.sum(u * inner(u - point.transport(last.gradient)))
        betas.append(max(0.0, overlap / np.sum(last.gradient * last.tangent_space.apply(last.gradient))))
        expected = -u + betas[-1] * point.transport(before)
        np.testing.assert_allclose(direction, expected, atol=1e-8 * np.abs(expected).max())
        last, before = point, direction
    assert max(betas) > 0.05


def test_lbfgs_satisfies_the_secant_equation() -> None:
    """H y = s for the last displacement s and difference y of gradients, where nothing is constrained."""
    from mobius_flow.core.descent.directions.lbfgs import _two_loops

    first = start("penalised")
    rule = LimitedMemoryBFGS()
    d, memory = rule.propose(first, None)
    step = WeakWolfe().along(first, d, 1.0, np.inf)
    assert isinstance(step, Step)
    point = step.point
    _, memory = rule.propose(point, memory)
    ((s, y),) = memory.pairs
    np.testing.assert_allclose(y, point.derivative - first.derivative)

    class AtDifference:
        """The last point with y in place of its derivative."""

        derivative, tangent_space, transport = y, point.tangent_space, point.transport

    np.testing.assert_allclose(_two_loops(AtDifference(), memory.pairs), s, atol=1e-9 * np.abs(s).max())  # type: ignore[arg-type]


# -- the penalty -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("penalty", [1.0, 1e4])
def test_the_penalised_energy_has_slope_two(penalty: float) -> None:
    curve = torus_trefoil(40)
    point = with_geometry(point_on(curve), Penalised(penalty))
    rng = np.random.default_rng(5)
    stretched = point.problem.at(point.vertices * [1.1, 0.9, 1.0] + 0.01 * rng.normal(size=point.vertices.shape))
    v = 0.01 * rng.normal(size=point.vertices.shape)
    terms = [stretched.energy, float(np.sum(stretched.derivative * v))]
    slope = taylor_slope(lambda t: stretched.problem.at(stretched.vertices + t * v).energy, terms, largest=1.0)
    assert slope == pytest.approx(2, abs=0.1)
    lengths = stretched.problem.constraints.lengths
    by_hand = penalty * np.sum(lengths * np.log(stretched.curve.edge_lengths / lengths) ** 2)
    assert stretched.energy - stretched.problem.objective.value(stretched.curve) == pytest.approx(by_hand)


def test_escape_leaves_a_maximum_along_a_line() -> None:
    """From a point of negative curvature both ways lead down by the required decrease."""
    point = start()
    direction = point.gradient / point.gradient_norm  # not critical, but one of the two ways leads down all the same
    step = Escape().step(point, direction, -1.0)
    assert isinstance(step, Step)
    assert step.point.energy < point.energy - 0.05 * step.size**2
    assert_certified(point, step)


# -- values are checked ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "make",
    [
        lambda: FirstTrial(collision_fraction=1.5),
        lambda: FirstTrial(max_displacement=0.0),
        lambda: FirstTrial(growth=0.5),
        lambda: TowardsTargets(least_share=2.0),
        lambda: Armijo(decrease=0.0),
        lambda: WeakWolfe(decrease=0.95),
        lambda: TrustRegion(accept=0.9),
        lambda: BackwardEuler(first_step=-1.0),
        lambda: Escape(longest=float("nan")),
        lambda: Penalised(-1.0),
        lambda: Constrained(contraction=2.0),
    ],
)
def test_constants_are_checked(make: Callable[[], object]) -> None:
    with pytest.raises(OptionError, match="must"):
        make()
