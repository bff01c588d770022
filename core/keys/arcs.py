"""Arcs of drawings, with gaps where they pass under others; and the views of curves that leave most room for them."""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise, product
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..base import CurveError, FloatArray
from ..collision import check_embedded
from ..curve import Curve, arc_lengths
from ..knots import Drawing, rounded
from ..knots.diagrams.projection import NO_VIEW, frames, plane_crossings, project
from ..knots.layout import upright


class Arc(NamedTuple):
    """A part of a drawing between two gaps, or a whole component."""

    component: int
    points: FloatArray
    along: FloatArray  # distance from where the component begins


def seen(curves: Sequence[Curve], trials: int = 200, seed: int = 20231) -> list[Drawing]:
    """Curves as seen from where the fewest strands cross in all of them, and of these where they are best apart.

    Where strands of some would have less than 30 % of the pen's width, these have views of their own, near the others'.
    Corners are rounded first, by motions proved free of contact.  Raises CurveError for curves that are not in space or
    the plane, have more than 20,000 vertices, or touch themselves.
    """
    for curve in curves:
        if curve.dimension > 3 or len(curve) > 20_000:
            told = f"has dimension {curve.dimension}" if curve.dimension > 3 else f"has {len(curve)} vertices"
            raise CurveError(f"the curve {told}; drawings are of curves in space of at most 20000 vertices")
        check_embedded(curve)
    _, power = np.frexp(max(float(np.ptp(each.vertices, axis=0).max()) for each in curves))
    smooth = []
    for curve in curves:
        points = np.ldexp(curve.vertices, -power)  # where products of coordinates neither overflow nor vanish
        smooth.append(rounded(Curve(np.pad(points, ((0, 0), (0, 3 - curve.dimension))), curve.mesh)))
    middles = [each.vertices - each.vertices.mean(axis=0) for each in smooth]
    fewer = max(5, min(trials, 100_000 // sum(map(len, smooth))))
    found: list[tuple[FloatArray, list[Drawing | None]]] = []
    for axes in frames(np.concatenate(middles), fewer + 1, np.random.default_rng(seed)):
        found.append((axes[:, :2], []))
        for curve, middle in zip(smooth, middles, strict=True):
            points, mesh = middle @ axes, curve.mesh
            view = project(mesh, points, plane_crossings(mesh, points, 1e-9), mesh.ends.ravel(), 1e-9)
            if view is None:
                found[-1][1].append(None)
                continue
            passes = (mesh.tails[view.crossings.edges] + view.crossings.at).T
            order = np.argsort(passes[:, 0])
            over = (view.heights[0] > view.heights[1])[order]
            found[-1][1].append(Drawing(Curve(points[:, :2], mesh), passes[order], over))

    def turned(drawing: Drawing | None, turn: FloatArray) -> tuple[Drawing | None, float, float]:
        """A drawing and the widths, as shares of its size, that it leaves to the pen and to a broad one.

        Thinner strands than 2.1 %, the pen's own, are worse than more crossings; broad ones may have room where strands
        cross at angles that leave none to thin ones. Shares are of fixed steps, which rounding must not tell apart.
        """
        if drawing is None:
            return None, 0.0, 0.0
        drawing = replace(drawing, curve=drawing.curve.with_vertices(drawing.curve.vertices @ turn))
        size = float(np.ptp(drawing.curve.vertices, axis=0).max())
        least, room = (round(widest(drawing, share * size, 1.5)[0] / size, 9) for share in (0.021, 1 / 12))
        return drawing, min(least, room), room  # what two rows of widths agree on has room for those in between

    def crossings(drawings: Sequence[Drawing | None]) -> int:
        return sum(10_000 if each is None else len(each.passes) for each in drawings)

    fewest, legible = [], 0.3 * 0.021
    for axes, drawings in sorted(found, key=lambda each: crossings(each[1]))[:20]:
        outline = [each.curve.vertices for each in drawings if each is not None]
        turn = upright(np.concatenate(outline or [axes]))
        every, least, room = zip(*(turned(each, turn) for each in drawings), strict=True)
        good = np.array(least) > (legible if len(curves) > 1 else 0.0)
        merit = good.sum(), np.min(least, where=good, initial=1.0), -crossings(drawings), min(room)
        fewest.append((merit, list(every), good, axes @ turn))
    _, views, good, axes = max(fewest, key=lambda each: each[0])
    sights, done = [axes] * len(curves), np.flatnonzero(good).tolist()
    for k in sorted(np.flatnonzero(~good).tolist(), key=lambda k: min((abs(k - j) for j in done), default=k)):
        next_one = sights[min(done, key=lambda j: abs(j - k), default=k)]
        own = []
        for axes, drawings in sorted(found, key=lambda each: crossings(each[1][k : k + 1]))[:20]:
            (a, b), (c, d) = axes.T @ next_one
            near = float(np.hypot(a + d, b - c))  # 2 if the plane is the same
            turn = np.array([[a + d, b - c], [c - b, a + d]]) / max(near, 1e-9)
            own.append((near, axes @ turn, *turned(drawings[k], turn)[:2]))
        enough = min(legible, 0.7 * max(each[3] for each in own))
        _, sights[k], views[k], _ = max((each for each in own if each[3] >= enough), key=lambda each: each[0])
        done.append(k)
    if None in views:
        raise CurveError(NO_VIEW)
    return [each for each in views if each is not None]


def widest(drawing: Drawing, width: float, gap: float) -> tuple[float, list[Arc]]:
    """The arcs of a drawing, and their width: the given one, or less where they would be too near to each other.

    The width is 0, and there are no arcs, where it would be less than a thousandth of the drawing's size.
    """
    least = 1e-3 * float(np.ptp(drawing.curve.vertices, axis=0).max())
    while (arcs := gaps_cut(drawing, width, gap)) is None:
        width *= 0.85
        if width < least:
            return 0.0, []
    return width, arcs


def gaps_cut(drawing: Drawing, width: float, gap: float) -> list[Arc] | None:
    """The arcs of a drawing, from gap to gap; None if any two would be less than 0.8 gaps apart."""
    mesh, need, reach = drawing.curve.mesh, width * (1.0 + gap), np.linspace(0.0, 1.0, 161) * 8.0 * width * (1.0 + gap)
    lines = [
        np.concatenate([part, part[:1]]) if closed else part
        for part, closed in zip(drawing.curve.components, mesh.closed, strict=True)
    ]
    distances = [arc_lengths(line) for line in lines]

    def points(k: int, at: FloatArray) -> FloatArray:
        at = at % distances[k][-1] if mesh.closed[k] else at
        return np.stack([np.interp(at, distances[k], x) for x in lines[k].T], axis=1)

    def located(at: float) -> tuple[int, float]:
        k = int(mesh.component[int(at)])
        return k, float(np.interp(at - mesh.offsets[k], np.arange(len(distances[k])), distances[k]))

    cuts: list[list[tuple[float, float]]] = [[] for _ in lines]
    uppers: list[list[float]] = [[] for _ in lines]
    for (first, second), first_over in zip(drawing.passes.tolist(), drawing.first_over.tolist(), strict=True):
        (k, below), (upper, above) = map(located, (second, first) if first_over else (first, second))
        uppers[upper].append(above)
        tree = cKDTree(points(upper, above + np.concatenate([-reach[:0:-1], reach])))
        clear = [tree.query(points(k, below + way * reach))[0] >= need for way in (-1.0, 1.0)]
        if not (clear[0].any() and clear[1].any()):
            return None
        cuts[k].append((below - reach[clear[0].argmax()], below + reach[clear[1].argmax()]))
    arcs: list[Arc] = []
    for k, distance in enumerate(distances):
        whole, own = distance, sorted(cuts[k])
        if mesh.closed[k]:
            whole = np.concatenate([distance[:-1], distance + distance[-1]])
            again = [(before + distance[-1], after) for before, after in own[:1]]
            spans = [(a, b) for (_, a), (b, _) in pairwise([*own, *again])] or [(0.0, distance[-1])]
        else:
            marks = [0.0, *(end for cut in own for end in cut), distance[-1]]
            spans = list(zip(marks[::2], marks[1::2], strict=True))
        for (a, b), above in product(own, uppers[k]):  # an upper strand must not be cut away
            if a < above < b or (mesh.closed[k] and (above - a) % distance[-1] < b - a):
                return None
        near = 0.3 * distance[-1] / len(distance)  # vertices nearer than this to an end are left out
        for a, b in spans:
            if b - a < 1.5 * width:  # a dot, rather than a strand
                return None
            along = np.concatenate([[a], whole[(whole > a + near) & (whole < b - near)], [b]])
            arcs.append(Arc(k, points(k, along), along))
    fine = [np.linspace(each.along[0], each.along[-1], 2 + int(2.0 * np.ptp(each.along) / width)) for each in arcs]
    owner = np.repeat(np.arange(len(arcs)), [len(at) for at in fine])
    places = np.concatenate([points(each.component, at) for each, at in zip(arcs, fine, strict=True)])
    least = width * (1.0 + 0.8 * gap)
    i, j = cKDTree(places).query_pairs(least, output_type="ndarray").T
    at = np.concatenate(fine)
    apart = np.abs(at[i] - at[j])
    loops = np.array([distances[each.component][-1] if mesh.closed[each.component] else math.inf for each in arcs])
    apart = np.minimum(apart, loops[owner[i]] - apart)
    return None if ((owner[i] != owner[j]) | (apart > 3.0 * least)).any() else arcs
