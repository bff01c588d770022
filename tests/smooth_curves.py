"""Smooth closed curves with known Möbius energies, and links of round circles."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from mobius_flow.core import Curve
from numpy import cos, sin


class SmoothCurve(NamedTuple):
    """A curve of period 2π and its Möbius energy, on which two independent quadratures agree to 1e-10."""

    point: Callable[[np.ndarray], tuple[np.ndarray, ...]]
    energy: float

    def polygon(self, n: int) -> Curve:
        return Curve(np.stack(self.point(2 * np.pi * np.arange(n) / n), axis=1))


SMOOTH_CURVES = {
    "ellipse": SmoothCurve(lambda t: (2 * cos(t), sin(t)), 6.641899143),
    "wave": SmoothCurve(lambda t: (cos(t), sin(t), 0.3 * sin(3 * t)), 10.488274624),
    "trefoil": SmoothCurve(
        lambda t: ((2 + cos(3 * t)) * cos(2 * t), (2 + cos(3 * t)) * sin(2 * t), sin(3 * t)), 81.840852989
    ),
    "trefoil-2": SmoothCurve(lambda t: (sin(t) + 2 * sin(2 * t), cos(t) - 2 * cos(2 * t), -sin(3 * t)), 75.933810973),
    "figure-eight": SmoothCurve(
        lambda t: ((2 + cos(2 * t)) * cos(3 * t), (2 + cos(2 * t)) * sin(3 * t), sin(4 * t)), 199.325961590
    ),
}


def dual_circles(n: int) -> Curve:
    """The Hopf link of two fibres of the Hopf map that are orthogonal in the 3-sphere, by stereographic projection."""
    t = 2 * np.pi * np.arange(n) / n
    zero = np.zeros(n)
    rotation, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(4, 4)))

    def project(points: np.ndarray) -> np.ndarray:
        turned = points @ rotation
        return turned[:, :3] / (1 - turned[:, 3:])

    first = project(np.stack([cos(t), sin(t), zero, zero], axis=1))
    return Curve.from_components([first, project(np.stack([zero, zero, cos(t), sin(t)], axis=1))])


def random_polygon(seed: int, sizes: tuple[int, ...], dimension: int) -> Curve:
    """Closed polygons with normally distributed vertices: nothing is smooth, short, or alike."""
    rng = np.random.default_rng(seed)
    return Curve.from_components([rng.normal(size=(n, dimension)) for n in sizes])
