"""Is a curve composite?  A ball that it enters and leaves once, knotted inside and knotted outside, proves so.

No composite knot has a shape of least Möbius energy: as such a ball shrinks, the energy falls towards the sum of the
two parts' energies less the circle's 4 and never gets there.  A relaxation makes such balls round, so round ones are
looked for: lifted to the paraboloid (x, |x|²), balls are half spaces, and a ball round an arc is a separating plane.
All arcs have the same points and differ in signs alone, so that the planes of all are sought at once.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain, compress, product

import numpy as np
from scipy.sparse.csgraph import connected_components

from ..base import BoolArray, FloatArray, IntArray
from ..curve import Curve, Obstacle, nearest_on_edges
from .diagrams import linking_numbers, quick_invariants
from .diagrams.invariants import TRIVIAL

# How thoroughly balls are searched for
SHORTEST = 1 / 8  # arc, as a fraction of its component
SAMPLES = 120  # vertices of the curve that balls are fitted to
TRIALS = 3000  # balls that are fitted at most; other links are not searched
_MARGIN = 1e-6  # of the separating plane, for a curve of size 1: far above rounding


@dataclass(frozen=True, eq=False)
class Ball:
    """A round ball: ``center``, shape (3,), and ``radius`` are in the curve's units."""

    center: FloatArray
    radius: float

    def contains(self, points: FloatArray) -> BoolArray:
        return np.asarray(np.linalg.norm(points - self.center, axis=1) < self.radius)

    def is_clear_of(self, obstacle: Obstacle) -> bool:
        """Whether an obstacle is certainly outside, as the boxes around its triangles or segments are."""
        low, high = obstacle.corners.min(axis=1), obstacle.corners.max(axis=1)
        outside = np.maximum(np.maximum(low - self.center, self.center - high), 0.0)
        return bool(np.linalg.norm(outside, axis=1).min() > self.radius)


