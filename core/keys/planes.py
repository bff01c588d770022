"""How curves are turned, and the planes that drawings lie in."""

from dataclasses import dataclass
from itertools import product

import numpy as np

from ..base import CurveError, FloatArray, Message
from ..curve import Curve


@dataclass(frozen=True, eq=False)
class Turn:
    """The rotation x ↦ center + rotation · (x − center)."""

    rotation: FloatArray
    center: FloatArray

    @classmethod
    def onto(cls, curve: Curve, wanted: FloatArray) -> "Turn":
        """Turn a curve's principal axes, the longest first, into wanted ones, orthonormal rows, by the least angle.

        Which way an axis points is left open. Raises CurveError if all points are the same.
        """
        if not curve.length:
            raise CurveError("All points of the curves are the same; move them apart")
        away = curve.midpoints - curve.barycenter
        # those of the curve's inertia
        axes = np.linalg.eigh((curve.edge_lengths[:, None] * away).T @ away)[1][:, ::-1].T
        signs = (np.array(each)[:, None] for each in product((1.0, -1.0), repeat=3))
        turned = [(sign * wanted).T @ axes for sign in signs]
        return cls(max([each for each in turned if np.linalg.det(each) > 0.0], key=np.trace), curve.barycenter)

    @property
    def matrix(self) -> FloatArray:
        """The same in homogeneous coordinates; shape (4, 4)."""
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = self.rotation, self.center - self.rotation @ self.center
        return matrix


def orthonormal(axes: FloatArray) -> FloatArray:
    """Three independent rows made orthonormal: the last keeps its direction, the first its plane with the last."""
    back = axes[2] / np.linalg.norm(axes[2])
    right = axes[0] - (axes[0] @ back) * back
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(back, right), back])


@dataclass(frozen=True, eq=False)
class DrawingPlane:
    """A plane with coordinates, seen from its upper side."""

    origin: FloatArray  # shape (3,)
    axes: FloatArray  # two unit vectors in the plane and its upward normal, as rows; shape (3, 3)

    @classmethod
    def of(cls, curve: Curve) -> "DrawingPlane":
        """The plane nearest to a curve; coordinates are x and y where it is nearly level.

        Raises CurveError if the curve is not flat.
        """
        origin = curve.vertices.mean(axis=0)
        points = curve.vertices - origin
        _, _, axes = np.linalg.svd(points, full_matrices=True)
        normal = axes[2] * (1.0 if axes[2][np.abs(axes[2]).argmax()] > 0 else -1.0)
        size = float(np.ptp(points @ axes[:2].T, axis=0).max())
        if float(np.abs(points @ normal).max()) > 0.05 * size:
            raise CurveError(Message("The drawing is not flat; draw it in a plane, or scale it flat along its normal"))
        if normal[2] > 0.999:  # cosine of the tilt
            return cls(np.array([0.0, 0.0, origin[2]]), np.eye(3))
        across = np.cross([0.0, 0.0, 1.0], normal)
        across /= np.linalg.norm(across)
        return cls(origin, np.stack([across, np.cross(normal, across), normal]))

    def flattened(self, curve: Curve) -> Curve:
        return curve.with_vertices((curve.vertices - self.origin) @ self.axes[:2].T)

    def raised(self, points: FloatArray) -> FloatArray:
        """Points in space from coordinates and heights; shape (n, 3)."""
        return np.asarray(self.origin + points @ self.axes)
