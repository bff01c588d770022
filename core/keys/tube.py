"""How thick tubes may be drawn, evenly or where there is room, without contact; for pictures, proves nothing.

Where the radius is local the curve's corners are rounded as far as that goes. Such a curve is not quite the one that
was proved. So the motions between the rounded keys, and the way to the first of them, are proved too, and where that
fails the keys stay as they were. A curve that is a rope all along is drawn as that rope.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
from scipy.sparse import diags_array
from scipy.sparse.linalg import spsolve

from ..base import FloatArray, dot
from ..collision.embedded import clears
from ..curve import Curve, Mesh, Obstacle, interpolated, nearest_strands
from ..curve.distances import strand_gaps
from .placement import Frame, framed
from .recording import Keys, Proof

AIR = 0.94  # of half the gap, so that strands do not seem to touch
_LEAST = 4e-3  # radius over the size: of a thinner tube it is not seen in a film which strand is in front


def thickest_radius(curve: Curve) -> float:
    """The radius that looks right where there is enough room."""
    # a round circle's tube is then a tenth of its radius
    return 0.016 * curve.length / len(curve.mesh.component_sizes)


def free_radius(curve: Curve, thickest: float) -> float:
    """Half the gap between strands of a curve, at most ``thickest``; less where it bends too much for such a tube."""
    radius = min(thickest, 0.5 * AIR * strand_gap(curve, 2 * thickest / AIR))
    return float(_bendable(curve, np.full(len(curve), radius)).min())


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
        nearest = nearest_strands(some, 3.0, widest + spacing)  # on different strands: 3 times further along the curve
        if some is curve or nearest >= 0.5 * widest:
            return float(between_edges(nearest, spacing))
        widest = nearest


def between_edges(ends: FloatArray | float, lengths: FloatArray | float) -> FloatArray:
    """How near edges are whose ends are so far apart; no nearer, where the ends of the nearest two lie side by side."""
    return np.asarray(np.sqrt(np.maximum(np.square(ends) - 0.25 * np.square(lengths), 0.25 * np.square(ends))))


def _thinned(curve: Curve, distance: float) -> Curve:
    """A curve with only as many vertices as such a distance needs, a few at least in each component, or itself."""
    stride = int(distance / (8.0 * curve.edge_lengths.max()))  # edges that much shorter measure it well enough
    if stride <= 1:
        return curve
    steps = [max(1, min(stride, len(each) // 16)) for each in curve.components]
    pieces = [np.concatenate([p[:-1:k], p[-1:]]) for p, k in zip(curve.components, steps, strict=True)]
    return Curve.from_components(pieces, curve.mesh.closed)


def rounded(mesh: Mesh, keys: Keys, free: Proof) -> tuple[Mesh, Keys]:
    """The same motion with more vertices and round corners; ``free`` proves straight motions as in `Recording.keys`."""
    # split edges into at least 350 in all, none of them long at any key: long ones have nothing to round
    stored = [key.points.astype(np.float64) for key in keys.keys]
    lengths = np.max([Curve(points, mesh).edge_lengths for points in stored], axis=0)
    parts = np.ceil(lengths / lengths.sum() * 350).astype(np.intp)
    sizes, found = list[int](), [list[FloatArray]() for _ in stored]
    for piece, edges, closed in zip(mesh.slices, mesh.edge_slices, mesh.closed, strict=True):
        counts = parts[edges]
        places = np.concatenate([k + np.arange(count) / count for k, count in enumerate(counts)])
        places = places if closed else np.append(places, len(counts))
        sizes.append(len(places))
        for made, points in zip(found, stored, strict=True):
            own = points[piece]
            made.append(interpolated(np.concatenate([own, own[:1]]) if closed else own, places))
    mesh, exact = Mesh(tuple(sizes), mesh.closed), [np.concatenate(each) for each in found]
    # diffuse vertices along the curve, p′ − (σ² p′_s)_s = p, over lengths σ in proportion to the free radii: none moves
    # further than about σ, which is less than half the way to the nearest other strand
    curves, round_ = [Curve(points, mesh) for points in exact], list[Frame]()
    thickest = min(map(thickest_radius, curves))
    for curve in curves:
        lengths, sigma = curve.edge_lengths, 0.8 * _free_radii(curve, thickest)
        weights = 0.5 * np.bincount(np.concatenate([mesh.tails, mesh.heads]), np.tile(lengths, 2), len(curve))
        between = 0.25 * (sigma[mesh.tails] + sigma[mesh.heads]) ** 2 / lengths
        matrix = diags_array(weights) + mesh.difference.T @ diags_array(between) @ mesh.difference
        round_.append(spsolve(matrix.tocsc(), weights[:, None] * curve.vertices).astype(np.float32))
    # a corner stays where the way to it or from it would not be proved
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
    rounded_keys = (replace(key, points=(shown if k in corners else round_)[k]) for k, key in enumerate(keys.keys))
    return mesh, Keys(tuple(rounded_keys), max(keys.unproved, len(failed)))


def tube_radii(mesh: Mesh, points: Sequence[FloatArray], frames: FloatArray) -> FloatArray:
    """Radii of the tube at all vertices of keyed curves, (keys, n).

    Tubes are as thick as looks right, or else as there is room, unless too thin to see then; they change gently along
    the curve and from frame to frame. Where many strands are close they are not much thicker elsewhere, which would
    hide them.
    """
    curves = [Curve(p, mesh) for p in points]
    thickest = min(map(thickest_radius, curves))  # which does not change in a film where there is room for it
    radii = np.array([_gentle(curve, _bendable(curve, _free_radii(curve, thickest))) for curve in curves])
    # at most so many times as thick as where the most crowded fifth of the tube ends
    np.minimum(radii, 2.2 * np.quantile(radii, 0.2, axis=1, keepdims=True), out=radii)
    return np.maximum(eased(radii, frames), [[_LEAST * np.ptp(p, axis=0).max()] for p in points])


def rope_radii(mesh: Mesh, keys: Keys) -> FloatArray | None:
    """Radii of the tube that is the rope itself, at all vertices, (keys, n), as shown; None if none is, or is seen."""
    radii = np.array([key.radius for key in keys.keys])
    seen = [framed(Curve(key.points.astype(np.float64), mesh)) for key in keys.keys]
    sizes = np.array([key.size.factor * np.ptp(each, axis=0).max() for key, each in zip(keys.keys, seen, strict=True)])
    return None if (radii < _LEAST * sizes).any() else np.repeat(radii[:, None], mesh.size, axis=1)


def eased(radii: FloatArray, frames: FloatArray, moves: Sequence[bool] = ()) -> FloatArray:
    """Radii of tubes at keys, (keys, ...), made smaller where they would change too fast from frame to frame.

    ``moves``: whether a strand moves on the way to each key; there they may change as they must.
    """
    radii, steps = radii.copy(), np.diff(frames)
    steps[np.asarray(moves, dtype=bool)[1:].nonzero()] = np.inf
    for order in (slice(None), slice(None, None, -1)):
        view = radii[order]
        for k, step in enumerate(steps[order]):
            view[k + 1] = np.minimum(view[k + 1], view[k] * (1.0 + 0.15 * step))
    return radii


def _bendable(curve: Curve, radii: FloatArray) -> FloatArray:
    """Radii at all vertices, (n,), made smaller where the curve turns so much that a tube would be a lump.

    Within one radius to either side of a vertex it turns by ``bent`` radians at most, or ``thinned`` of the radius is
    left. A corner counts for half of that at most: no tube is thin enough for it.
    """
    found, mesh, bent, thinned = radii.copy(), curve.mesh, 1.1, 0.5
    along = curve.edge_vectors / curve.edge_lengths[:, None]
    cosines = dot(along[mesh.incoming], along[mesh.outgoing])
    turns = np.minimum(np.arccos(np.clip(cosines, -1.0, 1.0)), 0.5 * bent)
    for piece, edges, closed in zip(mesh.slices, mesh.edge_slices, mesh.closed, strict=True):
        n, rounds = piece.stop - piece.start, 3 if closed else 1  # the middle one has neighbours on both sides
        places = np.concatenate([[0.0], np.cumsum(np.tile(curve.edge_lengths[edges], rounds))])[: n * rounds]
        halfway = 0.5 * (places + np.append(places[1:], places[-1]))  # where edges have turned as much as they will
        turned, middle = np.cumsum(np.tile(turns[piece], rounds)), places[n * (rounds // 2) :][:n]
        fits, part = thinned * radii[piece], radii[piece]
        for step in 0.5 ** np.arange(1.0, 9.0)[:, None] * part:
            straight = np.diff(np.interp([middle - part, middle + part], halfway, turned), axis=0)[0] <= bent
            fits = np.where(straight, np.maximum(fits, part), fits)
            part = part + np.where(straight, step, -step)
        found[piece] = np.minimum(fits, radii[piece])
    return found


def _free_radii(curve: Curve, thickest: float) -> FloatArray:
    """Half the gap to other strands at every vertex, at most ``thickest``, changing gently along the curve."""
    spacing = np.maximum(curve.edge_lengths[curve.mesh.outgoing], curve.edge_lengths[curve.mesh.incoming])
    gaps = strand_gaps(curve, 2 * thickest / AIR + float(spacing.max()))
    return _gentle(curve, np.minimum(thickest, 0.5 * AIR * between_edges(gaps, spacing)))


def _gentle(curve: Curve, radii: FloatArray) -> FloatArray:
    """Radii at all vertices, (n,), made smaller where they would change too fast along the curve."""
    radii = radii.copy()
    for piece, edges, closed in zip(curve.mesh.slices, curve.mesh.edge_slices, curve.mesh.closed, strict=True):
        rounds = 2 if closed else 1  # the first round brings what is before the start
        own, steps = np.tile(radii[piece], rounds), np.tile(curve.edge_lengths[edges], rounds)
        for way in (1, -1):
            values, ahead = own[::way], steps[: len(own) - 1][::way]
            rise = 0.08 * np.concatenate([[0.0], np.cumsum(ahead)])  # of the radius, along the curve, at most
            risen = (np.minimum.accumulate(values - rise) + rise)[piece.start - piece.stop :][::way]
            radii[piece] = np.minimum(radii[piece], risen)
    return radii
