"""A term: the sum of the heights of all vertices, as if they had weight."""

from dataclasses import dataclass

import numpy as np

from ..base.types import FloatArray
from ..curve import Curve


@dataclass(frozen=True)
class Height:
    """Σ z."""

    name = "height"
    description = "Σ z, which pulls down"
    scale_exponent = 1.0

    def value(self, curve: Curve) -> float:
        """Of all vertices."""
        return float(curve.vertices[:, 2].sum())

    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        """Its derivative is 1 in the last coordinate."""
        derivative = np.zeros_like(curve.vertices)
        derivative[:, 2] = 1.0
        return self.value(curve), derivative
