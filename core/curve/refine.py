"""New vertices for polygons: refined, adaptive and smoothed meshes.

Refinement puts vertices on the edges, so that neighbours are nearer to each other than to other strands: "the distance
between two neighboring vertices of a polygon should be strictly smaller than the distance between any other pairs of
vertices" (Section 6.1.3 of [RS21]).  The polygon as a set of points does not change; equal edge lengths are left to the
flow.  Adaptive meshes split and collapse edges to that end.  A collapse first moves a vertex onto the chord of its
neighbours, a motion to be proved free of contact like any other, and then removes it.
"""

import heapq
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from ..base import CurveOptionError, FloatArray, IntArray, checked, dot
from .curve import Curve
from .distances import strand_gaps
from .mesh import Mesh
from .pins import NOWHERE, arcs, holds

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

SPLIT = 1.5  # edges longer than this many times the spacing wanted are split
SAMPLES = 8  # points of a spline, for each vertex of its polygon, at which its arc length is measured


@dataclass(frozen=True)
class Resolution:
    """The edge lengths allowed."""

    vertices: int | None = None  # the number if no strands were near; None for the usual one
    edges_per_gap: float = 1.0  # number of edges that fit in between near strands
    clearance: Callable[[Curve], FloatArray | float] = lambda _: np.inf  # of obstacles from each edge, (edges,) or inf
    usual: ClassVar[int] = 200  # vertices of a component: enough for energies to a tenth of a per cent
    sharers: ClassVar[int] = 10  # components that get so many each; more of them share what ten would have


@checked
def refine(curve: Curve, vertices: int | None = None) -> Curve:
    """Subdivide edges of an embedded polygon until neighbours are nearer than strands, or to a number of vertices.

    Raises CurveOptionError if fewer vertices are requested than the curve has: corners are never cut.
    """
    if vertices is not None and vertices < len(curve):
        told = f"vertices is {vertices}, but the curve has {len(curve)} already; ask for that many or more"
        raise CurveOptionError(told)
    spacing = target_spacing(curve, Resolution())
    if vertices is not None:
        edges = vertices - len(curve.mesh.ends)
        return subdivide(curve, apportion(curve.edge_lengths / spacing, edges))
    # 1,000 for each of ten components, unless the curve has half as many, and 5,000 altogether, unless it has more:
    # where gaps ask for more, the barrier's exact energies do to begin with, and hard unknots become circles in a sixth
    # of the time; strands that are as near in the end get more then
    most = min(max(2 * len(curve), 1000 * min(Resolution.sharers, len(curve.mesh.component_sizes))), 5000)
    return subdivide(curve, affordable_pieces(curve, spacing, most))


def subdivide(curve: Curve, pieces: IntArray) -> Curve:
    """Cut every edge I into ``pieces[I]`` equal parts; the original vertices stay as they are."""
    edge = np.repeat(np.arange(curve.mesh.edges), pieces)
    first = np.concatenate([[0], np.cumsum(pieces)[:-1]])
    t = (np.arange(len(edge)) - first[edge]) / pieces[edge]
    points = curve.vertices[curve.mesh.tails[edge]] + t[:, None] * curve.edge_vectors[edge]
    mesh = Mesh.of_edges(np.array([pieces[s].sum() for s in curve.mesh.edge_slices]), curve.mesh.closed)
    vertices = np.empty((mesh.size, curve.dimension))
    vertices[mesh.tails] = points
    vertices[mesh.ends[:, 1]] = curve.vertices[curve.mesh.ends[:, 1]]
    return Curve(vertices, mesh)


def target_spacing(curve: Curve, resolution: Resolution) -> FloatArray:
    """Largest edge length wanted on every edge: by the count, or by gaps to other strands; shape (edges,).

    Gaps that allow edges longer than that, or than the longest there is, do not matter and are not searched for.
    """
    sharers = min(resolution.sharers, len(curve.mesh.component_sizes))
    base = curve.length / (resolution.vertices or resolution.usual * sharers)
    pieces = np.ceil(4.0 * curve.edge_lengths / base).astype(np.intp)  # four samples on each edge as long as that
    samples = subdivide(curve, pieces)
    spacing = np.full(curve.mesh.edges, base)
    longest = min(base, float(curve.edge_lengths.max()))
    allowed = strand_gaps(samples, resolution.edges_per_gap * longest) / resolution.edges_per_gap
    allowed = np.maximum(allowed, np.finfo(np.float64).eps * base)  # rounded sample points may coincide
    near = allowed < np.inf
    edge = np.repeat(np.arange(curve.mesh.edges), pieces)[samples.mesh.outgoing]
    np.minimum.at(spacing, edge[near], allowed[near])
    return spacing


