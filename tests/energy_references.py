"""Slow, independent references for energies: pair by pair, from the definitions."""

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from itertools import pairwise

import mpmath as mp
import numpy as np
from mobius_flow.core import Curve
from sympy.integrals.quadrature import gauss_legendre

mp.mp.dps = 30


def disjoint_pairs(curve: Curve) -> Iterator[tuple[int, int]]:
    """Ordered pairs of edges with disjoint closures, found by comparing their vertices."""
    ends = list(zip(curve.mesh.tails.tolist(), curve.mesh.heads.tolist(), strict=True))
    for i, first in enumerate(ends):
        for j, second in enumerate(ends):
            if not set(first) & set(second):
                yield i, j


def pair_sum(curve: Curve, density: Callable[..., float], points: list[float], weights: list[float]) -> float:
    """Σ ℓ_I ℓ_J Σ ω_i ω_j F(x, y, τ_x, τ_y, ϱ), eq. (40) of [RS21], in a loop."""
    p, tails, heads = curve.vertices, curve.mesh.tails, curve.mesh.heads
    e = p[heads] - p[tails]
    ell = np.linalg.norm(e, axis=1)
    total = 0.0
    for i, j in disjoint_pairs(curve):
        for t, omega_t in zip(points, weights, strict=True):
            for u, omega_u in zip(points, weights, strict=True):
                x, y = p[tails[i]] + t * e[i], p[tails[j]] + u * e[j]
                rho = arc_distance(curve, ell, i, t, j, u)
                value = density(x, y, e[i] / ell[i], e[j] / ell[j], rho)
                total += omega_t * omega_u * ell[i] * ell[j] * value
    return total


def arc_distance(curve: Curve, ell: np.ndarray, i: int, t: float, j: int, u: float) -> float:
    """Length of the shorter way from one point to the other, walking edge by edge; inf if there is none."""
    if curve.mesh.edge_component[i] != curve.mesh.edge_component[j]:
        return float("inf")
    lengths = []
    for a, s, b, v in ((i, t, j, u), (j, u, i, t)):
        after = {int(tail): edge for edge, tail in enumerate(curve.mesh.tails)}
        walked, edge = (1 - s) * ell[a], after.get(int(curve.mesh.heads[a]))
        while edge not in (b, None):
            walked, edge = walked + ell[edge], after.get(int(curve.mesh.heads[edge]))
        lengths.append(float("inf") if edge is None else walked + v * ell[b])
    return float(min(lengths))


def arc_density(x: np.ndarray, y: np.ndarray, tau_x: np.ndarray, tau_y: np.ndarray, rho: float) -> float:
    """1/r² − 1/ϱ²."""
    return float(1 / np.sum((x - y) ** 2) - 1 / rho**2)


def circle_density(x: np.ndarray, y: np.ndarray, tau_x: np.ndarray, tau_y: np.ndarray, rho: float) -> float:
    """(1 − cos α)/r²: the circle through x that touches the tangent at y arrives at x at the angle α."""
    d = (x - y) / np.linalg.norm(x - y)
    arriving = 2 * np.dot(d, tau_y) * d - tau_y  # the tangent at y, reflected in the chord's perpendicular plane
    return float((1 - np.dot(arriving, tau_x)) / np.sum((x - y) ** 2))


def tangent_point_density(alpha: float, beta: float) -> Callable[..., float]:
    """|τ_x ∧ d|^α/r^β; its sum over ordered pairs has both tangents."""

    def density(x: np.ndarray, y: np.ndarray, tau_x: np.ndarray, tau_y: np.ndarray, rho: float) -> float:
        d = x - y
        return float(np.linalg.norm(d - np.dot(d, tau_x) * tau_x) ** alpha / np.linalg.norm(d) ** beta)

    return density


def inverse_square_integral(*points: Sequence[float | mp.mpf]) -> mp.mpf:
    """∬ ds dt/|x(s) − y(t)|² over parameters in [0, 1] of the edges x₀x₁ and y₀y₁, to about 15 digits.

    The inner integral is a difference of arctangents; the outer one is cut at the feet of the second edge's end
    points and at the lines' closest approach, geometrically refined towards each.
    """
    x0, x1, y0, y1 = ([mp.mpf(c) for c in p] for p in points)
    e, f, between = minus(x1, x0), minus(y1, y0), minus(x0, y0)
    ee, ff, ef = mp.fdot(e, e), mp.fdot(f, f), mp.fdot(e, f)
    width = mp.sqrt(ff)

    def inner(s: mp.mpf) -> mp.mpf:
        z = [b + s * c for b, c in zip(between, e, strict=True)]
        foot = mp.fdot(z, f) / width
        h2 = mp.fdot(z, z) - foot**2
        if h2 < mp.mpf(10) ** -36:
            return (1 / (foot - width) - 1 / foot) / width
        h = mp.sqrt(h2)
        return (mp.atan(foot / h) - mp.atan((foot - width) / h)) / (h * width)

    centres = [mp.fdot(minus(y, x0), e) / ee for y in (y0, y1)]
    determinant = ee * ff - ef**2
    if determinant > mp.mpf(10) ** -30 * ee * ff:
        centres.append((ef * mp.fdot(f, between) - ff * mp.fdot(e, between)) / determinant)
    breaks = {mp.mpf(0), mp.mpf(1)}
    for centre in centres:
        middle = min(max(centre, mp.mpf(0)), mp.mpf(1))
        cuts = [middle + sign * mp.mpf(8) ** -k for k in range(14) for sign in (-1, 1)]
        breaks |= {middle, *(cut for cut in cuts if 0 < cut < 1)}
    ordered = sorted(breaks)
    return mp.fsum(_panel(inner, a, b) for a, b in pairwise(ordered))


def _panel(f: Callable[[mp.mpf], mp.mpf], a: mp.mpf, b: mp.mpf) -> mp.mpf:
    return (b - a) / 2 * mp.fsum(w * f((a + b) / 2 + (b - a) / 2 * x) for x, w in _legendre())


@cache
def _legendre() -> list[tuple[mp.mpf, mp.mpf]]:
    """28 Gauss points and weights on [−1, 1]."""
    points, weights = gauss_legendre(28, mp.mp.dps)
    return [(mp.mpf(str(x)), mp.mpf(str(w))) for x, w in zip(points, weights, strict=True)]


def minus(a: list[mp.mpf], b: list[mp.mpf]) -> list[mp.mpf]:
    return [p - q for p, q in zip(a, b, strict=True)]
