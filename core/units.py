"""Similarity between the user's units and the program's own, in which the curve is about 2π long."""

from dataclasses import dataclass

import numpy as np

from .curve import Curve, at_vertices
from .errors import CurveError
from .messages import VERTEX, Message
from .obstacle import MAX_COORDINATE, Obstacle
from .types import FloatArray, frozen

# of obstacles, in the program's units: beyond, their repulsion is lost in the rounding of their corners
MAX_REACH = 1e12


def check_units(curve: Curve) -> None:
    """Raise a CurveError if coordinates are so large, or the curve so small, that powers of lengths fail."""
    sizes = np.abs(curve.vertices).max(axis=1)
    k = int(sizes.argmax())
    if sizes[k] > MAX_COORDINATE:
        place = ", ".join(f"{x:.6g}" for x in curve.vertices[k])
        vertex = Message(VERTEX, number=k + 1)
        far = "{vertex}, ({place}), has a coordinate beyond {largest:g}; use a larger unit of length"
        raise CurveError(Message(far, vertex=vertex, place=place, largest=MAX_COORDINATE), at_vertices(curve, k))
    width = float(np.ptp(curve.vertices, axis=0).max())
    if 0 < width < 1 / MAX_COORDINATE:
        small = "the curve is only {width:.3g} wide, less than {least:g}; use a smaller unit of length"
        raise CurveError(Message(small, width=width, least=1 / MAX_COORDINATE))


def centred(curve: Curve) -> Curve:
    """The same polygon around the origin, since midpoints far away from it lose digits."""
    return curve.with_vertices(curve.vertices - _centre(curve))


def _centre(curve: Curve) -> FloatArray:
    return np.asarray(0.5 * (curve.vertices.min(axis=0) + curve.vertices.max(axis=0)))


@dataclass(frozen=True, eq=False)
class Units:
    """x_user = offset + scale · x, with ``scale`` a power of two so that only the shift rounds."""

    offset: FloatArray
    scale: float

    @classmethod
    def of(cls, curve: Curve) -> "Units":
        """Units that centre the curve and make its mean component 4 to 8 long."""
        exponent = np.frexp(curve.length / len(curve.mesh.component_sizes))[1] - 3
        return cls(_centre(curve), float(np.ldexp(1.0, exponent)))

    def from_user(self, vertices: FloatArray) -> FloatArray:
        """Vertices in the program's units; shape (n, m)."""
        return np.asarray((vertices - self.offset) / self.scale)

    def obstacle_from_user(self, obstacle: Obstacle) -> Obstacle:
        """An obstacle in the program's units; a CurveError if it is too large, or too far away, for the curve."""
        vertices = self.from_user(obstacle.vertices)
        reach = float(np.abs(vertices).max())
        if reach > MAX_REACH:
            far = "{obstacle} reaches some {reach:.0e} times the curve's length; cut off distant parts, or leave it out"
            raise CurveError(Message(far, obstacle=obstacle.title, reach=reach))
        return Obstacle(vertices, obstacle.faces, obstacle.name)

    def to_user(self, vertices: FloatArray) -> FloatArray:
        """Vertices in the user's units, rounded to the doubles that are proved and written, read-only; shape (n, m)."""
        return frozen(np.asarray(self.offset + self.scale * vertices))
