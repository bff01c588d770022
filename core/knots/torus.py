"""Torus knots and links, on the torus whose strands are evenly spread in the conformal sense."""

import math
from functools import partial

import numpy as np

from ..arguments import checked
from ..curve import Curve
from ..errors import CurveError
from ..types import FloatArray
from .rings import ClosedBraid, Ring

_MAX_TURNS = 2000
_MAX_RADIUS = 1e100  # whose square is still a double


@checked
def torus_knot(p: int, q: int, vertices: int | None = None, *, major: float = 1.0, minor: float | None = None) -> Curve:
    """Make the torus knot T(p, q), or the torus link of gcd(p, q) components.

    It is the stereographic image of (r₁ e^{ipt}, r₂ e^{iqt}) on a flat torus r₁² + r₂² = 1 of the 3-sphere, with
    r₂ = ``minor / major``: it runs p times around the z axis and q times around the tube. Positive p and q give
    the right-handed knot, a negative one its mirror image.

    Parameters
    ----------
    p, q
        Numbers of turns, not 0.
    vertices
        Total number of vertices; by default so many that edges are shorter than strands are apart.
    major, minor
        Radii of the torus and of its tube, 0 < minor < major; the default tube is near the one of least Möbius
        energy, which for T(2, 3) is 0.47407312473.

    Raises
    ------
    CurveError
        If a number or a radius is not allowed, or the vertices are too few.

    Examples
    --------
    >>> torus_knot(2, 3, vertices=90).mesh.component_sizes
    (90,)
    >>> len(torus_knot(3, 3).mesh.component_sizes)
    3
    """
    if not (0 < abs(p) <= _MAX_TURNS and 0 < abs(q) <= _MAX_TURNS):
        raise CurveError(
            f"T({p},{q}) is no torus knot of use; p and q must be whole numbers from 1 to {_MAX_TURNS}, or negative"
        )
    hand = 1 if p * q > 0 else -1
    p, q = abs(p), abs(q)
    minor = major * min(p / math.hypot(p, 1.25 * q), 0.6) if minor is None else minor
    if not 1 / _MAX_RADIUS < minor < major < _MAX_RADIUS:
        raise CurveError(f"major is {major} and minor {minor}; they must satisfy 0 < minor < major, not beyond 1e±100")
    return _smooth(p, q, hand, major, minor).polygon(vertices)


def _smooth(p: int, q: int, hand: int, major: float, minor: float) -> ClosedBraid:
    parts = math.gcd(p, q)
    rings = [Ring(p // parts, partial(_profile, major, minor, hand, q / p, 2 * math.pi * k / p)) for k in range(parts)]
    return ClosedBraid(rings, gap=_gap(p, major, minor), detail=max(60, 16 * max(p, q)))


def _profile(major: float, minor: float, hand: int, slope: float, phase: float, theta: FloatArray) -> FloatArray:
    """Distance from the axis and height at angles (k,) around the axis; shape (k, 2)."""
    phi = slope * theta + phase
    # Turning from outwards to upwards while going round is a left-handed screw.
    return _tube(major, minor, phi) * [1, -hand]


def _tube(major: float, minor: float, phi: FloatArray) -> FloatArray:
    """Points of the tube's cross-section at conformal angles (k,), counted from the outside; shape (k, 2)."""
    r2 = minor / major
    stretch = major * (1 - r2**2) / (1 - r2 * np.cos(phi))
    return np.stack([stretch, stretch * r2 * np.sin(phi) / math.sqrt(1 - r2**2)], axis=1)


def _gap(p: int, major: float, minor: float) -> float:
    """Least distance of two of the p strands within a half plane, over all half planes."""
    if p == 1:
        return minor  # one strand never meets itself there; this only sets the number of vertices
    phases = np.linspace(0.0, 2 * math.pi / p, 64)[:, None] + 2 * math.pi / p * np.arange(p)
    points = _tube(major, minor, phases.ravel()).reshape(64, p, 2)
    return float(np.linalg.norm(points - np.roll(points, 1, axis=1), axis=2).min())
