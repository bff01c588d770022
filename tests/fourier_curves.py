"""Smooth curves by their Fourier coefficients: rows cₖ of t ↦ Re Σₖ cₖ e^{2πikt}."""

import numpy as np

CIRCLE = np.array([[0, 0, 0], [1, -1j, 0]])
DUAL_CIRCLE = np.array([[np.sqrt(2.0), 0, 0], [1, 0, -1j]])  # of the unit circle, as Hopf fibres that are orthogonal
ELLIPSE = np.array([[0, 0, 0], [2, -1j, 0]])
DOUBLE_POINT = np.array([[0, 0, 0], [1, 0, 0], [0, -1j, 0]])
CUSPS = np.array([[0, 0, 0], [3, -3j, 0], [0, 0, 0], [1, 1j, 0]]) / 4  # the astroid


def fitted(points: np.ndarray, modes: int) -> np.ndarray:
    """Coefficients of a curve by its points at equal steps, shape (n, 3), leaving higher modes out."""
    c = 2.0 * np.fft.fft(points, axis=0)[: modes + 1] / len(points)
    c[0] /= 2.0
    return c


def values(c: np.ndarray, t: np.ndarray, order: int = 0) -> np.ndarray:
    """A derivative of a curve at complex parameters, shape (len(t), 3)."""
    k = np.arange(len(c))
    up, down = (
        np.exp(sign * np.multiply.outer(t, k)) * (sign * k) ** order for sign in (2j * np.pi * np.array([1, -1]))
    )
    return (up @ c + down @ c.conj()) / 2


def torus_knot(p: int, q: int, a: float, n: int) -> np.ndarray:
    """The orbit (a e^{ipt}, b e^{iqt}), a² + b² = 1, of the three-sphere, stereographically projected; n points."""
    t, b = 2 * np.pi * np.arange(n) / n, np.sqrt(1 - a * a)
    points = np.stack([a * np.cos(p * t), a * np.sin(p * t), b * np.cos(q * t), b * np.sin(q * t)], axis=1)
    return points[:, :3] / (1.0 - points[:, 3:])
