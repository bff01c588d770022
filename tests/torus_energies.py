"""Least energies of torus knots, from their symmetry alone."""

import numpy as np
from scipy.integrate import quad
from scipy.optimize import minimize_scalar


def torus_knot_minimum(p: int, q: int) -> float:
    """The least Möbius energy of T(p, q) among orbits (a e^{ipt}, b e^{iqt}), a² + b² = 1, of the three-sphere.

    The energy is the same in the sphere and, stereographically projected, in space, and orbits of a group of isometries
    are critical where they are critical among themselves (Kim and Kusner, *Torus knots extremizing the Möbius energy*,
    1993).  All points of an orbit being alike, one integral does.
    """
    return torus_knot_energy(p, q, np.sqrt(1.0 - torus_knot_tube(p, q) ** 2))


def torus_knot_tube(p: int, q: int) -> float:
    """The radius b of the tube about the unit circle on which that orbit lies in space."""
    options = {"xatol": 1e-9}
    found = minimize_scalar(lambda a: torus_knot_energy(p, q, a), bounds=(0.1, 0.99), method="bounded", options=options)
    return float(np.sqrt(1.0 - found.x**2))


def torus_knot_energy(p: int, q: int, a: float) -> float:
    """The Möbius energy of one of these orbits."""
    b = np.sqrt(1.0 - a * a)
    speed = np.hypot(p * a, q * b)

    def point(t: float) -> np.ndarray:
        return np.array([a * np.cos(p * t), a * np.sin(p * t), b * np.cos(q * t), b * np.sin(q * t)])

    def tangent(t: float) -> np.ndarray:
        x, y, z, w = point(t)
        return np.array([-p * y, p * x, -q * w, q * z]) / speed

    def density(t: float) -> float:
        chord, here, there = point(t) - point(0.0), tangent(0.0), tangent(t)
        r2 = chord @ chord
        return float((1.0 + here @ there - 2.0 * (chord @ here) * (chord @ there) / r2) / r2)

    return 4.0 + 2 * np.pi * speed**2 * 2 * quad(density, 1e-3, np.pi, limit=400)[0]
