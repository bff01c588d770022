"""Thickness: the radius of the thickest tube around a polygon that neither kinks nor touches itself."""

import numpy as np

from ..curve import Curve
from ..curve.distances import arc_distance_of_points
from ..types import FloatArray, IntArray
from .gap import near_edges, scaled_points


def thickness(curve: Curve) -> float:
    """Thickness of polygons, in their units.

    The smaller of two numbers (Rawdon, *Experimental Mathematics* 12, 2003): the least bending radius, and half the
    least distance of points that are further apart along the curve than half a circle of that radius is long.
    Ropelength is the length divided by the thickness.
    """
    bend = float(bending_radii(curve).min())
    points, unit = scaled_points(curve)
    best = float(np.ldexp(2.0 * bend, -unit)) ** 2 if np.isfinite(bend) else np.inf
    best = min(best, 4.0 * len(points))  # of coordinates within ±1

    def bound() -> float:
        return best

    for i, j, squares in near_edges(curve, points, bound):
        # Points just half a circle apart are two radii apart or more (Schur's theorem).  So where the closest points of
        # two edges are nearer along the curve, none of the others can count for less than the bending radius.
        s, t = closest_points(curve, i, j)
        squares = squares[arc_distance_of_points(curve, i, s, j, t) >= np.pi * bend]
        best = min(best, float(squares.min(initial=np.inf)))
    return min(bend, 0.5 * float(np.ldexp(np.sqrt(best), unit)))


def closest_points(curve: Curve, i: IntArray, j: IntArray) -> tuple[FloatArray, FloatArray]:
    """The closest points of edges ``i`` and ``j``, as lengths from their tails, elementwise.

    Of parallel edges side by side they are one of many closest pairs.
    """
    mesh, ell = curve.mesh, curve.edge_lengths
    e, f = curve.edge_vectors[i] / ell[i, None], curve.edge_vectors[j] / ell[j, None]
    D = curve.vertices[mesh.tails[i]] - curve.vertices[mesh.tails[j]]
    ef, De, Df = (np.einsum("pm,pm->p", *pair) for pair in ((e, f), (D, e), (D, f)))
    s = ((ef * Df - De) / np.maximum(1.0 - ef * ef, np.finfo(np.float64).eps)).clip(0.0, ell[i])
    t = (ef * s + Df).clip(0.0, ell[j])
    return (ef * t - De).clip(0.0, ell[i]), t


def bending_radii(curve: Curve) -> FloatArray:
    """At each vertex the radius of the circle that touches both edges, the shorter one at its middle; shape (n,)."""
    ell, tau = curve.edge_lengths, curve.edge_vectors / curve.edge_lengths[:, None]
    before = curve.mesh.previous
    sine, cosine = np.linalg.norm(tau - tau[before], axis=1), np.linalg.norm(tau + tau[before], axis=1)
    with np.errstate(divide="ignore"):
        return np.asarray(0.5 * np.minimum(ell, ell[before]) * cosine / sine)  # ½ min(ℓ, ℓ') / tan(θ/2)
