"""Diagrams of closed polygons: crossings of a projection, PD codes, linking numbers, Jones polynomials.

For tests only, and on purpose independent of the code under test.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Points = npt.NDArray[np.float64]
Crossing = tuple[int, int, int, int]  # edges counterclockwise from the incoming lower one, as in KnotTheory


@dataclass(frozen=True)
class Diagram:
    """A link diagram.

    ``passes[k]`` lists the crossings along component k as (crossing, whether it is the upper strand);
    ``signs`` are the crossings' signs.
    """

    passes: tuple[tuple[tuple[int, bool], ...], ...]
    signs: dict[int, int]

    def without_loops(self) -> "Diagram":
        """Undo Reidemeister's first move wherever a strand crosses itself twice in a row."""
        passes = [list(p) for p in self.passes]
        signs = dict(self.signs)
        for part in passes:
            i = 0
            while len(part) > 1 and i < len(part):
                if part[i][0] == part[i - 1][0]:
                    del signs[part[i][0]], part[i]
                    del part[i - 1]
                    i = 0
                else:
                    i += 1
        return Diagram(tuple(map(tuple, passes)), signs)

    def pd_code(self) -> list[Crossing]:
        """Planar diagram code, edges numbered from 1 along the components."""
        ends: dict[tuple[int, bool], tuple[int, int]] = {}
        label = 1
        for part in self.passes:
            for i, crossing in enumerate(part):
                ends[crossing] = (label + i, label + (i + 1) % len(part))
            label += len(part)
        code = []
        for c, sign in self.signs.items():
            (under_in, under_out), (over_in, over_out) = ends[c, False], ends[c, True]
            right, left = (over_out, over_in) if sign > 0 else (over_in, over_out)
            code.append((under_in, right, under_out, left))
        return code


def diagram(components: Sequence[npt.ArrayLike], projections: int = 12, seed: int = 1) -> Diagram:
    """Give the diagram with fewest crossings of several projections, loops removed."""
    polygons = [np.asarray(c, dtype=np.float64) for c in components]
    frames = _frames(np.concatenate(polygons), projections, seed)
    found = [d.without_loops() for d in (_project(polygons, frame) for frame in frames) if d is not None]
    return min(found, key=lambda d: len(d.signs))


def linking_number(a: npt.ArrayLike, b: npt.ArrayLike) -> int:
    """Linking number of two disjoint closed polygons, arrays (n, 3), with their orientations."""
    found = diagram([a, b], projections=3)
    on_first = defaultdict(int)
    for crossing, _ in found.passes[0]:
        on_first[crossing] += 1
    twice = sum(sign for crossing, sign in found.signs.items() if on_first[crossing] == 1)
    assert twice % 2 == 0
    return twice // 2


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
    signs: dict[int, int] = {}
    for i, j, s, t in _meetings(tails, heads):
        if min(s, t, 1 - s, 1 - t) < 1e-9:
            return None
        e, f = heads[i] - tails[i], heads[j] - tails[j]
        first_over = bool(tails[i, 2] + s * e[2] > tails[j, 2] + t * f[2])
        sign = 1 if (e[0] * f[1] - e[1] * f[0] > 0) == first_over else -1
        number = len(signs)
        signs[number] = sign
        events += [(i, s, number, first_over), (j, t, number, not first_over)]
    events.sort()
    ends = np.cumsum([len(p) for p in polygons])
    parts = [
        [(c, over) for edge, _, c, over in events if np.searchsorted(ends, edge, "right") == k]
        for k in range(len(ends))
    ]
    return Diagram(tuple(map(tuple, parts)), signs)


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


Laurent = dict[int, int]


def jones(found: Diagram) -> Laurent:
    """Jones polynomial as {twice the exponent of t: coefficient}; t + t³ − t⁴ for the right-handed trefoil.

    From the bracket, contracted crossing by crossing (Kauffman, Topology 26, 1987); for small diagrams.
    """
    states: dict[frozenset[tuple[int, int]], Laurent] = {frozenset(): {0: 1}}
    rest = found.pd_code()
    done: set[int] = set()
    while rest:
        rest.sort(key=lambda x: len(done & set(x)))
        crossing = rest.pop()
        done |= set(crossing)
        states = _smoothed(states, crossing)
    bracket = states[frozenset()]
    free_loops = sum(not part for part in found.passes)
    for _ in range(free_loops):
        bracket = _times_loop(bracket)
    writhe = sum(found.signs.values())
    # The bracket counts d for every loop, so one d too many.
    normalized = _divide_by_loop({k - 3 * writhe: (-1) ** (writhe % 2) * c for k, c in bracket.items()})
    assert all(k % 2 == 0 for k in normalized)
    return {-k // 2: c for k, c in sorted(normalized.items(), reverse=True) if c}


def _smoothed(
    states: dict[frozenset[tuple[int, int]], Laurent], crossing: Crossing
) -> dict[frozenset[tuple[int, int]], Laurent]:
    a, b, c, d = crossing
    new: dict[frozenset[tuple[int, int]], Laurent] = {}
    for power, pairs in ((1, ((a, b), (c, d))), (-1, ((a, d), (b, c)))):
        for state, polynomial in states.items():
            joined, loops = _join(state, pairs)
            shifted = {k + power: x for k, x in polynomial.items()}
            for _ in range(loops):
                shifted = _times_loop(shifted)
            total = new.setdefault(joined, {})
            for k, x in shifted.items():
                total[k] = total.get(k, 0) + x
    return new


def _join(state: Iterable[tuple[int, int]], pairs: Sequence[tuple[int, int]]) -> tuple[frozenset[tuple[int, int]], int]:
    """Add arcs to open arcs between labels; labels met twice are glued. Give the open arcs left and closed loops."""
    arcs, loops = list(state), 0
    for arc in pairs:
        start, end = arc
        for other in list(arcs):
            if other in arcs and start != end and {start, end} & set(other):
                arcs.remove(other)
                start, end = _glue((start, end), other)
        if start == end:
            loops += 1
        else:
            arcs.append((min(start, end), max(start, end)))
    return frozenset(arcs), loops


def _glue(arc: tuple[int, int], other: tuple[int, int]) -> tuple[int, int]:
    if set(arc) == set(other):
        return arc[0], arc[0]
    shared = (set(arc) & set(other)).pop()
    (x,), (y,) = set(arc) - {shared}, set(other) - {shared}
    return x, y


def _times_loop(polynomial: Laurent) -> Laurent:
    product: Laurent = defaultdict(int)
    for k, c in polynomial.items():
        product[k + 2] -= c
        product[k - 2] -= c
    return dict(product)


def _divide_by_loop(polynomial: Laurent) -> Laurent:
    """Exact quotient by −A² − A⁻²."""
    rest, quotient = {k: c for k, c in polynomial.items() if c}, {}
    while rest:
        k = max(rest)
        quotient[k - 2] = -rest[k]
        for shift in (2, -2):
            rest[k - 2 + shift] = rest.get(k - 2 + shift, 0) + quotient[k - 2]
        rest = {k: c for k, c in rest.items() if c}
    return quotient
