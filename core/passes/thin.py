"""Removal of vertices that the curve can do without."""

import numpy as np

from ..collision import minimal_gap
from ..collision.gap import squared_segment_distances
from ..curve import Curve, Mesh
from ..diagrams.projection import meeting_boxes, plane_crossings
from ..types import BoolArray, FloatArray, IntArray
from .moving import MovingCurve

_LEAST = {True: 8, False: 4}  # vertices of a component, by whether it is closed
_MARGIN = 0.03  # of a triangle's size: nothing may come nearer to it
_GAP = 4e-3  # of the curve's size: gaps may become that small,
_KEPT = 0.99  # or else keep at least that part of their size
_ROUNDS = 30
_ENDS = 0.02  # a vertex is not moved nearer to its neighbours than that part of their distance


def thin(body: MovingCurve) -> None:
    """Drop vertices whose triangle with their neighbours nothing pierces, if no crossings are added."""
    gap = min(_KEPT * body.gap, _GAP * body.size)
    for _ in range(_ROUNDS):
        chosen = _Corners.of(body, gap).independent(body.mesh)
        if not len(chosen) or not len(_dropped(body, chosen, gap, _crossings(body.curve, body.frame))):
            break


def _crossings(curve: Curve, frame: FloatArray) -> int:
    return len(plane_crossings(curve.mesh, curve.vertices @ frame).turn)


class _Corners:
    """Vertices, their neighbours a and c, and the triangles that these make."""

    def __init__(self, mesh: Mesh, points: FloatArray, vertices: IntArray, gap: float) -> None:
        self.vertices, self.before, self.after = vertices, mesh.anticycle[vertices], mesh.cycle[vertices]
        self.a, self.b, self.c = points[self.before], points[vertices], points[self.after]
        self.area = np.linalg.norm(np.cross(self.b - self.a, self.c - self.a), axis=1)
        corners = np.stack([self.a, self.b, self.c])
        grow = gap + _MARGIN * np.ptp(corners, axis=0).max(axis=1, keepdims=True)
        self.low, self.high = (corners.min(axis=0) - grow)[:, :2], (corners.max(axis=0) + grow)[:, :2]

    @classmethod
    def of(cls, body: MovingCurve, gap: float) -> "_Corners":
        """The corners that can each go alone, smallest triangles first."""
        mesh, points = body.mesh, body.seen
        least = np.array([_LEAST[closed] for closed in mesh.closed])
        spare = (np.array(mesh.component_sizes) > least)[mesh.component]
        spare &= ~body.held & ~(body.held[mesh.anticycle] & body.held[mesh.cycle])  # arcs between pins stay bent
        every = cls(mesh, points, np.flatnonzero(spare), gap)
        start, end = points[mesh.tails], points[mesh.heads]
        k, edge = meeting_boxes(every.low, every.high, np.minimum(start, end)[:, :2], np.maximum(start, end)[:, :2])
        ends = np.stack([mesh.tails[edge], mesh.heads[edge]])
        own = [(ends == each[k]).any(axis=0) for each in (every.before, every.vertices, every.after)]
        k, edge = (values[~np.any(own, axis=0)] for values in (k, edge))
        start, end = start[edge], end[edge]
        crossed = np.bincount(k, _crosses(every.a[k], every.c[k], start, end), len(every.vertices))
        now = np.bincount(k, _crosses(every.a[k], every.b[k], start, end), len(every.vertices))
        now += np.bincount(k, _crosses(every.b[k], every.c[k], start, end), len(every.vertices))
        spans = np.ascontiguousarray(np.concatenate([every.a[k], every.c[k], start, end]).T)
        near = squared_segment_distances(spans, np.arange(4 * len(k)).reshape(4, -1)) < gap**2
        pierced = np.bincount(k, near | _pierced(every, k, start, end - start), len(every.vertices)) > 0
        fit = np.flatnonzero(~pierced & (crossed <= now))
        return cls(mesh, points, every.vertices[fit[np.argsort(every.area[fit], kind="stable")]], gap)

    def independent(self, mesh: Mesh) -> IntArray:
        """Vertices that can go together: no two are near, and no triangle is pierced by another's new edge."""
        first, second = meeting_boxes(self.low, self.high, self.low, self.high)
        pierced = _pierced(self, first, self.a[second], (self.c - self.a)[second])
        beside: list[list[int]] = [[] for _ in self.vertices]
        for i, j in zip(first[pierced].tolist(), second[pierced].tolist(), strict=True):
            beside[i].append(j)
            beside[j].append(i)
        spare = [size - _LEAST[closed] for size, closed in zip(mesh.component_sizes, mesh.closed, strict=True)]
        taken = np.zeros(mesh.size, dtype=bool)  # vertices that have to stay where they are, or go
        shut = np.zeros(len(self.vertices), dtype=bool)
        chosen = []
        for k, vertex in enumerate(self.vertices.tolist()):
            near = [vertex, self.before[k], self.after[k]]
            component = mesh.component[vertex]
            if not shut[k] and not taken[near].any() and spare[component] > 0:
                chosen.append(vertex)
                spare[component] -= 1
                shut[beside[k]] = True
                taken[near] = True
        return np.array(chosen, dtype=np.intp)


