"""The dense reference of soft modes: matrices of the Lagrangian's Hessian and of the metric on ker DΦ; and examples."""

from functools import cache

import numpy as np
from descent_contracts import point_on
from mobius_flow.core import Curve
from mobius_flow.core.base.types import FloatArray
from mobius_flow.core.curve.pins import holds
from mobius_flow.core.descent import Point
from mobius_flow.core.descent.hessian import lagrangian_matrix
from mobius_flow.core.knots import torus_knot
from mobius_flow.core.solve.constraints import ConstraintDerivative
from scipy.linalg import eigh, qr
from shapes import half_circle, hopf_link, regular_polygon, torus_trefoil


def at(curve: Curve, **options: object) -> Point:
    return point_on(curve, edge_lengths="auto", mesh="fixed", **options)


@cache
def saddle(**options: object) -> Point:
    """The torus knot T(3, 4) in its most symmetric position."""
    return at(torus_knot(3, 4, 90), **options)


POINTS = {
    "trefoil": lambda: at(torus_trefoil(60)),
    "saddle": saddle,
    "double eigenvalues": lambda: at(torus_knot(3, 5, 100)),
    "link": lambda: at(hopf_link(40)),
    "arc": lambda: at(half_circle(30)),
    "pins": lambda: at(torus_trefoil(60), pins=(0, 1, 17)),
    "plane": lambda: at(Curve(regular_polygon(30).vertices[:, :2] * [1.0, 0.6])),
    "pentagon": lambda: at(regular_polygon(5)),
    "barrier": lambda: at(torus_knot(3, 5, 60)),
    "hierarchical": lambda: at(torus_knot(3, 4, 120), solver="hierarchical"),
    "two Gauss points": lambda: at(torus_trefoil(60), quadrature_points=2),
}


def dense_modes(point: Point) -> tuple[FloatArray, FloatArray]:
    """All eigenvalues of D²E − Σ λ_I D²Φ_I on ker DΦ against the metric, and the eigenvectors, shape (k, n·m)."""
    n = len(point.vertices)
    tangent = tangent_basis(point.tangent_space.constraints)
    hessian = tangent.T @ lagrangian_matrix(point) @ tangent
    # the metric acts coordinate by coordinate, on all basis vectors at once
    gram = tangent.T @ point.tangent_space.apply(tangent.reshape(n, -1)).reshape(tangent.shape)
    values, vectors = eigh(0.5 * (hessian + hessian.T), 0.5 * (gram + gram.T))
    return values, (tangent @ vectors).T


def tangent_basis(constraints: ConstraintDerivative) -> FloatArray:
    """Orthonormal basis of ker DΦ, 0 at pins, as columns; shape (n·m, unknowns that are free less the rows of DΦ)."""
    (n, m), count, free = constraints.shape, constraints.count, ~holds(constraints.mesh, constraints.pins)
    size = m * np.count_nonzero(free) - count
    basis = np.zeros((n, m, size))
    rows = [constraints.apply_transpose(unit)[free].ravel() for unit in np.eye(count)]
    basis[free] = qr(np.stack(rows, axis=1))[0][:, count:].reshape(-1, m, size)
    return basis.reshape(n * m, size)
