"""The plane that a drawing lies in."""

from dataclasses import dataclass

import numpy as np

from ...core import Curve, CurveError
from ...core.messages import Message
from ...core.types import FloatArray

_FLAT = 0.05  # of a drawing's size: how far its points may lie from a plane
_LEVEL = 0.999  # cosine of the tilt below which the plane counts as level


@dataclass(frozen=True, eq=False)
class DrawingPlane:
    """A plane with coordinates, seen from its upper side.

    Attributes
    ----------
    origin
        Shape (3,).
    axes
        Two unit vectors in the plane and its upward normal, as rows; shape (3, 3).
    """

    origin: FloatArray
    axes: FloatArray

    @classmethod
    def of(cls, curve: Curve) -> "DrawingPlane":
        """The plane nearest to a curve; coordinates are x and y where it is nearly level.

        Raises
        ------
        CurveError
            If the curve is not flat.
        """
        origin = curve.vertices.mean(axis=0)
        points = curve.vertices - origin
        _, _, axes = np.linalg.svd(points, full_matrices=True)
        normal = axes[2] * (1.0 if axes[2][np.abs(axes[2]).argmax()] > 0 else -1.0)
        size = float(np.ptp(points @ axes[:2].T, axis=0).max())
        if float(np.abs(points @ normal).max()) > _FLAT * size:
            raise CurveError(Message("The drawing is not flat; draw it in a plane, or scale it flat along its normal"))
        if normal[2] > _LEVEL:
            return cls(np.array([0.0, 0.0, origin[2]]), np.eye(3))
        across = np.cross([0.0, 0.0, 1.0], normal)
        across /= np.linalg.norm(across)
        return cls(origin, np.stack([across, np.cross(normal, across), normal]))

    def flattened(self, curve: Curve) -> Curve:
        """The curve in the plane's coordinates."""
        return curve.with_vertices((curve.vertices - self.origin) @ self.axes[:2].T)

    def raised(self, points: FloatArray) -> FloatArray:
        """Points in space from coordinates and heights; shape (n, 3)."""
        return np.asarray(self.origin + points @ self.axes)
