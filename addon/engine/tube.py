"""How thick tubes may be drawn, evenly or where there is room, without contact; for pictures, proves nothing.

Where the radius is local the curve's corners are rounded as far as that goes. Such a curve is not quite the one that
was proved. So the motions between the rounded keys, and the way to the first of them, are proved too, and where that
fails the keys stay as they were.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
from scipy.sparse import diags_array
from scipy.sparse.linalg import spsolve

from ...core import Curve, Obstacle
from ...core.collision.embedded import clears
from ...core.curve import Mesh
from ...core.curve.distances import nearest_strands, strand_gaps
from ...core.types import FloatArray
from .interpolation import interpolated
from .motion import Keys, Proof

_THICKEST = 0.016  # of a component's length: a round circle's tube is then a tenth of its radius
_DISTINCT = 3.0  # two points lie on different strands if they are this many times further apart along the curve
AIR = 0.94  # of half the gap, so that strands do not seem to touch
_FINE = 8.0  # edges this many times shorter than a distance measure it well enough
_FEWEST = 16  # vertices of a component that is thinned
_POINTS = 350  # into which a film's curve is split at least: long edges have nothing to round
_ROUND = 0.8  # of the free radius: the length over which corners are rounded
_SLOPE = 0.08  # of the radius, at most, along the curve
_THINNEST = 4e-3  # of a curve's size: a thinner tube is not seen in a film, nor is which strand is in front
_CROWDED, _EVEN = 0.2, 2.2  # a tube is at most so many times as thick as where the most crowded fifth of it ends
_GROWTH = 0.04  # of the thickest radius, per frame


def thickest_radius(curve: Curve) -> float:
    """The radius that looks right where there is enough room."""
    return _THICKEST * curve.length / len(curve.mesh.component_sizes)


def free_radius(curve: Curve, thickest: float) -> float:
    """Half the gap between strands of a curve, at most ``thickest``."""
    return min(thickest, 0.5 * AIR * strand_gap(curve, 2 * thickest / AIR))


def radius_beside(curve: Curve, radius: float, obstacles: Sequence[Obstacle]) -> float:
    """A radius, or the largest that obstacles leave room for, to 2 %; at least a thousandth of it."""

    def fits(thick: float) -> bool:
        return clears(_thinned(curve, thick), obstacles, thick / AIR)

    if not obstacles or fits(radius):
        return radius
    low, high = 1e-3 * radius, radius
    while high > 1.02 * low:
        middle = float(np.sqrt(low * high))
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


def strand_gap(curve: Curve, widest: float) -> float:
    """Least distance between strands of a curve, inf if it is more than ``widest``, to 1 %.

    Where edges are much shorter than that, some vertices give the same answer as all, which make too many pairs;
    where these find strands that are near, more of them are used to look for nearer ones.
    """
    while True:
        some = _thinned(curve, widest)
        spacing = float(some.edge_lengths.max())
        nearest = nearest_strands(some, _DISTINCT, widest + spacing)
        if some is curve or nearest >= 0.5 * widest:
            return float(between_edges(nearest, spacing))
        widest = nearest


def between_edges(ends: FloatArray | float, lengths: FloatArray | float) -> FloatArray:
    """How near edges are whose ends are so far apart; no nearer, where the ends of the nearest two lie side by side."""
    return np.asarray(np.sqrt(np.maximum(np.square(ends) - 0.25 * np.square(lengths), 0.25 * np.square(ends))))


def _thinned(curve: Curve, distance: float) -> Curve:
    """A curve with only as many vertices as such a distance needs, a few at least in each component, or itself."""
    stride = int(distance / (_FINE * curve.edge_lengths.max()))
    if stride <= 1:
        return curve
    steps = [max(1, min(stride, len(each) // _FEWEST)) for each in curve.components]
    pieces = [np.concatenate([p[:-1:k], p[-1:]]) for p, k in zip(curve.components, steps, strict=True)]
    return Curve.from_components(pieces, curve.mesh.closed)


def rounded(mesh: Mesh, keys: Keys, free: Proof) -> tuple[Mesh, Keys]:
    """The same motion with more vertices and round corners; ``free`` proves straight motions as in `Motion.keys`."""
    mesh, exact = _split(mesh, [key.points.astype(np.float64) for key in keys.keys])
    thickest = _thickest(mesh, exact)
    round_ = [_rounded(Curve(points, mesh), thickest).astype(np.float32) for points in exact]
    shown = [points.astype(np.float32) for points in exact]
    corners, last = set[int](), len(shown) - 1

    @cache
    def proved(k: int, before: bool, after: bool) -> bool:
        ends = (round_ if before else shown)[k], (round_ if after else shown)[min(k + 1, last)]
        return free(mesh, *(points.astype(np.float64) for points in ends))

    def failures() -> list[int]:
        return [k for k in range(last) if not proved(k, k not in corners, k + 1 not in corners)]

    if not free(mesh, exact[0], round_[0].astype(np.float64)):
        corners.add(0)
    while (failed := failures()) and not corners.issuperset(ends := {j for k in failed for j in (k, k + 1)}):
        corners |= ends
    made = (shown[k] if k in corners else round_[k] for k in range(last + 1))
    unproved = max(keys.unproved, len(failed))
    return mesh, Keys(tuple(replace(key, points=p) for key, p in zip(keys.keys, made, strict=True)), unproved)


def tube_radii(mesh: Mesh, points: Sequence[FloatArray], frames: FloatArray) -> FloatArray:
    """Radii of the tube at all vertices of keyed curves, (keys, n).

    Tubes are as thick as looks right, or else as there is room, unless too thin to see then; they change gently along
    the curve and from frame to frame. Where many strands are close they are not much thicker elsewhere, which would
    hide them.
    """
    thickest = _thickest(mesh, points)
    radii = np.array([_free_radii(Curve(p, mesh), thickest) for p in points])
    np.minimum(radii, _EVEN * np.quantile(radii, _CROWDED, axis=1, keepdims=True), out=radii)
    for order in (slice(None), slice(None, None, -1)):
        view, steps = radii[order], np.abs(np.diff(frames[order])) * _GROWTH * thickest
        for k, step in enumerate(steps):
            np.minimum(view[k + 1], view[k] + step, out=view[k + 1])
    return np.maximum(radii, [[_THINNEST * np.ptp(p, axis=0).max()] for p in points])


def _thickest(mesh: Mesh, points: Sequence[FloatArray]) -> float:
    """The radius that looks right at all keys; it does not change in a film where there is room for it."""
    return min(thickest_radius(Curve(p, mesh)) for p in points)


def _split(mesh: Mesh, keys: Sequence[FloatArray]) -> tuple[Mesh, list[FloatArray]]:
    """Split edges at all keys so that none is long at any of them."""
    lengths = np.max([Curve(points, mesh).edge_lengths for points in keys], axis=0)
    parts = np.ceil(lengths / lengths.sum() * _POINTS).astype(np.intp)
    sizes, found = list[int](), [list[FloatArray]() for _ in keys]
    for piece, edges, closed in zip(mesh.slices, mesh.edge_slices, mesh.closed, strict=True):
        counts = parts[edges]
        places = np.concatenate([k + np.arange(count) / count for k, count in enumerate(counts)])
        places = places if closed else np.append(places, len(counts))
        sizes.append(len(places))
        for made, points in zip(found, keys, strict=True):
            own = points[piece]
            made.append(interpolated(np.concatenate([own, own[:1]]) if closed else own, places))
    return Mesh(tuple(sizes), mesh.closed), [np.concatenate(each) for each in found]


def _rounded(curve: Curve, thickest: float) -> FloatArray:
    """Diffuse the vertices along the curve, p′ − (σ² p′_s)_s = p, over lengths σ in proportion to the free radii.

    No vertex moves further than about σ, which is less than half the way to the nearest other strand.
    """
    mesh, lengths = curve.mesh, curve.edge_lengths
    sigma = _ROUND * _free_radii(curve, thickest)
    weights = 0.5 * np.bincount(np.concatenate([mesh.tails, mesh.heads]), np.tile(lengths, 2), len(curve))
    between = 0.25 * (sigma[mesh.tails] + sigma[mesh.heads]) ** 2 / lengths
    matrix = diags_array(weights) + mesh.difference.T @ diags_array(between) @ mesh.difference
    return np.asarray(spsolve(matrix.tocsc(), weights[:, None] * curve.vertices))


def _free_radii(curve: Curve, thickest: float) -> FloatArray:
    """Half the gap to other strands at every vertex, at most ``thickest``, changing gently along the curve."""
    spacing = np.maximum(curve.edge_lengths[curve.mesh.outgoing], curve.edge_lengths[curve.mesh.incoming])
    gaps = strand_gaps(curve, 2 * thickest / AIR + float(spacing.max()))
    radii: FloatArray = np.minimum(thickest, 0.5 * AIR * between_edges(gaps, spacing))
    for piece, edges, closed in zip(curve.mesh.slices, curve.mesh.edge_slices, curve.mesh.closed, strict=True):
        both_ways = (_rising(radii[piece], curve.edge_lengths[edges], closed, way) for way in (1, -1))
        radii[piece] = np.minimum(*both_ways)
    return radii


def _rising(radii: FloatArray, lengths: FloatArray, closed: bool, way: int) -> FloatArray:
    """Radii of one component that rise no faster than they may on the way forward, or backward."""
    rounds = 2 if closed else 1  # the first round brings what is before the start
    values = np.tile(radii, rounds)[::way]
    steps = np.tile(lengths, rounds)[: len(values) - 1][::way]
    rise = _SLOPE * np.concatenate([[0.0], np.cumsum(steps)])
    return np.asarray((np.minimum.accumulate(values - rise) + rise)[-len(radii) :][::way])
