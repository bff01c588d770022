"""Closed curves in space as Fourier series."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ..base.types import ComplexArray, FloatArray
from .curve import Curve


@dataclass(frozen=True, eq=False)
class FourierCurve:
    """A smooth knot or link.

    For each component there are coefficients c, shape (modes + 1, 3): it is t ↦ Re Σₖ cₖ e^{2πikt}, 0 ≤ t < 1.
    """

    coefficients: tuple[ComplexArray, ...]

    @classmethod
    def of(cls, curve: Curve, at: Sequence[FloatArray], modes: Sequence[int]) -> "FourierCurve":
        """The first modes of the components' splines, which pass closed polygons' vertices at parameters ``at``."""
        parts = []
        for points, places, most in zip(curve.components, at, modes, strict=True):
            count = 16 * max(most, len(points) // 2)
            parts.append(_spectrum(periodic(places, points)(np.arange(count) / count), most))
        return cls(tuple(parts))

    @property
    def modes(self) -> list[int]:
        """The highest frequency of each component."""
        return [len(c) - 1 for c in self.coefficients]

    @property
    def as_lists(self) -> list[list[list[list[float]]]]:
        """The real and imaginary parts of the coefficients, in brackets by component, frequency and coordinate."""
        return [np.stack([c.real, c.imag], axis=-1).tolist() for c in self.coefficients]

    @classmethod
    def of_lists(cls, lists: Sequence[Sequence[Sequence[Sequence[float]]]]) -> "FourierCurve":
        """The curve that `as_lists` describes."""
        return cls(tuple(np.array(part) @ [1.0, 1j] for part in lists))

    @property
    def sizes(self) -> list[int]:
        """Numbers of vertices, for each component, that represent it as a polygon."""
        return [max(64, 10 * modes) for modes in self.modes]

    def polygon(self, sizes: Sequence[int]) -> Curve:
        """Inscribe a polygon with so many vertices on each component, at equal steps of t."""
        parts = []
        for c, n in zip(self.coefficients, sizes, strict=True):
            waves = np.exp(2j * np.pi * np.outer(np.arange(n) / n, np.arange(len(c))))
            parts.append((waves @ c).real)
        return Curve.from_components(parts)

    def with_modes(self, modes: Sequence[int]) -> "FourierCurve":
        """The same with higher frequencies, whose coefficients are 0, or without the highest ones."""
        sizes = zip(self.coefficients, modes, strict=True)
        return FourierCurve(tuple(np.pad(c[: k + 1], ((0, max(k + 1 - len(c), 0)), (0, 0))) for c, k in sizes))

    @classmethod
    def through(cls, curve: Curve, modes: Sequence[int]) -> "FourierCurve":
        """The first modes of components that pass through the vertices of closed polygons at equal steps of t."""
        return cls(tuple(map(_spectrum, curve.components, modes)))

    @property
    def mirrored(self) -> "FourierCurve":
        """Its mirror image in the plane of the first two coordinates."""
        return FourierCurve(tuple(c * [1.0, 1.0, -1.0] for c in self.coefficients))


def _spectrum(samples: FloatArray, modes: int) -> ComplexArray:
    spectrum = np.fft.rfft(samples, axis=0)[: modes + 1] * (2.0 / len(samples))
    spectrum[0] /= 2.0
    return np.asarray(spectrum)


def periodic(at: FloatArray, values: FloatArray) -> CubicSpline:
    """The spline of period 1 with values at parameters that increase from 0 to below 1."""
    return CubicSpline(np.append(at, 1.0), np.concatenate([values, values[:1]]), bc_type="periodic")
