"""Energies, terms, metrics and constraints of others are tried before a run, and what is wrong with them is said."""

from contextlib import nullcontext
from dataclasses import dataclass

import numpy as np
import pytest
import scipy.sparse as sp
from mobius_flow.core import OptionError, RelaxOptions, relax
from mobius_flow.core.energies import ENERGIES, KPointEnergy
from mobius_flow.core.energies.density import TangentPointDensity
from mobius_flow.core.energies.quadrature import ENDS
from mobius_flow.core.solve.metrics import L2Metric, SparseInnerProduct
from shapes import torus_trefoil


@dataclass(frozen=True)
class Height:
    """Σ z², but for what is wrong."""

    slope: float = 2.0
    value_there: float = 1.0  # factor of the value beside the derivative
    undefined: bool = False
    flat: bool = False  # a derivative of another shape
    name = "height"

    def value(self, curve):
        return float("nan") if self.undefined else float(np.sum(curve.vertices[:, 2] ** 2))

    def value_and_derivative(self, curve):
        derivative = self.slope * curve.vertices * [0.0, 0.0, 1.0]
        return self.value_there * self.value(curve), derivative[:, 2] if self.flat else derivative


class Jagged(Height):
    """Not smooth at any scale: differences say nothing."""

    def value(self, curve):
        return float(np.sum(np.random.default_rng(abs(hash(curve.vertices.tobytes()))).random(3)))


@dataclass(frozen=True)
class Lopsided(L2Metric):
    """L² with something that is not symmetric, or of the wrong sign."""

    factor: float = 1.0
    more: float = 0.0

    def at(self, curve):
        n = len(curve)
        shifted = sp.diags_array(np.ones(n - 1), offsets=1, shape=(n, n))
        return SparseInnerProduct(sp.csr_array(self.factor * sp.eye_array(n) + self.more * shifted))


def start(**options):
    next(relax(torus_trefoil(40), RelaxOptions(vertices=40, **options)))


@pytest.mark.parametrize(
    ("term", "said"),
    [
        (Height(), None),
        (Jagged(), None),
        (Height(slope=-2.0), r"has the slope \S+ by its derivative and -\S+ by its values; its derivative has the w"),
        (Height(slope=4.0), r"has the slope (\S+) by its derivative and \S+ by its values; correct its derivative"),
        (Height(value_there=2.0), "is .* by value, and .* by value_and_derivative at one curve"),
        (Height(undefined=True), "is nan at the start; its value must be one finite number"),
        (Height(flat=True), r"has a derivative that is of shape \(40,\); give finite numbers, of shape \(40, 3\)"),
    ],
)
def test_a_term_is_right_or_its_fault_is_told(term, said):
    with pytest.raises(OptionError, match=f"term 'height' {said}") if said else nullcontext():
        start(terms=((term, 0.1),))


def test_an_energy_whose_derivative_is_wrong(monkeypatch):
    own = ENERGIES["tangent-point"]
    start(energy=own)
    right = KPointEnergy.value_and_derivative

    def wrong(self, curve):
        value, derivative = right(self, curve)
        return value, -derivative

    monkeypatch.setattr(KPointEnergy, "value_and_derivative", wrong)
    with pytest.raises(OptionError, match=r"energy 'tangent-point' has the slope .* wrong sign"):
        start(energy=own)


@dataclass(frozen=True)
class RealOnly(TangentPointDensity):
    """Not analytic: complex steps are lost, or refused."""

    function: np.ufunc = np.abs

    def derivative(self, pairs):
        own = super().derivative(pairs)
        return own._replace(r2=own.r2.real * self.function(pairs.r2) / self.function(pairs.r2.real))


@pytest.mark.parametrize("more", [{"method": "trust-region"}, {"method": "implicit-h1"}, {"stability": True}])
@pytest.mark.parametrize(
    ("function", "said"),
    [
        (np.abs, "the derivative of energy 'own' has the slope .* by its derivative and .*; correct its derivative"),
        (np.cbrt, "energy 'own' has no second derivative by complex steps: ufunc 'cbrt' not supported"),
    ],
)
def test_a_density_for_real_numbers_alone(more, function, said):
    densities = RealOnly(function=function), TangentPointDensity()
    own, right = (KPointEnergy("own", "own", density, ENDS) for density in densities)
    start(energy=own)
    start(energy=right, **more)
    with pytest.raises(OptionError, match=said):
        start(energy=own, **more)


@pytest.mark.parametrize(
    ("metric", "said"),
    [
        (Lopsided(more=0.5), "metric 'l2' has ⟨u, v⟩ = .* and ⟨v, u⟩ = .* for some u and v"),
        (Lopsided(factor=-1.0), "metric 'l2' has ⟨u, u⟩ = -.* for some u; it must be above 0"),
    ],
)
def test_a_metric_that_is_none(metric, said):
    start(metric=Lopsided())
    with pytest.raises(OptionError, match=said):
        start(metric=metric)
