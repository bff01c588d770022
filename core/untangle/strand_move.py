"""A strand move in space: lifted above all else, or lowered below it, the strand is rerouted through wide gates.

The rest of the drawing is cut into triangles.  A way goes from one to the next through their edges, the gates.  Pieces
of the curve, the walls, are only crossed as planned: it is a shortest path through layers, one more than crossings.
"""

from functools import partial
from itertools import pairwise

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from ..base.types import BoolArray, FloatArray
from ..knots.diagrams.rerouting import Move
from .drawing import PlaneDrawing, Triangles
from .moving import MovingCurve


def make_move(body: MovingCurve, drawing: PlaneDrawing, move: Move) -> bool:
    """Make a strand move if that is proved free; return whether it was.  If not, the curve may be left halfway."""
    strand, mesh, cuts = move.strand, drawing.mesh, []
    # where the strand leaves the rest of the curve, and comes back: on the longest pieces before and after its passes
    for edge in (strand.first, strand.inner[-1]):
        names, stops = drawing.stops(edge)
        k = int(np.linalg.norm(np.diff(drawing.nodes[names], axis=0), axis=1).argmax())
        shares = 0.2, 0.4, 0.6, 0.8  # of a piece: where a strand ends, has landed, takes off, and begins
        cuts.append((k, [drawing.wrapped(edge, stops[k] + f * (stops[k + 1] - stops[k])) for f in shares]))
    (first, (_, _, foot, start)), (last, (end, landing, _, _)) = cuts
    way = plan_way(drawing, move, (first, start), (last, end))
    if way is None:
        return False
    # insert these places, and enough vertices for the new way
    part = mesh.slices[mesh.component[int(start)]]
    size = part.stop - part.start
    stop = end + size * (end < start)
    along = np.array([start, *np.arange(np.floor(start) + 1, np.ceil(stop)), stop])
    tails = part.start + (np.floor(along).astype(np.intp) - part.start) % size
    old = drawing.placed(tails + along - np.floor(along))
    extra = _divide_longest(along, old, len(way) - len(along))
    extra = extra - size * (extra >= part.stop)
    places = np.sort([foot, start, end, landing, *extra])
    before = int(foot) + 1 + int(np.searchsorted(places, foot))
    if len(np.unique(places)) < len(places) or not body.insert(places, first=before):
        return False
    if mesh.closed[mesh.component[part.start]]:
        before = body.mesh.offsets[body.mesh.component[before]]
    vertices = before + 1 + np.arange(len(along) + len(extra))
    corners = np.arange(len(way), dtype=float)
    at = np.sort(np.concatenate([corners, _divide_longest(corners, way, len(vertices) - len(way))]))
    new = np.column_stack([np.interp(at, corners, x) for x in way.T])
    # heights to clear, upside down for strands that pass under: the curve's, then obstacles' too
    up, mark = 1.0 if strand.over else -1.0, body.mark()
    tops = [float((up * body.seen[:, 2]).max())]
    walls = max((float((up * (wall.vertices @ body.frame[:, 2])).max()) for wall in body.obstacles), default=-np.inf)
    for top in tops + [walls] * (walls > tops[0]):
        # a tenth of the curve's size above all else, or below it, and farther and farther along the strand
        lifted = body.seen[vertices]
        lifted[:, 2] = up * (top + body.size * (0.1 + 0.05 * np.linspace(0.0, 1.0, len(vertices))))
        if body.move(vertices, lifted):
            reeled = partial(_reel, body.seen[vertices], new)
            if body.follow(vertices, reeled, 2 * (len(vertices) - 2)):
                return True
        body.rewind(mark)
    return False


def _divide_longest(stops: FloatArray, points: FloatArray, count: int) -> FloatArray:
    """``count`` more stops, where the pieces between the points at the stops, shape (k, 2), are longest."""
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    parts = np.ones(len(lengths))
    for _ in range(count):
        parts[np.argmax(lengths / parts)] += 1
    more = [a + (b - a) * np.arange(1, n) / n for a, b, n in zip(stops[:-1], stops[1:], parts, strict=True)]
    return np.concatenate(more)


def _reel(old: FloatArray, new: FloatArray, turn: int) -> FloatArray:
    """The strand after ``turn`` vertices between its ends are reeled in and, once all of them are, out again."""
    inner = len(old) - 2
    laid = abs(inner - turn)  # so many vertices after the first are not on the segment to the end
    way = np.array(old)
    way[: laid + 1, :2] = (old if turn < inner else new)[: laid + 1, :2]
    rest = np.linspace(0.0, 1.0, inner + 2 - laid)[:, None]
    way[laid:, :2] = way[laid, :2] + rest * (old[-1, :2] - way[laid, :2])
    return way


