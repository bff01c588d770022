"""What makes room for strand moves: vertices that the curve can do without are dropped, and drawings are spread.

In a spread drawing strands that had come near each other are apart, and there are no new crossings.  Vertices and
crossings are corners of triangles.  Wherever each corner inside is an average of its neighbours with positive weights,
no triangle is turned over (Tutte 1963; Floater, *Math. Comp.* 72, 2003).  The drawing as it is has mean value
coordinates as weights; the weights of springs, stiffened until all are about equally long, spread it, and averages of
both weights lead there (Floater and Gotsman, *J. Comput. Appl. Math.* 101, 1999).
"""

from collections.abc import Callable
from functools import partial
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from ..base.types import BoolArray, FloatArray, IntArray
from ..collision import minimal_gap
from ..collision.gap import squared_segment_distances
from ..curve import Curve
from ..knots.diagrams.projection import meeting_boxes, plane_crossings
from .drawing import PlaneDrawing, Triangles
from .moving import MovingCurve

_MARGIN = 0.03  # of a triangle's size: nothing may come nearer to it

_dot = partial(np.einsum, "ij,ij->i")


def thin(body: MovingCurve) -> None:
    """Drop vertices whose triangle with their neighbours nothing pierces, if no crossings are added."""
    gap = min(0.99 * body.gap, 4e-3 * body.size)  # gaps may become that small, and a little smaller where they are
    for _ in range(30):
        chosen = _spare_vertices(body, gap)
        if not len(chosen) or not len(_drop(body, chosen, gap, _count_crossings(body.curve, body.frame))):
            break


def _count_crossings(curve: Curve, frame: FloatArray) -> int:
    return len(plane_crossings(curve.mesh, curve.vertices @ frame).turn)


def _spare_vertices(body: MovingCurve, gap: float) -> IntArray:
    """Vertices that can go together: nothing is near their triangles, and no two of these are near."""
    mesh, points = body.mesh, body.seen
    spare = np.array(mesh.component_sizes) - np.where(mesh.closed, 8, 4)  # a component keeps so many vertices
    fit = (spare > 0)[mesh.component] & ~body.held
    fit &= ~(body.held[mesh.anticycle] & body.held[mesh.cycle])  # arcs between pins stay bent
    b = np.flatnonzero(fit)
    a, c = mesh.anticycle[b], mesh.cycle[b]
    corners = points[np.stack([a, b, c])]
    grow = gap + _MARGIN * np.ptp(corners, axis=0).max(axis=1, keepdims=True)
    low, high = (corners.min(axis=0) - grow)[:, :2], (corners.max(axis=0) + grow)[:, :2]
    # edges near triangles: none may pierce them, come near the new edge, or cross that where it crossed neither old one
    start, end = points[mesh.tails], points[mesh.heads]
    k, edge = meeting_boxes(low, high, np.minimum(start, end)[:, :2], np.maximum(start, end)[:, :2])
    ends = np.stack([mesh.tails[edge], mesh.heads[edge]])
    others = ~np.any([(ends == own[k]).any(axis=0) for own in (a, b, c)], axis=0)
    k, edge = k[others], edge[others]
    start, end, (p, q, r) = start[edge], end[edge], corners[:, k]
    added: IntArray = _crosses(p, r, start, end).astype(int) - _crosses(p, q, start, end) - _crosses(q, r, start, end)
    spans = np.ascontiguousarray(np.concatenate([p, r, start, end]).T)
    near = squared_segment_distances(spans, np.arange(4 * len(k)).reshape(4, -1)) < gap**2
    hit = np.bincount(k, near | _pierces(corners[:, k], start, end - start), len(b)) > 0
    fits = np.flatnonzero(~hit & (np.bincount(k, added, len(b)) <= 0))
    # the smallest triangles first, those that are not pierced by another's new edge
    area = np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0]), axis=1)
    order = fits[np.argsort(area[fits], kind="stable")]
    a, b, c, low, high, corners = a[order], b[order], c[order], low[order], high[order], corners[:, order]
    first, second = meeting_boxes(low, high, low, high)
    pierced = _pierces(corners[:, first], corners[0, second], (corners[2] - corners[0])[second])
    beside: list[list[int]] = [[] for _ in b]
    for i, j in zip(first[pierced].tolist(), second[pierced].tolist(), strict=True):
        beside[i].append(j)
        beside[j].append(i)
    taken = np.zeros(mesh.size, dtype=bool)  # vertices that have to stay where they are, or go
    shut = np.zeros(len(b), dtype=bool)
    chosen = []
    for i, around in enumerate(np.stack([a, b, c], axis=1)):
        component = mesh.component[around[1]]
        if not shut[i] and not taken[around].any() and spare[component] > 0:
            chosen.append(around[1])
            spare[component] -= 1
            shut[beside[i]] = True
            taken[around] = True
    return np.array(chosen, dtype=np.intp)


