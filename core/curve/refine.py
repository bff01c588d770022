"""Refinement: new vertices on the edges, so that neighbours are nearer to each other than to other strands.

Section 6.1.3 of [RS21]: "the distance between two neighboring vertices of a polygon should be strictly
smaller than the distance between any other pairs of vertices".  The polygon as a set of points does not
change; equal edge lengths are left to the flow.
"""

import heapq
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arguments import checked
from ..errors import CurveOptionError
from ..types import FloatArray, IntArray
from .curve import Curve
from .distances import strand_gaps
from .mesh import Mesh
from .smooth import arc_lengths, at_shares

DEFAULT_VERTICES = 200  # per component: enough for energies to a tenth of a per cent
# to begin with: where gaps ask for more, the barrier's exact energies do, and hard unknots become circles in a sixth of
# the time; strands that are as near in the end get more then
MAX_PER_COMPONENT = 1000  # unless the curve has half as many
MAX_ALTOGETHER = 5000  # unless the curve has more already
COMPONENTS = 10  # that get so many each; more of them share what ten would have
SAMPLES_PER_SPACING = 4.0  # sample points per default edge length when gaps are measured
TOGETHER = 0.3  # mean edges that vertices of the two curves may be apart and still become one


@dataclass(frozen=True)
class Resolution:
    """The edge lengths allowed."""

    vertices: int | None = None  # the number if no strands were near; None for 200 per component
    edges_per_gap: float = 1.0  # number of edges that fit in between near strands
    clearance: Callable[[Curve], FloatArray | float] = lambda _: np.inf  # of obstacles from each edge, (edges,) or inf


@checked
def refine(curve: Curve, vertices: int | None = None) -> Curve:
    """Subdivide edges of an embedded polygon until neighbours are nearer than strands, or to a number of vertices.

    Raises CurveOptionError if fewer vertices are requested than the curve has: corners are never cut.
    """
    if vertices is not None and vertices < len(curve):
        raise CurveOptionError(
            f"vertices is {vertices}, but the curve has {len(curve)} already; ask for that many or more"
        )
    spacing = target_spacing(curve, Resolution())
    if vertices is not None:
        edges = vertices - len(curve.mesh.ends)
        return subdivide(curve, apportion(curve.edge_lengths / spacing, edges))
    components = len(curve.mesh.component_sizes)
    most = min(max(2 * len(curve), MAX_PER_COMPONENT * min(COMPONENTS, components)), MAX_ALTOGETHER)
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
    sharers = min(COMPONENTS, len(curve.mesh.component_sizes))
    base = curve.length / (resolution.vertices or DEFAULT_VERTICES * sharers)
    pieces = np.ceil(SAMPLES_PER_SPACING * curve.edge_lengths / base).astype(np.intp)
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
    """Two curves with the same components on one mesh, vertices at equal shares of length.

    ``begins``: the share of the length of each component of ``y`` at which the first vertex of ``x`` lies.
    """
    parts = [_alike(x, y, k, begin) for k, begin in enumerate(begins)]
    mesh = Mesh(tuple(len(points) for points, _ in parts), x.mesh.closed)
    return Curve(np.concatenate([p for p, _ in parts]), mesh), Curve(np.concatenate([q for _, q in parts]), mesh)


def _alike(x: Curve, y: Curve, component: int, begin: float) -> tuple[FloatArray, FloatArray]:
    closed = x.mesh.closed[component]
    shares = [arc_lengths(each.components[component]) / each.component_lengths[component] for each in (x, y)]
    near = TOGETHER / max(map(len, shares))
    if closed:
        shares[0] = (shares[0] + begin + near) % 1.0 - near  # so that the first of all has a partner to merge with
    events = sorted((share, which, k) for which in (0, 1) for k, share in enumerate(shares[which].tolist()))
    nodes: list[dict[int, int]] = []  # the vertex of each curve, if any, at each node
    places: list[float] = []
    for share, which, k in events:
        if nodes and which not in nodes[-1] and len(nodes[-1]) == 1 and share - places[-1] < near:
            nodes[-1][which] = k
        else:
            nodes.append({which: k})
            places.append(share)
    found = []
    for which, (curve, first) in enumerate(((x, begin), (y, 0.0))):
        part, own = curve.components[component], np.array(places)
        points = at_shares(part, closed, (own - first) % 1.0 if closed else own)
        has = [node for node, vertices in enumerate(nodes) if which in vertices]
        points[has] = part[[nodes[node][which] for node in has]]
        found.append(points)
    return found[0], found[1]
