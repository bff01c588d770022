"""A strand move in space: lifted above all else, or lowered below it, the strand is rerouted through wide gates.

The rest of the drawing is cut into triangles.  A way goes from one to the next through their edges, the gates.  Pieces
of the curve, the walls, are only crossed as planned: it is a shortest path through layers, one more than crossings.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from ..diagrams.rerouting import Move
from ..types import FloatArray, IntArray
from .drawing import Drawing
from .moving import MovingCurve
from .triangles import Triangles

_RAMPS = 0.2, 0.4, 0.6, 0.8  # of a piece: where a strand ends, has landed, takes off, and begins
_ASIDE = 0.2  # of a gate's width, and
_NEAR = 0.3  # of the way there: how far from a wall the vertices on both sides of it are
_CLEAR = 0.15  # of a gate's width that ways keep clear of its ends

_OPEN = -1  # instead of a dart: no wall

Wall = tuple[int, int]
_ABOVE = 0.1  # of the curve's size: how far the lowest vertex of the strand is above the highest of the rest,
_RISE = 0.05  # and by how much the strand's end is above its start


@dataclass(frozen=True)
class Ends:
    """Where a strand leaves the rest of the curve and comes back to it, as tails plus fractions.

    Between ``foot`` and ``start`` it rises, on one straight piece, and between ``end`` and ``landing`` it comes down.
    ``first`` and ``last`` are the numbers of these pieces, on the edges of the diagram before and after the strand.
    """

    foot: float
    start: float
    end: float
    landing: float
    first: int
    last: int

    @classmethod
    def of(cls, drawing: Drawing, move: Move) -> "Ends":
        """The ends on the longest pieces before and after the strand's passes."""
        last, (end, landing, _, _) = _longest(drawing, move.strand.inner[-1])
        first, (_, _, foot, start) = _longest(drawing, move.strand.first)
        return cls(foot, start, end, landing, first, last)


def _longest(drawing: Drawing, edge: int) -> tuple[int, list[float]]:
    """The longest piece of an edge, and places on it."""
    names, stops = drawing.stops(edge)
    lengths = np.linalg.norm(np.diff(drawing.nodes[names], axis=0), axis=1)
    k = int(lengths.argmax())
    return k, [drawing.wrapped(edge, stops[k] + f * (stops[k + 1] - stops[k])) for f in _RAMPS]


def routed(drawing: Drawing, move: Move, ends: Ends) -> FloatArray | None:
    """The corners of a way from the strand's start to its end, both included, shape (k, 2); None if there is none."""
    count = len(drawing.nodes)
    walls = _walls(drawing, move, ends, (count, count + 1))
    nodes = np.concatenate([drawing.nodes, drawing.placed(np.array([ends.start, ends.end]))])
    used, names = np.unique(np.array(list(walls)), return_inverse=True)
    edge_of = dict(zip(map(tuple, names.reshape(-1, 2).tolist()), walls.values(), strict=True))
    plane = _Plane(Triangles(nodes[used], edge_of), edge_of)
    terminals = tuple(np.searchsorted(used, [count, count + 1]).tolist())
    gates = plane.gates_to(move, terminals)
    return None if gates is None else plane.straightened(gates, terminals)


def _walls(drawing: Drawing, move: Move, ends: Ends, names: tuple[int, int]) -> dict[Wall, int]:
    """The pieces of all that stays, from node to node, and the edges of the diagram that they belong to."""
    strand, last = move.strand, move.strand.inner[-1]
    walls: dict[Wall, int] = {}
    start, end = names
    for edge, chain in drawing.chains():
        if edge == strand.first == last:
            chain = [end, start]
        elif edge == strand.first:
            chain = [*chain[: ends.first + 1], start]
        elif edge == last:
            chain = [end, *chain[ends.last + 1 :]]
        elif edge in strand.inner:
            continue
        walls |= dict.fromkeys(pairwise(chain), edge)
    return walls


