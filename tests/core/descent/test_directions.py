"""Directions and the penalised energy by their formulas."""

import numpy as np
import pytest
from descent_cases import GEOMETRIES, start
from descent_contracts import point_on, with_geometry
from mobius_flow.core.descent import Step
from mobius_flow.core.descent.directions import ConjugateGradient, LimitedMemoryBFGS
from mobius_flow.core.descent.line_searches import Armijo
from mobius_flow.lab.methods import Penalised, WeakWolfe
from shapes import torus_trefoil
from taylor import taylor_slope


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
    """H y = s for the last displacement s and difference y of gradients, where nothing is constrained.

    The same pair once more, from the end back to the start, leaves H as it is.
    """
    first = start("penalised")
    rule = LimitedMemoryBFGS(inverse=lambda covector: first.tangent_space.gradient(covector)[0])
    d, memory = rule.propose(first, None)
    step = WeakWolfe().along(first, d, 1.0, np.inf)
    assert isinstance(step, Step)
    point = step.point
    there, memory = rule.propose(point, memory)
    here, _ = rule.propose(first, memory)
    _, ((s, y),) = memory
    np.testing.assert_allclose(y, point.derivative - first.derivative)
    np.testing.assert_allclose(here - there, s, atol=1e-9 * np.abs(s).max())


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
