"""Closed curves in space as Fourier series: fitted to polygons, stored, and with more or fewer modes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ...core.base.types import ComplexArray, FloatArray
from ...core.curve import Curve
from ...core.knots.shapes import SmoothShape


@dataclass(frozen=True, eq=False)
class FourierCurve(SmoothShape):
    """A smooth knot or link, from and to other forms."""

    @classmethod
    def of(cls, curve: Curve, at: Sequence[FloatArray], modes: Sequence[int]) -> "FourierCurve":
        """The first modes of the components' splines, which pass closed polygons' vertices at parameters ``at``."""
        parts = []
        for points, places, most in zip(curve.components, at, modes, strict=True):
            closed = np.concatenate([points, points[:1]])
            spline = CubicSpline(np.append(places, 1.0), closed, bc_type="periodic")
            count = 16 * max(most, len(points) // 2)
            parts.append(_spectrum(spline(np.arange(count) / count), most))
        return cls(tuple(parts))

    @property
    def as_lists(self) -> list[list[list[list[float]]]]:
        """The real and imaginary parts of the coefficients, in brackets by component, frequency and coordinate."""
        return [np.stack([c.real, c.imag], axis=-1).tolist() for c in self.coefficients]

    @classmethod
    def of_lists(cls, lists: Sequence[Sequence[Sequence[Sequence[float]]]]) -> "FourierCurve":
        """The curve that `as_lists` describes."""
        return cls(tuple(np.array(part) @ [1.0, 1j] for part in lists))

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
