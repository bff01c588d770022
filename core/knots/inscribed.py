"""Polygons inscribed in smooth curves, and corners rounded, with a proof that the type stays."""

import math
from collections.abc import Sequence

import numpy as np

from ..base import CurveError, FloatArray, checked, counted
from ..collision import is_free
from ..curve import Curve, Mesh, arc_lengths, nearest_strands, subdivide

MAX_VERTICES = 400_000  # of any knot that is made: twice what any command takes


def inscribed(curve: Curve, vertices: int | None) -> Curve:
    """Inscribe a polygon with equal steps along the components of a smooth link, which is proved to be isotopic.

    The given polygons have enough vertices to represent the smooth curves.  By default edges are shorter than
    strands are apart, and there are at least 120.  Raises CurveError if the curve meets itself, or nearly does,
    or the vertices are too few or too many.
    """
    gap = nearest_strands(curve, 2.0)  # between vertices twice as far apart along the curve, also across a bend
    if vertices is None:
        vertices = max(120, math.ceil(curve.length / (0.5 * gap)) if gap > 0 else MAX_VERTICES + 1)
    sizes = shares(vertices, curve.component_lengths)
    at = [(part, arc_steps(part), n) for part, n in zip(curve.components, sizes, strict=True)]
    coarse, fine = (  # four times as many vertices represent the smooth curve
        Curve.from_components([_along(part, t, np.arange(k * n) / (k * n)) for part, t, n in at]) for k in (1, 4)
    )
    if not is_isotopic(fine, equal_steps(fine), coarse, equal_steps(coarse)):
        raise too_few(vertices)
    return coarse


def check_count(vertices: int) -> None:
    """Raise a CurveError for more vertices than are of any use."""
    if vertices > MAX_VERTICES:
        raise CurveError(f"{vertices} vertices are too many; at most {MAX_VERTICES} are allowed")


def too_few(vertices: int) -> CurveError:
    """The error for a polygon that is not proved to be isotopic to its smooth curve."""
    return CurveError(f"{vertices} vertices are too few to follow the strands of this knot; give more")


def shares(vertices: int, lengths: FloatArray) -> list[int]:
    """Share vertices among components in proportion to length, rounding running sums; CurveError if too few or many."""
    check_count(vertices)
    marks = np.rint(vertices * np.cumsum(lengths) / lengths.sum()).astype(np.intp)
    counts = np.diff(marks, prepend=0)
    if counts.min() < 3:
        raise CurveError(f"{vertices} vertices are too few for {counted(len(lengths), 'component')}; give more")
    return [int(count) for count in counts]


def is_isotopic(first: Curve, first_at: Sequence[FloatArray], second: Curve, second_at: Sequence[FloatArray]) -> bool:
    """Whether the motion of polygons to others, along straight lines at equal parameters, is proved free of contact.

    ``first_at`` and ``second_at`` have the parameters of the vertices of each component, increasing from 0 to below 1.
    """
    ends = []
    for p, t, q, u in zip(first.components, first_at, second.components, second_at, strict=True):
        both = np.union1d(t, u)
        ends.append((_along(p, t, both), _along(q, u, both)))
    start, end = (np.concatenate(parts) for parts in zip(*ends, strict=True))
    return is_free(Mesh(tuple(len(p) for p, _ in ends)), start, end)


def equal_steps(curve: Curve) -> list[FloatArray]:
    """Parameters of vertices that are equally spaced on each component."""
    return [np.arange(n) / n for n in curve.mesh.component_sizes]


def arc_steps(points: FloatArray) -> FloatArray:
    """Parameters of the vertices of a closed polygon that are proportional to arc length; shape (n,)."""
    arc = arc_lengths(np.concatenate([points, points[:1]]))
    return np.asarray(arc[:-1] / arc[-1])


def _along(points: FloatArray, at: FloatArray, t: FloatArray) -> FloatArray:
    """Points of a closed polygon at parameters t; its vertices are at parameters ``at``, the first at 0."""
    closed = np.concatenate([points, points[:1]])
    return np.stack([np.interp(t, np.append(at, 1.0), x) for x in closed.T], axis=1)


@checked
def rounded(curve: Curve, least: int = 320) -> Curve:
    """Round the corners of a polygon by averaging neighbours, as far as its motion there is proved free of contact.

    All edges are split into the same number of pieces, for at least ``least`` vertices in all; ends of arcs stay.
    """
    pieces = math.ceil(least / len(curve))
    split = subdivide(curve, np.full(curve.mesh.edges, pieces))
    passes = max(1, pieces**2 // 2)  # reach about half an edge
    while passes and not is_free(split.mesh, split.vertices, vertices := averaged(split, passes)):
        passes //= 2
    return split.with_vertices(vertices) if passes else split


def averaged(curve: Curve, passes: int) -> FloatArray:
    """The vertices, shape (n, m), after repeatedly averaging each with its neighbours; ends of arcs stay."""
    vertices, mesh = curve.vertices, curve.mesh
    for _ in range(passes):
        means = 0.5 * vertices + 0.25 * (vertices[mesh.anticycle] + vertices[mesh.cycle])
        means[mesh.ends] = vertices[mesh.ends]
        vertices = means
    return vertices