def _pierces(corners: FloatArray, start: FloatArray, edge: FloatArray) -> BoolArray:
    """Whether edges pierce triangles, shape (3, k, 3), both enlarged by the margin; shape (k,)."""
    u, v, apart = corners[1] - corners[0], corners[2] - corners[0], start - corners[0]
    normal = np.cross(u, v)
    with np.errstate(all="ignore"):
        t = -_dot(apart, normal) / _dot(edge, normal)
        hit = apart + t[:, None] * edge
        uu, vv, uv, hu, hv = _dot(u, u), _dot(v, v), _dot(u, v), _dot(hit, u), _dot(hit, v)
        x, y = (hu * vv - hv * uv) / (uu * vv - uv * uv), (hv * uu - hu * uv) / (uu * vv - uv * uv)
        within = (np.minimum(np.minimum(t, x), y) > -_MARGIN) & (np.maximum(t, x + y) < 1 + _MARGIN)
    return np.asarray(within)


def _crosses(a: FloatArray, c: FloatArray, start: FloatArray, end: FloatArray) -> BoolArray:
    """Whether segments cross others in the plane; shape (pairs,)."""

    def side(p: FloatArray, q: FloatArray, r: FloatArray) -> FloatArray:
        (x, y), (z, w) = (q - p)[:, :2].T, (r - p)[:, :2].T
        return np.asarray(x * w - y * z)

    return np.asarray((side(a, c, start) * side(a, c, end) < 0) & (side(start, end, a) * side(start, end, c) < 0))