def affordable_pieces(curve: Curve, spacing: FloatArray, most: int) -> IntArray:
    """Pieces per edge for a spacing, or for the finest with at most so many vertices; 1 each if there are as many."""
    most, floor = max(len(curve), most) - len(curve.mesh.ends), 0.0
    while True:
        # a little slack, so that a curve that already has the wanted spacing stays as it is
        pieces = np.maximum(1.0, np.ceil(curve.edge_lengths / np.maximum(spacing, floor) - 0.1))
        if pieces.sum() <= most:
            return np.asarray(pieces.astype(np.intp))
        floor = 1.2 * max(floor, float(spacing.min()), curve.length / (100.0 * most))


def apportion(wanted: FloatArray, total: int) -> IntArray:
    """Pieces per edge, at least 1 each and ``total`` together, as nearly proportional to ``wanted`` as can be."""
    pieces = np.maximum(1, np.floor(wanted * (total - len(wanted)) / wanted.sum())).astype(np.intp)
    queue = [(-w / p, k) for k, (w, p) in enumerate(zip(wanted, pieces, strict=True))]
    heapq.heapify(queue)
    for _ in range(total - int(pieces.sum())):
        _, k = heapq.heappop(queue)
        pieces[k] += 1
        heapq.heappush(queue, (-float(wanted[k]) / float(pieces[k]), k))
    return np.asarray(pieces)


def refined_alike(x: Curve, y: Curve, begins: tuple[float, ...]) -> tuple[Curve, Curve]:
    """Two curves with the same components on one mesh, vertices at nearly equal shares of length.

    Vertices that are near to each other become one.  Others become points in the middle of the other curve's edges: the
    arcs of a rope as thick as bends allow leave no room for them elsewhere.
    ``begins``: the share of the length of each component of ``y`` at which the first vertex of ``x`` lies.
    """
    parts: tuple[list[FloatArray], list[FloatArray]] = [], []
    for component, (begin, closed) in enumerate(zip(begins, x.mesh.closed, strict=True)):
        shares = [arc_lengths(each.components[component]) / each.component_lengths[component] for each in (x, y)]
        near = 0.3 / max(map(len, shares))  # mean edges that vertices of the two may be apart and still become one
        if closed:
            shares[0] = (shares[0] + begin + near) % 1.0 - near  # so that the first of all has a partner to merge with
        events = sorted((share, which, k) for which in (0, 1) for k, share in enumerate(shares[which].tolist()))
        nodes: list[tuple[list[float], list[int]]] = []  # share and vertex of each curve at each node, −1 for no vertex
        for share, which, k in events:
            if nodes and nodes[-1][1][which] < 0 <= nodes[-1][1][1 - which] and share - nodes[-1][0][1 - which] < near:
                nodes[-1][0][which], nodes[-1][1][which] = share, k
            else:
                nodes.append(([share, share], [k if each == which else -1 for each in (0, 1)]))
        places, vertices = (np.array(each).T for each in zip(*nodes, strict=True))
        for which, (curve, first) in enumerate(((x, begin), (y, 0.0))):
            part, own, has = curve.components[component], places[which], vertices[which] >= 0
            there, last = np.flatnonzero(has), np.cumsum(has)
            # around each node are two vertices, the last and the next, perhaps of the round before or after
            node = np.concatenate([there[-1:] - len(has), there, there[:1] + len(has)])
            share = np.concatenate([own[there[-1:]] - 1.0, own[there], own[there[:1]] + 1.0])
            along = 0.45 + 0.1 * (np.arange(len(has)) - node[last]) / (node[last + 1] - node[last])
            own = np.where(has, own, share[last] + along * (share[last + 1] - share[last]))
            points = at_shares(part, closed, (own - first) % 1.0 if closed else own)
            points[has] = part[vertices[which][has]]
            parts[which].append(points)
    mesh = Mesh(tuple(map(len, parts[0])), x.mesh.closed)
    return Curve(np.concatenate(parts[0]), mesh), Curve(np.concatenate(parts[1]), mesh)


