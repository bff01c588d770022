"""How fast smooth curves run along their strands: energies do not depend on it, but the number of modes does."""

import numpy as np

from ..curve import Curve
from ..energies.moebius import moebius_by_length
from ..types import FloatArray
from .basis import Basis

_SHARE = 4.0  # energy of a circle, which no pairs account for: it is spread over each component by length


def parameters(curve: Curve) -> list[FloatArray]:
    """Parameters of a closed polygon's vertices that grow with the energy, for each component from 0 to below 1.

    They make curves slow where strands are near: the density of energy beside a strand at distance d is about π/d, and
    that density is Möbius-invariant.
    """
    cuts, found = curve.mesh.offsets[1:-1], []
    for density, ell in zip(np.split(moebius_by_length(curve), cuts), np.split(curve.edge_lengths, cuts), strict=True):
        passed = np.cumsum(ell * density + _SHARE * ell / ell.sum())
        found.append(np.append(0.0, passed[:-1] / passed[-1]))
    return found


def sliding(basis: Basis, z: FloatArray) -> FloatArray:
    """The quadratic form ∫ (d log |γ′| − its average)² of each component, at unknowns z; shape (3N, 3N).

    Added to the energy's Hessian it keeps points from sliding along the curve, which nothing else does.
    """
    v = basis.slopes @ z
    rows = np.einsum("ik,in->ink", v / np.sum(v**2, axis=1, keepdims=True), basis.slopes)
    rows = (rows - basis.averages(rows)).reshape(len(rows), -1)
    return np.asarray((rows.T * basis.weights) @ rows)