def _drop(body: MovingCurve, chosen: IntArray, gap: float, crossings: int) -> IntArray:
    """Move vertices onto segments between their neighbours and drop them, together or in halves; return which went."""
    mesh, points = body.mesh, body.curve.vertices
    to = np.linalg.norm(points[chosen] - points[mesh.anticycle[chosen]], axis=1)
    on = np.linalg.norm(points[chosen] - points[mesh.cycle[chosen]], axis=1)
    thinner, mark = body.without(chosen), body.mark()
    if minimal_gap(thinner)[0] >= gap and _count_crossings(thinner, body.frame) <= crossings:
        # no nearer to a neighbour than a fiftieth of their distance
        if body.straighten(chosen, np.clip(to / (to + on), 0.02, 0.98)) and body.drop(chosen):
            return chosen
        body.rewind(mark)
    if len(chosen) == 1:
        return chosen[:0]
    early, late = np.split(chosen, [len(chosen) // 2])
    dropped = _drop(body, early, gap, crossings)
    now = late - np.searchsorted(np.sort(dropped), late)
    return np.concatenate([dropped, late[np.isin(now, _drop(body, now, gap, crossings))]])


def spread(body: MovingCurve, drawing: PlaneDrawing) -> bool:
    """Even out a curve's drawing; return whether that was proved free.  Crossings become vertices of both strands."""
    layout, n = _spread_layout(drawing), drawing.mesh.size
    passes = zip(drawing.at, drawing.diagram.sequence, strict=True)
    crossings = sorted((at, n + crossing) for at, (crossing, _) in passes if crossing >= 0)
    at = np.array([at for at, _ in crossings])
    if not body.insert(at):
        return False
    node = np.insert(np.arange(n), np.floor(at).astype(np.intp) + 1, [node for _, node in crossings])
    before, after = body.mesh.anticycle, body.mesh.cycle
    order = np.argsort(node, kind="stable")
    twice = np.flatnonzero(node[order][1:] == node[order][:-1])
    stays, goes = order[twice], order[twice + 1]

    def places_at(part: int) -> FloatArray:
        """The vertices on their nodes, but one of both at a crossing aside, so that edges cross inside, and once.

        It moves along the bisector of its way in and the nearer branch of the other strand.
        """
        places = layout(part / 64)[node]

        def toward(vertices: IntArray) -> tuple[FloatArray, FloatArray]:
            vectors = places[vertices] - places[goes]
            lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
            return vectors / lengths, lengths

        (one, a), (other, b), (come, c), (_, d) = map(toward, (before[stays], after[stays], before[goes], after[goes]))
        nearer = _dot(one, come) > _dot(other, come)
        aside = come + np.where(nearer[:, None], one, other)
        places[goes] += 0.05 * np.minimum(np.minimum(a, b), np.minimum(c, d)) * aside
        return np.column_stack([places, body.seen[:, 2]])

    return body.follow(np.arange(body.mesh.size), places_at, 64)


def _spread_layout(drawing: PlaneDrawing) -> Callable[[float], FloatArray]:
    """Places of the nodes in the plane, shape (n, 2), by parts of the way from the drawing to one that is spread."""
    nodes, count = drawing.nodes, len(drawing.nodes)
    # a ring of points around the drawing, which stay where they are
    middle = 0.5 * (nodes.min(axis=0) + nodes.max(axis=0))
    radius = 1.2 * np.linalg.norm(nodes - middle, axis=1).max()
    turn = 2.0 * np.pi * np.arange(32) / 32
    ring = middle + radius * np.column_stack([np.cos(turn), np.sin(turn)])
    points = np.concatenate([nodes, ring])
    size = len(points)
    walls = [(count + k, count + (k + 1) % 32) for k in range(32)]
    for _, chain in drawing.chains():
        walls += pairwise(chain)
    corners = Triangles(points, walls).corners
    corners = corners[(corners < size).all(axis=1)]

    def normalise(weights: sp.csr_array) -> sp.csr_array:
        return (sp.diags_array(1.0 / weights.sum(axis=1)) @ weights).tocsr()

    def place(weights: sp.csr_array) -> FloatArray:
        """The nodes as averages of their neighbours; the rows of ``weights`` sum to 1."""
        inside = weights[:count]
        matrix = (sp.eye_array(count) - inside[:, :count]).tocsc()
        return np.asarray(splu(matrix).solve(inside[:, count:] @ ring))

    # mean value coordinates of each point with respect to its neighbours: (tan α/2 + tan β/2)/|x − y|
    rows, columns, values = [], [], []
    for k in range(3):
        at, one, other = np.roll(corners, -k, axis=1).T
        u, v = points[one] - points[at], points[other] - points[at]
        long, wide = np.linalg.norm(u, axis=1), np.linalg.norm(v, axis=1)
        both = long * wide
        half = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / np.maximum(both + _dot(u, v), 1e-9 * both)  # sin α/(1 + cos α)
        rows += [at, at]
        columns += [one, other]
        values += [half / long, half / wide]
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    now = normalise(sp.coo_array(entries, shape=(size, size)).tocsr())
    # weights with which all edges are about equally long
    sides = np.concatenate([corners, np.roll(corners, -1, axis=1)]).reshape(2, -1).T
    sides = np.unique(np.sort(sides, axis=1), axis=0)
    stiff = np.ones(len(sides))
    for _ in range(20):
        form = sp.coo_array((stiff, sides.T), shape=(size, size)).tocsr()
        even = normalise(form + form.T)
        points = np.concatenate([place(even), ring])
        length = np.linalg.norm(points[sides[:, 0]] - points[sides[:, 1]], axis=1)
        stiff *= np.sqrt(length / length.mean())
    return lambda part: place((1.0 - part) * now + part * even)
