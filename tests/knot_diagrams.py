"""Diagrams of closed polygons, read off a projection and simplified by Spherogram.

For tests only, and on purpose independent of the code under test.
"""

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from spherogram import Link

Points = npt.NDArray[np.float64]
Crossing = tuple[int, int, int, int]  # edges counterclockwise from the incoming lower one, as in KnotTheory

_FEW = 30  # crossings that invariants are quickly found of
_DETOURS, _DETOUR = 100, 60  # ways out of diagrams that every move makes worse, and the number of moves of each


@dataclass(frozen=True)
class Diagram:
    """A link diagram.

    ``passes[k]`` lists the crossings along component k as (crossing, whether it is the upper strand);
    ``signs`` are the crossings' signs.
    """

    passes: tuple[tuple[tuple[int, bool], ...], ...]
    signs: tuple[int, ...]

    def pd_code(self) -> list[Crossing]:
        """Planar diagram code, edges numbered from 1 along the components."""
        ends: dict[tuple[int, bool], tuple[int, int]] = {}
        label = 1
        for part in self.passes:
            for i, crossing in enumerate(part):
                ends[crossing] = (label + i, label + (i + 1) % len(part))
            label += len(part)
        code = []
        for c, sign in enumerate(self.signs):
            (under_in, under_out), (over_in, over_out) = ends[c, False], ends[c, True]
            right, left = (over_out, over_in) if sign > 0 else (over_in, over_out)
            code.append((under_in, right, under_out, left))
        return code

    def link(self) -> Link:
        """The same for Spherogram, which takes components without a crossing as a number only."""
        link = Link(self.pd_code())
        link.unlinked_unknot_components += sum(not part for part in self.passes)
        return link


def diagram(components: Sequence[npt.ArrayLike], projections: int = 3, seed: int = 1) -> Diagram:
    """Give the diagram with the fewest crossings of several projections of closed polygons, each (n, 3)."""
    polygons = [np.asarray(c, dtype=np.float64) for c in components]
    frames = _frames(np.concatenate(polygons), projections, seed)
    found = [d for d in (_project(polygons, frame) for frame in frames) if d is not None]
    return min(found, key=lambda d: len(d.signs))


def simplified(components: Sequence[npt.ArrayLike]) -> Link:
    """Give a diagram with few crossings; Reidemeister's moves and pass moves keep the type.

    Components that come apart and are unknots are left as ``unlinked_unknot_components``.
    """
    link = diagram(components).link()
    before = random.getstate()
    random.seed(1)  # Spherogram draws its moves from Python's generator
    try:
        link.simplify("global")
        for _ in range(_DETOURS if len(components) == 1 else 0):  # detours need not keep a link's orientations
            if len(link.crossings) > _FEW:
                link.backtrack(_DETOUR)
                link.simplify("global")
    finally:
        random.setstate(before)
    return link


def linking_number(a: npt.ArrayLike, b: npt.ArrayLike) -> int:
    """Linking number of two disjoint closed polygons, arrays (n, 3), with their orientations."""
    return int(diagram([a, b]).link().linking_number())


def pairwise_linking(components: Sequence[npt.ArrayLike]) -> dict[tuple[int, int], int]:
    """Linking numbers of all pairs of components of a link."""
    pairs = [(i, j) for j in range(len(components)) for i in range(j)]
    return {(i, j): linking_number(components[i], components[j]) for i, j in pairs}


def _frames(points: Points, count: int, seed: int) -> Iterator[Points]:
    """Projections: the flattest view, slightly turned to be generic, then random ones."""
    rng = np.random.default_rng(seed)
    principal = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)[2]
    yield _rotation(principal + 0.02 * rng.normal(size=(3, 3)))
    for _ in range(count - 1):
        yield _rotation(rng.normal(size=(3, 3)))


def _rotation(matrix: Points) -> Points:
    q, r = np.linalg.qr(matrix.T)
    q = (q * np.sign(np.diag(r))).T
    return q if np.linalg.det(q) > 0 else np.diag([1.0, 1.0, -1.0]) @ q


def _project(polygons: Sequence[Points], frame: Points) -> Diagram | None:
    """Diagram of one projection, or None if it is not generic."""
    turned = [p @ frame.T for p in polygons]
    tails = np.concatenate(turned)
    heads = np.concatenate([np.roll(p, -1, axis=0) for p in turned])
    events: list[tuple[int, float, int, bool]] = []
    signs: list[int] = []
    for i, j, s, t in _meetings(tails, heads):
        if min(s, t, 1 - s, 1 - t) < 1e-9:
            return None
        e, f = heads[i] - tails[i], heads[j] - tails[j]
        first_over = bool(tails[i, 2] + s * e[2] > tails[j, 2] + t * f[2])
        sign = 1 if (e[0] * f[1] - e[1] * f[0] > 0) == first_over else -1
        events += [(i, s, len(signs), first_over), (j, t, len(signs), not first_over)]
        signs.append(sign)
    events.sort()
    ends = np.cumsum([len(p) for p in polygons])
    parts = [
        [(c, over) for edge, _, c, over in events if np.searchsorted(ends, edge, "right") == k]
        for k in range(len(ends))
    ]
    return Diagram(tuple(map(tuple, parts)), tuple(signs))


def _meetings(tails: Points, heads: Points) -> Iterator[tuple[int, int, float, float]]:
    """Pairs of edges i < j that meet in the plane and share no vertex, with the parameters of the meeting point."""
    d = heads - tails
    slack = 1e-9
    for i in range(len(tails) - 1):
        later = slice(i + 1, None)
        rx, ry = (tails[later, :2] - tails[i, :2]).T
        ex, ey = d[later, :2].T
        turn = d[i, 0] * ey - d[i, 1] * ex
        # Parallel edges, such as pieces of one straight line, meet in no generic view.
        parallel = np.abs(turn) <= 1e-12 * np.hypot(ex, ey) * np.hypot(d[i, 0], d[i, 1])
        turn = np.where(parallel, 1.0, turn)
        s, t = (rx * ey - ry * ex) / turn, (rx * d[i, 1] - ry * d[i, 0]) / turn
        hit = ~parallel & (s > -slack) & (s < 1 + slack) & (t > -slack) & (t < 1 + slack)
        for k in np.flatnonzero(hit):
            j = i + 1 + int(k)
            if not ((heads[i] == tails[j]).all() or (heads[j] == tails[i]).all()):
                yield i, j, float(s[k]), float(t[k])
