"""Solid tori around smooth knots, with coordinates in which patterns are drawn."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ..curve import Curve
from ..errors import CurveError
from ..types import FloatArray
from .alexander import linking_numbers
from .inscribed import arc_steps

_COARSE, _FINE = 400, 20_000  # samples that the reach is measured with, and at most of any tube
_SPACING = 0.1  # of the reach, between samples


@dataclass(frozen=True, eq=False)
class Tube:
    """A solid torus around a knot.

    Its points have coordinates t ∈ [0, 1) along the knot and (u, v) in the plane across it. Curves of constant (u, v)
    do not link the knot: they are its longitudes in the sense of Seifert.

    Attributes
    ----------
    length
        Of the knot.
    reach
        Radius of the thickest tube: discs across the knot do not meet within it.
    """

    length: float
    reach: float
    _center: FloatArray
    _across: FloatArray
    _up: FloatArray

    @classmethod
    def around(cls, curve: Curve) -> "Tube":
        """The tube around the spline through the vertices of a knot.

        Raises
        ------
        CurveError
            If the curve is not one closed component in space.
        """
        if curve.dimension != 3 or curve.mesh.closed != (True,):
            raise CurveError("satellites are drawn around a knot, one closed curve in space")
        closed = np.concatenate([curve.vertices, curve.vertices[:1]])
        spline = CubicSpline(np.append(arc_steps(curve.vertices), 1.0), closed, bc_type="periodic")
        reach = _reach(*_samples(spline, _COARSE))
        count = min(max(_COARSE, math.ceil(curve.length / (_SPACING * reach))), _FINE)
        center, tangent = _samples(spline, count)
        across = _transported(tangent)
        turned = Curve.from_components([center, center + 0.3 * reach * across])
        across = _turned(across, tangent, -2.0 * np.pi * linking_numbers(turned)[0] * np.arange(count) / count)
        length = float(np.linalg.norm(np.diff(center, axis=0, append=center[:1]), axis=1).sum())
        return cls(length, reach, center, across, np.cross(tangent, across))

    def points(self, t: FloatArray, u: FloatArray, v: FloatArray) -> FloatArray:
        """Points in space, shape (k, 3), with these coordinates, each (k,); t is taken modulo 1."""
        center, across, up = (self._at(t, x) for x in (self._center, self._across, self._up))
        return np.asarray(center + u[:, None] * across + v[:, None] * up)

    def _at(self, t: FloatArray, values: FloatArray) -> FloatArray:
        place = t % 1.0 * len(values)
        k = np.floor(place).astype(np.intp) % len(values)
        return np.asarray(values[k] + (place % 1.0)[:, None] * (values[(k + 1) % len(values)] - values[k]))


def _samples(spline: CubicSpline, count: int) -> tuple[FloatArray, FloatArray]:
    """Points and unit tangents at equal steps of the parameter, each (count, 3)."""
    t = np.arange(count) / count
    velocity = spline(t, 1)
    return spline(t), velocity / np.linalg.norm(velocity, axis=1)[:, None]


def _reach(points: FloatArray, tangents: FloatArray) -> float:
    """Radius of the smallest circle that is tangent to the curve at a point and passes through another (Federer)."""
    chord = points[:, None] - points[None]
    squared = (chord**2).sum(axis=2)
    height = np.linalg.norm(np.cross(chord, tangents[None]), axis=2)
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.nanmin(squared / (2.0 * height)))


def _transported(tangents: FloatArray) -> FloatArray:
    """Unit normals carried along without turning, then turned at a constant rate so that they close; shape (n, 3)."""
    normals = np.empty_like(tangents)
    normal = np.eye(3)[np.abs(tangents[0]).argmin()]
    for k, tangent in enumerate(np.concatenate([tangents, tangents[:1]])):
        normal = normal - (normal @ tangent) * tangent
        normal /= np.linalg.norm(normal)
        if k < len(tangents):
            normals[k] = normal
    first, tangent = normals[0], tangents[0]
    angle = math.atan2(np.cross(first, normal) @ tangent, first @ normal)
    return _turned(normals, tangents, -angle * np.arange(len(tangents)) / len(tangents))


def _turned(normals: FloatArray, tangents: FloatArray, angles: FloatArray) -> FloatArray:
    return np.asarray(np.cos(angles)[:, None] * normals + np.sin(angles)[:, None] * np.cross(tangents, normals))