def _pierced(corners: _Corners, k: IntArray, start: FloatArray, edge: FloatArray) -> BoolArray:
    """Whether edges pierce triangles k, both enlarged by the margin; shape (pairs,)."""
    u, v, apart = (corners.b - corners.a)[k], (corners.c - corners.a)[k], start - corners.a[k]
    normal = np.cross(u, v)
    with np.errstate(all="ignore"):
        t = -_dot(apart, normal) / _dot(edge, normal)
        hit = apart + t[:, None] * edge
        uu, vv, uv, hu, hv = _dot(u, u), _dot(v, v), _dot(u, v), _dot(hit, u), _dot(hit, v)
        x, y = (hu * vv - hv * uv) / (uu * vv - uv * uv), (hv * uu - hu * uv) / (uu * vv - uv * uv)
        within = (np.minimum(np.minimum(t, x), y) > -_MARGIN) & (np.maximum(t, x + y) < 1 + _MARGIN)
    return np.asarray(within)


def _dot(u: FloatArray, v: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ij,ij->i", u, v))


def _crosses(a: FloatArray, c: FloatArray, start: FloatArray, end: FloatArray) -> BoolArray:
    """Whether segments cross others in the plane; shape (pairs,)."""

    def side(p: FloatArray, q: FloatArray, r: FloatArray) -> FloatArray:
        (x, y), (z, w) = (q - p)[:, :2].T, (r - p)[:, :2].T
        return np.asarray(x * w - y * z)

    return np.asarray((side(a, c, start) * side(a, c, end) < 0) & (side(start, end, a) * side(start, end, c) < 0))


def _dropped(body: MovingCurve, chosen: IntArray, gap: float, crossings: int) -> IntArray:
    """Move vertices onto segments between their neighbours and drop them, together or in halves; return which went."""
    mesh, points = body.mesh, body.curve.vertices
    to = np.linalg.norm(points[chosen] - points[mesh.anticycle[chosen]], axis=1)
    on = np.linalg.norm(points[chosen] - points[mesh.cycle[chosen]], axis=1)
    left = np.bincount(np.delete(mesh.component, chosen), minlength=len(mesh.component_sizes))
    thinner = Curve(np.delete(points, chosen, axis=0), Mesh(tuple(left.tolist()), mesh.closed))
    mark = body.mark()
    if minimal_gap(thinner)[0] >= gap and _crossings(thinner, body.frame) <= crossings:
        if body.straighten(chosen, np.clip(to / (to + on), _ENDS, 1.0 - _ENDS)) and body.drop(chosen):
            return chosen
        body.rewind(mark)
    if len(chosen) == 1:
        return chosen[:0]
    early, late = np.split(chosen, [len(chosen) // 2])
    gone = _dropped(body, early, gap, crossings)
    now = late - np.searchsorted(np.sort(gone), late)
    return np.concatenate([gone, late[np.isin(now, _dropped(body, now, gap, crossings))]])
