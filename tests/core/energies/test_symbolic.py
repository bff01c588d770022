"""Local contributions against SymPy: values, first and second derivatives made symbolically."""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
import pytest
import sympy as sp
from energy_references import disjoint_pairs
from mobius_flow.core import Curve, MoebiusEnergy
from mobius_flow.core.energies.density import (
    ArcDensity,
    Arcs,
    Density,
    IshizekiNagasawaDensity,
    PointPairs,
    PointSet,
    TangentPointDensity,
)
from mobius_flow.core.energies.edge_pairs import pair_tiles
from smooth_curves import random_polygon

R2, A, B, C, RHO = sp.symbols("r2 a b c rho", positive=True)
DENSITIES = [
    (ArcDensity(), 1 / R2 - 1 / RHO**2),
    (IshizekiNagasawaDensity(), (1 + C - 2 * A * B / R2) / R2),
    (
        TangentPointDensity(3.0, 6.0),
        ((R2 - A**2) ** sp.Rational(3, 2) + (R2 - B**2) ** sp.Rational(3, 2)) / (2 * R2**3),
    ),
    (TangentPointDensity(4.0, 7.0), ((R2 - A**2) ** 2 + (R2 - B**2) ** 2) / (2 * R2 ** sp.Rational(7, 2))),
]


@pytest.mark.parametrize(("density", "formula"), DENSITIES, ids=lambda x: type(x).__name__)
def test_densities(density: Density, formula: sp.Expr) -> None:
    curve = random_polygon(3, (9, 5), 3)
    tau = curve.edge_vectors / curve.edge_lengths[:, None]
    points = PointSet(0.5, curve.midpoints, tau)
    tile = next(pair_tiles(curve.mesh))
    pairs = PointPairs(points, points, Arcs(curve), tile)
    counted = ~tile.excluded & np.isfinite(pairs.rho)
    numbers = [x[counted] for x in (pairs.r2, pairs.a, pairs.b, pairs.c, pairs.rho)]

    def evaluate(expression: sp.Expr) -> np.ndarray:
        return np.broadcast_to(sp.lambdify((R2, A, B, C, RHO), expression)(*numbers), numbers[0].shape)

    np.testing.assert_allclose(density.value(pairs)[counted], evaluate(formula), rtol=1e-12)
    partials = density.derivative(pairs)
    for symbol, partial in zip((R2, A, B, C, RHO), partials, strict=True):
        value = np.zeros(numbers[0].shape) if partial is None else partial[counted]
        np.testing.assert_allclose(value, evaluate(sp.diff(formula, symbol)), rtol=1e-10, atol=1e-13)


@lru_cache
def local_functions(dimension: int) -> tuple[Callable[..., object], ...]:
    """W_IJ of the default energy, its gradient and its Hessian by e, f and Δ, compiled from symbols."""
    vectors = [[sp.Symbol(f"{name}{k}", real=True) for k in range(dimension)] for name in ("e", "f", "d")]
    e, f, delta = (sp.Matrix(vector) for vector in vectors)
    length, width, r2 = sp.sqrt(e.dot(e)), sp.sqrt(f.dot(f)), delta.dot(delta)
    w = (length * width + e.dot(f)) / r2 - 2 * delta.dot(e) * delta.dot(f) / r2**2
    variables = [symbol for vector in vectors for symbol in vector]
    gradient = [sp.diff(w, x) for x in variables]
    hessian = [[sp.diff(g, x) for x in variables] for g in gradient]
    return tuple(sp.lambdify(variables, form, cse=True) for form in (w, gradient, hessian))


@pytest.mark.parametrize(("sizes", "dimension"), [((7,), 2), ((3, 5), 2), ((6,), 3), ((3, 4), 3)])
def test_default_energy(sizes: tuple[int, ...], dimension: int) -> None:
    """E, DE and D²E, assembled pair by pair as Section 6.1.1 of [RS21] describes it."""
    curve: Curve = random_polygon(5, sizes, dimension)
    value, gradient, hessian = local_functions(dimension)
    n, m = curve.vertices.shape
    # e, f and Δ of the four end points, coordinate by coordinate
    chain = np.kron([[-1, 1, 0, 0], [0, 0, -1, 1], [0.5, 0.5, -0.5, -0.5]], np.eye(m))
    total, first, second = 4.0 * len(sizes), np.zeros(n * m), np.zeros((n * m, n * m))
    for i, j in disjoint_pairs(curve):
        corners = [curve.mesh.tails[i], curve.mesh.heads[i], curve.mesh.tails[j], curve.mesh.heads[j]]
        index = np.ravel([[m * corner + k for k in range(m)] for corner in corners])
        x = chain @ curve.vertices[corners].ravel()
        total += float(value(*x))
        first[index] += chain.T @ np.asarray(gradient(*x))
        second[np.ix_(index, index)] += chain.T @ np.asarray(hessian(*x)) @ chain
    energy, derivative = MoebiusEnergy().value_and_derivative(curve)
    assert energy == pytest.approx(total, rel=1e-13)
    np.testing.assert_allclose(derivative.ravel(), first, rtol=0, atol=1e-12 * np.abs(first).max())
    np.testing.assert_allclose(MoebiusEnergy().hessian(curve), second, rtol=0, atol=1e-12 * np.abs(second).max())
