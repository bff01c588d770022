"""Similarity between the user's units and the program's own, in which the curve is about 2π long."""

from dataclasses import dataclass

import numpy as np

from .curve import Curve
from .types import FloatArray


@dataclass(frozen=True, eq=False)
class Units:
    """x_user = offset + scale · x, with ``scale`` a power of two so that only the shift rounds."""

    offset: FloatArray
    scale: float

    @classmethod
    def of(cls, curve: Curve) -> "Units":
        """Units that centre the curve and make its mean component 4 to 8 long."""
        offset = 0.5 * (curve.vertices.min(axis=0) + curve.vertices.max(axis=0))
        exponent = np.frexp(curve.length / len(curve.mesh.component_sizes))[1] - 3
        return cls(offset, float(np.ldexp(1.0, exponent)))

    def from_user(self, vertices: FloatArray) -> FloatArray:
        """Vertices in the program's units; shape (n, m)."""
        return np.asarray((vertices - self.offset) / self.scale)

    def to_user(self, vertices: FloatArray) -> FloatArray:
        """Vertices in the user's units, rounded to the doubles that are proved and written; shape (n, m)."""
        return np.asarray(self.offset + self.scale * vertices)