def plan_way(drawing: PlaneDrawing, move: Move, start: tuple[int, float], end: tuple[int, float]) -> FloatArray | None:
    """The corners of a strand's new way, its ends included, shape (k, 2); None if there is none.

    ``start`` and ``end`` are numbers of pieces, on the edges before and after the strand, and places on them.
    """
    # the pieces of all that stays, from node to node, and the edges of the diagram that they belong to
    strand, last, count = move.strand, move.strand.inner[-1], len(drawing.nodes)
    walls: dict[tuple[int, int], int] = {}
    for edge, chain in drawing.chains():
        if edge == strand.first == last:
            chain = [count + 1, count]
        elif edge == strand.first:
            chain = [*chain[: start[0] + 1], count]
        elif edge == last:
            chain = [count + 1, *chain[end[0] + 1 :]]
        elif edge in strand.inner:
            continue
        walls |= dict.fromkeys(pairwise(chain), edge)
    nodes = np.concatenate([drawing.nodes, drawing.placed(np.array([start[1], end[1]]))])
    used, names = np.unique(np.array(list(walls)), return_inverse=True)
    ends = [(a, b) for a, b in names.reshape(-1, 2).tolist()]
    triangles = Triangles(nodes[used], ends)
    points, corners = triangles.points, triangles.corners
    # gates: directed edges of triangles, each crossed from its left to its right, with the darts that are crossed there
    left = {(a, b): k for side in ([0, 1], [1, 2], [2, 0]) for k, (a, b) in enumerate(corners[:, side].tolist())}
    gates = [(a, b) for a, b in left if (b, a) in left]
    leave, enter = np.array([[left[a, b], left[b, a]] for a, b in gates]).T
    width = np.linalg.norm(np.subtract(*points[np.array(gates)].transpose(1, 0, 2)), axis=1)
    dart_of = {(a, b): 2 * edge for (a, b), edge in zip(ends, walls.values(), strict=True)}
    dart_of |= {(b, a): dart + 1 for (a, b), dart in dart_of.items()}
    dart = np.array([dart_of.get(gate, -1) for gate in gates])
    # the best way through open gates, which stay in a layer, and those of the route, each of which leads to the next
    many, layers = len(corners), len(move.route) + 1
    steps = [(np.flatnonzero(dart == -1), layer, layer) for layer in range(layers)]
    steps += [(np.flatnonzero(dart == wall), layer, layer + 1) for layer, wall in enumerate(move.route)]
    through = np.concatenate([each for each, _, _ in steps])
    i = np.concatenate([leave[each] + many * layer for each, layer, _ in steps])
    j = np.concatenate([enter[each] + many * layer for each, _, layer in steps])
    cost = np.sqrt(np.ptp(points, axis=0).max() / width)
    graph = coo_array((cost[through], (i, j)), shape=(many * layers, many * layers)).tocsr()
    terminals = np.searchsorted(used, [count, count + 1])
    begin, goal = (np.flatnonzero((corners == point).any(axis=1)) for point in terminals)
    goal = goal + many * len(move.route)
    distance, before, _ = dijkstra(graph, indices=begin, return_predecessors=True, min_only=True)
    here = int(goal[np.argmin(distance[goal])])
    if not np.isfinite(distance[here]):
        return None
    gate_of = dict(zip(zip(i.tolist(), j.tolist(), strict=True), through.tolist(), strict=True))
    way: list[int] = []
    while before[here] >= 0:
        way.append(gate_of[int(before[here]), here])
        here = int(before[here])
    way.reverse()
    return _straighten(points[terminals], points[np.array(gates)[way]], width[way], dart[way] != -1)


def _straighten(ends: FloatArray, gates: FloatArray, width: FloatArray, is_wall: BoolArray) -> FloatArray:
    """A way through gates, shape (k, 2, 2), by their middles where it turns, with vertices on both sides of walls."""
    right, left = gates.transpose(1, 0, 2)
    middle = 0.5 * (left + right)
    stops, passed = [ends[0]], [0]  # the corners that the way may have, and how many gates come before each
    around = np.concatenate([ends[:1], middle, ends[1:]])
    for k, center in enumerate(middle):
        if not is_wall[k]:
            stops.append(center)
            passed.append(k)
            continue
        for toward, count in ((around[k], k), (around[k + 2], k + 1)):
            away = toward - center
            # 0.3 of the way to the next gate, or 0.2 of the width of this one
            reach = min(0.3, 0.2 * width[k] / float(np.linalg.norm(away)))
            stops.append(center + reach * away)
            passed.append(count)
    stops.append(ends[1])
    passed.append(len(middle))
    inset = 0.15 * (left - right)  # ways keep clear of the ends of gates
    right, left = right + inset, left - inset
    corners, here = [0], 0
    while here < len(stops) - 1:
        for there in range(len(stops) - 1, here, -1):
            # whether the segment goes through all gates on the way, clear of their ends
            between, d = slice(passed[here], passed[there]), stops[there] - stops[here]
            u, v = right[between] - stops[here], left[between] - stops[here]
            if ((d[0] * v[:, 1] - d[1] * v[:, 0] >= 0) & (d[0] * u[:, 1] - d[1] * u[:, 0] <= 0)).all():
                break
        here = there
        corners.append(here)
    return np.array(stops)[corners]
