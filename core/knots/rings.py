"""Smooth closed braids around the z axis, and polygons inscribed in them that are checked to be the same braid."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..curve import Curve
from ..errors import CurveError, counted
from ..types import FloatArray, IntArray

_EDGE = 0.7  # default edge length in units of the gap; tilted strands are a little nearer than the gap
_PAGES_PER_EDGE = 8
MAX_VERTICES = 400_000  # of any knot that is made: twice what any command takes


@dataclass(frozen=True)
class Ring:
    """A smooth closed curve that runs ``turns`` times around the z axis.

    Parameters
    ----------
    turns
        How often it goes round; its angle θ runs from 0 to 2π ``turns``.
    at
        Gives distance from the axis and height, shape (k, 2), for angles of shape (k,).
    """

    turns: int
    at: Callable[[FloatArray], FloatArray]

    @property
    def period(self) -> float:
        """The angle after which the curve closes."""
        return 2 * math.pi * self.turns

    def points(self, theta: FloatArray) -> FloatArray:
        """Points in space at angles of shape (k,); shape (k, 3)."""
        rho, z = self.at(theta).T
        return np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1)


@dataclass(frozen=True)
class ClosedBraid:
    """Smooth rings that do not meet.

    Parameters
    ----------
    rings
        One per component.
    gap
        Least distance of two strands within a half plane that ends at the axis.
    detail
        Number of vertices that every polygon gets at least, whatever the gap.
    """

    rings: Sequence[Ring]
    gap: float
    detail: int

    def polygon(self, vertices: int | None) -> Curve:
        """Inscribe a polygon with nearly equal edges.

        Parameters
        ----------
        vertices
            Total number; by default so many that edges are shorter than strands are apart.

        Raises
        ------
        CurveError
            If they are no whole number, too few for the polygon to be the same braid, or too many for any use.
        """
        least = max(self.detail, vertices or 0)
        if least > MAX_VERTICES:
            raise CurveError(f"{least} vertices are too many; at most {MAX_VERTICES} are allowed")
        lengths = np.array([_length(ring, self.detail) for ring in self.rings])
        if vertices is None:
            vertices = min(max(math.ceil(lengths.sum() / (_EDGE * self.gap)), self.detail), MAX_VERTICES)
        counts = shares(vertices, lengths)
        angles = [_equal_edges(ring, count) for ring, count in zip(self.rings, counts, strict=True)]
        if any(_deviation(ring, theta) >= self.gap / 2 for ring, theta in zip(self.rings, angles, strict=True)):
            raise CurveError(f"{vertices} vertices are too few to follow the strands of this knot; give more")
        return Curve.from_components([ring.points(theta) for ring, theta in zip(self.rings, angles, strict=True)])


def _length(ring: Ring, detail: int) -> float:
    points = ring.points(np.linspace(0.0, ring.period, 8 * detail + 1))
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def shares(vertices: int, lengths: FloatArray) -> list[int]:
    """Share vertices among the components in proportion to length, by rounding the running sums."""
    marks: IntArray = np.rint(vertices * np.cumsum(lengths) / lengths.sum()).astype(np.intp)
    counts = np.diff(marks, prepend=0)
    if counts.min() < 3:
        raise CurveError(f"{vertices} vertices are too few for {counted(len(lengths), 'component')}; give more")
    return [int(count) for count in counts]


def _equal_edges(ring: Ring, count: int) -> FloatArray:
    """Angles, from 0 on, at which an inscribed polygon has nearly equal edges; shape (count,)."""
    theta = np.linspace(0.0, ring.period, count + 1)
    for _ in range(20):
        chords = np.linalg.norm(np.diff(ring.points(theta), axis=0), axis=1)
        along = np.concatenate([[0.0], np.cumsum(chords)])
        theta = np.interp(np.linspace(0.0, along[-1], count + 1), along, theta)
    return theta[:-1]


def _deviation(ring: Ring, theta: FloatArray) -> float:
    """Largest distance of polygon and curve within one half plane; infinite if an edge goes backwards or too far.

    Where this stays below half the gap, moving every point straight from the curve to the polygon within its
    half plane lets no two strands meet: polygon and curve are the same closed braid.
    """
    ends = np.append(theta, ring.period)
    steps = np.diff(ends)
    if steps.min() <= 0 or steps.max() > 0.9 * math.pi:
        return math.inf
    fractions = np.arange(1, _PAGES_PER_EDGE) / _PAGES_PER_EDGE
    pages = theta[:, None] + steps[:, None] * fractions
    points = ring.points(ends)
    tails, edges = points[:-1, None], np.diff(points, axis=0)[:, None]
    normal = np.stack([-np.sin(pages), np.cos(pages), np.zeros_like(pages)], axis=2)
    s = -(tails * normal).sum(axis=2) / (edges * normal).sum(axis=2)
    hits = tails + s[:, :, None] * edges
    within = np.stack([np.hypot(hits[:, :, 0], hits[:, :, 1]), hits[:, :, 2]], axis=2)
    smooth = ring.at(pages.ravel()).reshape(within.shape)
    return float(np.linalg.norm(within - smooth, axis=2).max())