def knotted_ball(curve: Curve) -> Ball | None:
    """A ball whose sphere meets the curve in two points, both parts being knotted or linked; None if none is found.

    A ball proves that the curve is composite.  None proves nothing: parts may have a trivial Alexander polynomial, or
    lie in no round ball, and a link may be beyond `is_searchable`.  Only closed polygons in space can be knots.
    """
    if curve.dimension != 3 or not curve.mesh.all_closed or not is_searchable(curve):
        return None
    middle = curve.vertices.mean(axis=0)
    size = float(np.abs(curve.vertices - middle).max())
    normal = curve.with_vertices((curve.vertices - middle) / size)
    sample = np.arange(0, len(curve), max(1, len(curve) // SAMPLES))
    slices, component = curve.mesh.slices, curve.mesh.component[sample]
    places, wanted = _places(len(slices))
    # of each component which sampled vertices are inside, (m, n): one of its arcs, the longest ones first, and any
    # whole components among the others that can lie there together
    for part, groups in zip(slices, _linked_groups(curve), strict=True):
        count = part.stop - part.start
        starts, lengths = np.unique(np.arange(places) * count // places), np.unique(np.array(wanted) * count // places)
        along = (sample - part.start - starts[:, None]) % count
        arcs = (along < lengths[::-1, None, None]) & (part.start <= sample) & (sample < part.stop)
        choices = product((False, True), repeat=len(groups))
        others = [np.isin(component, list(chain.from_iterable(compress(groups, chosen)))) for chosen in choices]
        inside = (arcs[:, :, None] | np.array(others)).reshape(-1, len(sample))
        for ball in _separating(normal.vertices[sample], np.where(inside, -1.0, 1.0)):
            if _is_knotted(normal, ball):
                return Ball(middle + size * ball.center, size * ball.radius)
    return None


def is_searchable(curve: Curve) -> bool:
    """Whether there are few enough ways in which the components of a curve in space can lie about a ball."""
    components = len(curve.mesh.component_sizes)
    places, lengths = _places(components)
    arcs = places * len(lengths)
    if components * arcs > TRIALS:
        return False
    return arcs * sum(1 << len(groups) for groups in _linked_groups(curve)) <= TRIALS


def _places(components: int) -> tuple[int, range]:
    """The number of places where arcs of a component begin and end, and lengths of arcs, from place to place."""
    places = max(int(1 / SHORTEST), 24 // components)
    return places, range(int(SHORTEST * places), places // 2 + 1)


def _linked_groups(curve: Curve) -> list[list[IntArray]]:
    """For each component, the groups of the others that lie on the same side of any sphere that meets only it.

    A sphere between two curves shows that they are not linked, so components with a linking number lie together.
    """
    count = len(curve.mesh.component_sizes)
    linked = np.zeros((count, count))
    linked[np.triu_indices(count, 1)] = linking_numbers(curve)
    found = []
    for cut in range(count):
        others = np.delete(np.arange(count), cut)
        groups, label = connected_components(linked[np.ix_(others, others)], directed=False)
        found.append([others[label == k] for k in range(groups)])
    return found


def _separating(points: FloatArray, sides: FloatArray) -> Iterator[Ball]:
    """Balls with much room between them and points, shape (n, 3), that are inside (−1) and outside (1), shape (m, n).

    Newton's method minimises the squared hinge loss ½ Σ (1 − s f)₊² over the functions f(x) = b·x + c |x|² + d of all
    rows. It ends after finitely many steps, as the loss is piecewise quadratic (Keerthi and DeCoste, J. Mach. Learn.
    Res. 6, 2005): without loss f separates, and otherwise the terms of a vanishing derivative are multipliers that
    prove that nothing does.
    """
    lifted = np.column_stack([points, (points**2).sum(axis=1), np.ones(len(points))])
    products = (lifted[:, :, None] * lifted[:, None]).reshape(len(points), -1)
    found, open_ = np.zeros((len(sides), 5)), np.arange(len(sides))
    for _ in range(60):  # of Newton's method: few arcs take more than 20
        short = 1.0 - sides[open_] * (found[open_] @ lifted.T)
        lack = np.maximum(short, 0.0)
        slope = -(sides[open_] * lack) @ lifted
        going = (lack.max(axis=1) > 1e-3) & (np.abs(slope).sum(axis=1) > _MARGIN * lack.sum(axis=1))
        open_, short, slope = open_[going], short[going], slope[going]
        if not len(open_):
            break
        hessian = ((short > 0.0) @ products).reshape(-1, 5, 5) + _MARGIN**2 * np.eye(5)
        step = -np.linalg.solve(hessian, slope[:, :, None])[:, :, 0]
        # for each row a step t that decreases the loss ½ |(short + t change)₊|² as its slope says (Armijo)
        change, fall = -sides[open_] * (step @ lifted.T), (slope * step).sum(axis=1)
        size, left = np.ones(len(short)), np.arange(len(short))
        loss = (np.maximum(short, 0.0) ** 2).sum(axis=1) * (1.0 + 1e-12)  # up to rounding
        while len(left):
            ahead = np.maximum(short[left] + size[left, None] * change[left], 0.0)
            left = left[(ahead**2).sum(axis=1) > loss[left] + 0.01 * size[left] * fall[left]]
            size[left] *= 0.5
        found[open_] += size[:, None] * step
    largest = np.abs(found).max(axis=1)
    separates = (sides * (found @ lifted.T)).min(axis=1) > _MARGIN * largest
    for *normal, bend, offset in found[separates & (np.abs(found[:, 3]) > _MARGIN * largest)]:
        center = -np.array(normal) / (2.0 * bend)
        yield Ball(center, float(np.sqrt(max(center @ center - offset / bend, 0.0))))


def _is_knotted(curve: Curve, ball: Ball) -> bool:
    """Whether the sphere cuts two edges, once each, and both parts, closed up, are knotted or linked."""
    inside = ball.contains(curve.vertices)
    mesh = curve.mesh
    first, last = inside[mesh.tails], inside[mesh.heads]
    cut = np.flatnonzero(first != last)
    if len(cut) != 2 or mesh.component[cut[0]] != mesh.component[cut[1]]:
        return False
    start, edge = curve.vertices[mesh.tails], curve.edge_vectors
    _, away = nearest_on_edges(curve, np.arange(mesh.edges), ball.center)
    if ((away < ball.radius) & ~first & ~last).any():
        return False
    entry, exit_ = cut if last[cut[0]] else cut[::-1]
    chord = []  # where both edges, each with one end inside, meet the sphere
    for k in (entry, exit_):
        begin, vector = start[k] - ball.center, edge[k]
        roots = np.roots([vector @ vector, 2.0 * begin @ vector, begin @ begin - ball.radius**2]).real
        chord.append(ball.center + begin + roots[np.argmin(np.abs(roots - 0.5))] * vector)
    # a path from the exit to the entry outside the ball, in the plane of a great circle
    v, u = ((point - ball.center) / ball.radius for point in chord)
    across = v - (u @ v) * u
    if np.linalg.norm(across) < _MARGIN:  # opposite ends: any great circle will do
        across = np.cross(u, np.eye(3)[np.argmin(np.abs(u))])
    across /= np.linalg.norm(across)
    angles = np.linspace(0.0, np.arccos(np.clip(u @ v, -1.0, 1.0)), 3)[:, None]  # two edges, of a right angle at most
    corners = ball.center + 1.5 * ball.radius * (np.cos(angles) * u + np.sin(angles) * across)
    path = np.concatenate([[chord[1]], corners, [chord[0]]])
    within = _part(curve, inside, int(mesh.heads[entry]), path)
    without = _part(curve, ~inside, int(mesh.heads[exit_]), np.array(chord))
    for part in (within, without):
        found, others = quick_invariants(part), len(part.components) - 1  # pairs with the first component come first
        if found.alexander[0] == TRIVIAL and not any(found.linking[:others]):
            return False
    return True


def _part(curve: Curve, chosen: BoolArray, begin: int, closing: FloatArray) -> Curve:
    """The arc of chosen vertices that begins at one of them, closed up, and then whole components that are chosen."""
    own = curve.mesh.slices[curve.mesh.component[begin]]
    ring = np.roll(np.arange(own.start, own.stop), own.start - begin)
    whole = [curve.vertices[part] for part in curve.mesh.slices if part != own and chosen[part].all()]
    return Curve.from_components([np.concatenate([curve.vertices[ring[chosen[ring]]], closing]), *whole])