class _Plane:
    """Triangles, the gates between them, and which of these are walls."""

    def __init__(self, triangles: Triangles, edge_of: Mapping[Wall, int]) -> None:
        self.points, self.corners = points, corners = triangles.points, triangles.corners
        sides = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
        triangle = np.tile(np.arange(len(corners)), 3)
        left = dict(zip(map(tuple, sides.tolist()), triangle.tolist(), strict=True))
        # directed edges of triangles, each crossed from its left to its right
        pairs = [(a, b) for a, b in left if (b, a) in left]
        self.gates = np.array(pairs)
        self.leave = np.array([left[a, b] for a, b in pairs])
        self.enter = np.array([left[b, a] for a, b in pairs])
        self.width = np.linalg.norm(points[self.gates[:, 0]] - points[self.gates[:, 1]], axis=1)
        walls = {(a, b): 2 * edge for (a, b), edge in edge_of.items()}
        walls |= {(b, a): 2 * edge + 1 for (a, b), edge in edge_of.items()}
        self.dart = np.array([walls.get(pair, _OPEN) for pair in pairs])  # that is crossed from its left

    def gates_to(self, move: Move, terminals: tuple[int, int]) -> list[int] | None:
        """The gates on the best way from one point to another that crosses walls as a move says."""
        many = len(self.corners)
        cost = np.sqrt(np.ptp(self.points, axis=0).max() / self.width)
        is_open = np.flatnonzero(self.dart == _OPEN)
        rows, columns, gates = [], [], []
        for layer in range(len(move.route) + 1):
            rows.append(self.leave[is_open] + many * layer)
            columns.append(self.enter[is_open] + many * layer)
            gates.append(is_open)
        for layer, dart in enumerate(move.route):
            through = np.flatnonzero(self.dart == dart)
            rows.append(self.leave[through] + many * layer)
            columns.append(self.enter[through] + many * (layer + 1))
            gates.append(through)
        i, j, gate = map(np.concatenate, (rows, columns, gates))
        layers = many * (len(move.route) + 1)
        graph = coo_array((cost[gate], (i, j)), shape=(layers, layers)).tocsr()
        begin, goal = (np.flatnonzero((self.corners == point).any(axis=1)) for point in terminals)
        goal = goal + many * len(move.route)
        distance, before, _ = dijkstra(graph, indices=begin, return_predecessors=True, min_only=True)
        here = int(goal[np.argmin(distance[goal])])
        if not np.isfinite(distance[here]):
            return None
        by_ends = dict(zip(zip(i.tolist(), j.tolist(), strict=True), gate.tolist(), strict=True))
        way = []
        while before[here] >= 0:
            way.append(by_ends[int(before[here]), here])
            here = int(before[here])
        return way[::-1]

    def straightened(self, way: list[int], terminals: tuple[int, int]) -> FloatArray:
        """A way through gates, by their middles where it has to turn, and with vertices on both sides of walls only."""
        right, left = self.points[self.gates[way]].transpose(1, 0, 2)
        middle = 0.5 * (left + right)
        start, end = self.points[list(terminals)]
        stops, passed = [start], [0]  # the corners that the way may have, and how many gates come before each
        around = np.concatenate([[start], middle, [end]])
        for k, gate in enumerate(way):
            if self.dart[gate] == _OPEN:
                stops.append(middle[k])
                passed.append(k)
                continue
            for toward, count in ((around[k], k), (around[k + 2], k + 1)):
                away = toward - middle[k]
                reach = min(_NEAR, _ASIDE * self.width[gate] / float(np.linalg.norm(away)))
                stops.append(middle[k] + reach * away)
                passed.append(count)
        stops.append(end)
        passed.append(len(way))
        inset = _CLEAR * (left - right)
        right, left = right + inset, left - inset

        def straight(a: int, b: int) -> bool:
            """Whether the segment from one stop to another goes through all gates between them, clear of their ends."""
            between = slice(passed[a], passed[b])
            p, d = stops[a], stops[b] - stops[a]
            u, v = right[between] - p, left[between] - p
            return bool(((d[0] * v[:, 1] - d[1] * v[:, 0] >= 0) & (d[0] * u[:, 1] - d[1] * u[:, 0] <= 0)).all())

        corners, here = [0], 0
        while here < len(stops) - 1:
            here = next(k for k in range(len(stops) - 1, here, -1) if k == here + 1 or straight(here, k))
            corners.append(here)
        return np.array(stops)[corners]