def graded_spacing(curve: Curve, resolution: Resolution) -> FloatArray:
    """Edge length wanted on every edge, varying by a ratio of 1.3 at most from edge to edge; shape (edges,).

    It is half of the clearance at most, because a curve bends as tightly as it is near to obstacles.
    """
    spacing = np.minimum(target_spacing(curve, resolution), 0.5 * resolution.clearance(curve))
    for part, closed in zip(curve.mesh.edge_slices, curve.mesh.closed, strict=True):
        # one sweep each way, twice round where the component is closed, spreads every minimum as far as it reaches
        for direction in (1, -1):
            local = np.tile(spacing[part][::direction], 2 if closed else 1)
            steps = np.log(1.3) * np.arange(len(local))
            local = np.exp(np.minimum.accumulate(np.log(local) - steps) + steps)
            spacing[part] = local[part.start - part.stop :][::direction]
    return spacing


def superfluous(curve: Curve, spacing: FloatArray, kept: IntArray = NOWHERE, least: int = 16) -> IntArray:
    """Vertices that may be removed: both edges there are shorter than half the spacing wanted.

    No two of them are neighbours or next but one, and none is an end or a vertex to be kept.  Components, and arcs
    between those, keep the ``least`` number of edges if they had as many.
    """
    mesh, before, after = curve.mesh, curve.mesh.incoming, curve.mesh.outgoing
    joined = curve.edge_lengths < 0.5 * spacing
    short = joined[before] & joined[after] & (before != after) & ~holds(mesh, kept)
    arc_of, room = np.empty(mesh.edges, dtype=np.intp), []
    for number, arc in enumerate(arcs(mesh, kept)):
        arc_of[arc] = number
        room.append(len(arc) - min(len(arc), least))
    chosen: list[int] = []
    for part in mesh.slices:
        size, last, first = part.stop - part.start, -3, None
        for k in np.flatnonzero(short[part]):
            wraps = first is not None and first + size - k < 3
            arc = arc_of[after[part.start + k]]
            if room[arc] > 0 and k - last >= 3 and not wraps:
                chosen.append(part.start + int(k))
                first = int(k) if first is None else first
                last = int(k)
                room[arc] -= 1
    return np.array(chosen, dtype=np.intp)


def onto_chords(curve: Curve, vertices: IntArray) -> Curve:
    """The polygon after some vertices have moved onto the chords of their neighbours."""
    mesh, moved = curve.mesh, curve.vertices.copy()
    before = curve.vertices[mesh.tails[mesh.incoming[vertices]]]
    chord = curve.vertices[mesh.heads[mesh.outgoing[vertices]]] - before
    along = dot(curve.vertices[vertices] - before, chord) / dot(chord, chord)
    moved[vertices] = before + np.clip(along, 0.2, 0.8)[:, None] * chord
    return curve.with_vertices(moved)


def collapsed(curve: Curve, vertices: IntArray, spacing: FloatArray) -> Curve:
    """The same set of points, up to rounding, without vertices that lie on the chords of their neighbours, and with
    edges split that are too long for the spacing."""
    keep = ~holds(curve.mesh, vertices)
    sizes = tuple(int(np.count_nonzero(keep[part])) for part in curve.mesh.slices)
    coarse = Curve(curve.vertices[keep], Mesh(sizes, curve.mesh.closed))
    wanted = spacing[keep[curve.mesh.tails]]
    pieces = np.where(coarse.edge_lengths > SPLIT * wanted, np.ceil(coarse.edge_lengths / wanted), 1.0)
    return subdivide(coarse, pieces.astype(np.intp))


def normalised(curve: Curve, spacing: FloatArray, pins: IntArray) -> FloatArray:
    """Edge lengths as the spacing, scaled with the length of every arc between pins, or component, kept; shape (n,)."""
    lengths = spacing.copy()
    for arc in arcs(curve.mesh, pins):
        lengths[arc] *= curve.edge_lengths[arc].sum() / spacing[arc].sum()
    return lengths


