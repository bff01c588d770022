"""Soft modes: tangent directions in which the Lagrangian's Hessian is least against the metric, by Lanczos' method."""

from dataclasses import dataclass

import numpy as np

from ...descent import Point
from ...descent.directions.newton import lagrangian_hessian
from ...types import FloatArray

STEPS = 30  # of Lanczos: the few lowest modes are near enough then to be soft, and need be no nearer
EXHAUSTED = 1e-10  # of a vector is new: rounding errors, for there are no more dimensions


@dataclass(frozen=True, eq=False)
class SoftModes:
    """Ritz values, ascending, shape (k,), and Ritz vectors, of length 1 in the metric, shape (k, n, m)."""

    values: FloatArray
    vectors: FloatArray


def soft_modes(point: Point, rng: np.random.Generator, steps: int = STEPS) -> SoftModes:
    """Ritz pairs of J⁻¹(D²E − Σ λ_I D²Φ_I) on ker DΦ, from a random start.

    The metric makes this an operator of order 0 with few eigenvalues below the bulk, which Lanczos' method finds first.
    Each step takes one product with the Hessian and two projections; `stability` is the dense counterpart.
    """
    space, hessian = point.tangent_space, lagrangian_hessian(point)
    basis, duals, images = np.zeros((3, steps, *point.vertices.shape))
    q, count = space.project(rng.normal(size=point.vertices.shape)), 0
    while count < steps:
        before = space.norm(q)
        for _ in range(2):  # once leaves rounding errors that grow from step to step
            q = q - np.tensordot(np.tensordot(duals[:count], q, 2), basis[:count], 1)
        q = space.project(q)  # what is not tangent would grow as well
        length = space.norm(q)
        if length <= EXHAUSTED * before:
            break
        basis[count] = q / length
        duals[count], images[count] = space.apply(basis[count]), hessian(basis[count])
        q = space.gradient(images[count])[0]
        count += 1
    projected = np.tensordot(basis[:count], images[:count], ((1, 2), (1, 2)))
    values, vectors = np.linalg.eigh(0.5 * (projected + projected.T))
    return SoftModes(values, np.tensordot(vectors.T, basis[:count], 1))