def passed(body: MovingCurve, drawing: Drawing, move: Move) -> bool:
    """Make a move if that is proved free; return whether it was.  If not, the curve may be left halfway."""
    ends = Ends.of(drawing, move)
    way = routed(drawing, move, ends)
    strand = None if way is None else _prepared(body, drawing, ends, len(way))
    if way is None or strand is None:
        return False
    mark = body.mark()
    for top in _tops(body, move.strand.over):
        if _lifted(body, strand, top, move.strand.over) and _led(body, strand, way):
            return True
        body.rewind(mark)
    return False


def _tops(body: MovingCurve, over: bool) -> list[float]:
    """Heights that a strand has to clear, upside down for strands that pass under: the curve's, then obstacles' too."""
    up = 1.0 if over else -1.0
    tops = [float((up * body.seen[:, 2]).max())]
    walls = [float((up * (wall.vertices @ body.frame[:, 2])).max()) for wall in body.obstacles]
    return tops + [top for top in [max(walls, default=-np.inf)] if top > tops[0]]


def _prepared(body: MovingCurve, drawing: Drawing, ends: Ends, count: int) -> IntArray | None:
    """Insert the strand's ends, and enough vertices for its new way; return all of its vertices, in order."""
    mesh = drawing.mesh
    part = mesh.slices[mesh.component[int(ends.start)]]
    size = part.stop - part.start
    begin, stop = ends.start, ends.end + size * (ends.end < ends.start)
    inner = np.arange(np.floor(begin) + 1, np.ceil(stop))
    stops = np.array([begin, *inner, stop])
    corners = part.start + (np.floor(stops).astype(np.intp) - part.start) % size
    wrapped = corners + stops - np.floor(stops)
    lengths = np.linalg.norm(np.diff(drawing.placed(wrapped), axis=0), axis=1)
    extra = _between(stops, lengths, count - len(stops))
    extra = extra - size * (extra >= part.stop)
    places = np.sort([ends.foot, ends.start, ends.end, ends.landing, *extra])
    foot = int(ends.foot) + 1 + int(np.searchsorted(places, ends.foot))
    if len(np.unique(places)) < len(places) or not body.insert(places, first=foot):
        return None
    first = body.mesh.offsets[body.mesh.component[foot]] if mesh.closed[mesh.component[part.start]] else foot
    return first + 1 + np.arange(len(stops) + len(extra))


def _between(stops: FloatArray, lengths: FloatArray, count: int) -> FloatArray:
    """``count`` more stops, where the longest pieces are."""
    parts = np.ones(len(lengths))
    for _ in range(count):
        parts[np.argmax(lengths / parts)] += 1
    more = [a + (b - a) * np.arange(1, n) / n for a, b, n in zip(stops[:-1], stops[1:], parts, strict=True)]
    return np.concatenate(more)


def _lifted(body: MovingCurve, strand: IntArray, top: float, over: bool) -> bool:
    """Raise a strand above all else, or lower it below, farther and farther along it."""
    up = 1.0 if over else -1.0
    targets = body.seen[strand]
    targets[:, 2] = up * (top + body.size * (_ABOVE + _RISE * np.linspace(0.0, 1.0, len(strand))))
    return body.move(strand, targets)


def _led(body: MovingCurve, strand: IntArray, way: FloatArray) -> bool:
    """Lead a strand in the plane to another way, in as few free motions as possible."""
    old = body.seen[strand]
    lengths = np.linalg.norm(np.diff(way, axis=0), axis=1)
    extra = _between(np.arange(len(way), dtype=float), lengths, len(old) - len(way))
    at = np.sort(np.concatenate([np.arange(len(way)), extra]))
    new = np.column_stack([np.interp(at, np.arange(len(way)), x) for x in way.T])
    return body.follow(strand, lambda turn: _reeled(old, new, turn), 2 * (len(old) - 2))


def _reeled(old: FloatArray, new: FloatArray, turn: int) -> FloatArray:
    """The strand after ``turn`` vertices between its ends are reeled in and, once all of them are, out again."""
    inner = len(old) - 2
    laid = abs(inner - turn)  # so many vertices after the first are not on the segment to the end
    way = np.array(old)
    way[: laid + 1, :2] = (old if turn < inner else new)[: laid + 1, :2]
    rest = np.linspace(0.0, 1.0, inner + 2 - laid)[:, None]
    way[laid:, :2] = way[laid, :2] + rest * (old[-1, :2] - way[laid, :2])
    return way