def smoothed(curve: Curve, mesh: Mesh, pins: IntArray = NOWHERE, places: IntArray = NOWHERE) -> Curve:
    """The polygon with vertices at equal distances along the cubic splines through the vertices of each component.

    ``mesh`` has its numbers of vertices.  Some vertices of the curve, ``pins``, ascending, become those at ``places``;
    distances are equal between consecutive ones.  A closed component without any keeps the place of its first vertex,
    arcs the places of their ends.
    """
    pieces = []
    for old, new, closed in zip(curve.mesh.slices, mesh.slices, mesh.closed, strict=True):
        own = (pins >= old.start) & (pins < old.stop)
        ends = [] if closed else [[0, 0], [old.stop - old.start - 1, new.stop - new.start - 1]]
        held = np.stack([pins[own] - old.start, places[own] - new.start], axis=1).tolist()
        anchors, numbers = np.unique([*ends, *held] or [[0, 0]], axis=0).T
        spline, size = cubic_spline(curve.vertices[old], closed), new.stop - new.start
        parameter = sample_parameters(spline)
        arc = arc_lengths(spline(parameter))
        at, every = arc[SAMPLES * anchors], numbers[0] + np.arange(size)
        if closed:
            at, numbers = np.append(at, at[0] + arc[-1]), np.append(numbers, numbers[0] + size)
        wanted = np.empty(size)
        wanted[every % size] = np.interp(every, numbers, at)
        wanted[wanted > arc[-1]] -= arc[-1]
        pieces.append(spline(np.interp(wanted, arc, parameter)))
    return Curve(np.concatenate(pieces), mesh)


def halved(curve: Curve) -> Curve:
    """Closed polygons with an additional vertex for each edge, on the splines through their vertices."""
    splines = [cubic_spline(points) for points in curve.components]
    places = [np.interp(np.arange(0.0, len(each.x) - 1.0, 0.5), np.arange(len(each.x)), each.x) for each in splines]
    return Curve.from_components([spline(at) for spline, at in zip(splines, places, strict=True)])


def cubic_spline(points: FloatArray, closed: bool = True) -> "CubicSpline":
    """The cubic spline through the vertices of a polygon, shape (n, m), by its arc length; a natural one if open."""
    from scipy.interpolate import CubicSpline  # which takes a while to import

    points = np.concatenate([points, points[:1]]) if closed else points
    return CubicSpline(arc_lengths(points), points, bc_type="periodic" if closed else "natural")


def sample_parameters(spline: "CubicSpline") -> FloatArray:
    """Parameters from the first to the last, so many in each piece that chords between them are as good as arcs."""
    pieces = len(spline.x) - 1
    places = np.linspace(0.0, pieces, SAMPLES * pieces + 1)
    return np.asarray(np.interp(places, np.arange(pieces + 1), spline.x))


def arc_lengths(points: FloatArray) -> FloatArray:
    """Distances along a polyline from its first point; shape (n,)."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def at_shares(points: FloatArray, closed: bool, shares: FloatArray) -> FloatArray:
    """Points of a polygon at shares of its length; shape (k, m)."""
    points = np.concatenate([points, points[:1]]) if closed else points
    along = arc_lengths(points)
    return np.stack([np.interp(shares * along[-1], along, x) for x in points.T], axis=1)


def evenly(points: FloatArray, closed: bool, count: int) -> FloatArray:
    """A number of points of a polygon at equal distances along it, the first one included; shape (count, m)."""
    return at_shares(points, closed, np.linspace(0.0, 1.0, count, endpoint=not closed))


def interpolated(values: FloatArray, places: FloatArray) -> FloatArray:
    """Values at places among keys, 2.5 halfway between the third and the fourth; (keys, ...) to (places, ...)."""
    before = np.minimum(places.astype(np.intp), max(len(values) - 2, 0))
    after = np.minimum(before + 1, len(values) - 1)
    share = (places - before).reshape(-1, *[1] * (values.ndim - 1))
    # values that are hit stay bit for bit, and negative zeros are some
    return np.where(share > 0, (1 - share) * values[before] + share * values[after], values[before])
