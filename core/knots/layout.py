"""A smooth drawing of a link diagram: charged elastic strands, pinned together at crossings, come to rest in the plane.

With a parameter s along the strands, their energy is ½ ∫ |x′|² + 0.15 ∫ |x″|² + ∬ |x(s) − x(t)|⁻⁴ over pairs of points
round the same face.  It falls from the drawing on a grid, in the metric of the first two terms; where it has come to
rest is taken if the diagram has stayed: edges cross nowhere, and come to crossings in the same order round.  Lengths in
the parameter are the grid's at first, then equal for all edges, which lets the drawing find its symmetry, and in the
end those of the drawing itself, as if strands were rods under even tension.
"""

from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

from ..base import CurveError, FloatArray, IntArray
from ..curve import Curve, arc_lengths
from ..curve.refine import at_shares
from .diagrams import Diagram
from .diagrams.projection import plane_crossings
from .drawings import Drawing
from .planar import grid_drawing

MAX_CROSSINGS = 200  # of a diagram that is laid out: half a minute


def laid_out(diagram: Diagram) -> Drawing:
    """Draw a diagram as smooth closed curves, its parts that no crossing joins side by side, strands about 1 apart.

    Vertices lie at all crossings.  Raises CurveError for more than `MAX_CROSSINGS`, and if nothing is there to draw.
    """
    if diagram.crossings > MAX_CROSSINGS:
        raise CurveError(f"the diagram has {diagram.crossings} crossings; at most {MAX_CROSSINGS} can be laid out")
    if not diagram.passes:
        raise CurveError("the diagram is empty; give one with at least one component")
    parts: list[FloatArray] = []
    lower, upper, right, count = list[int](), list[int](), 0.0, 0
    for piece in diagram.pieces():
        if piece.crossings:
            points, edges = relaxed(piece)
            fine = [at_shares(points[edge], False, np.linspace(0.0, 1.0, 4 * len(edge))) for edge in edges]
            points = points @ upright(np.concatenate(fine))
        else:
            angle = 2.0 * np.pi * np.arange(48) / 48
            points, edges = np.column_stack([np.cos(angle), np.sin(angle)]), [np.arange(49) % 48]
        points = points + np.array([right - points[:, 0].min(), -0.5 * (points[:, 1].min() + points[:, 1].max())])
        right = 1.0 + float(points[:, 0].max())
        sizes = np.array([len(edge) - 1 for edge in edges])
        starts = count + np.cumsum(sizes) - sizes
        lower.extend(int(starts[low]) for low, _ in piece.levels)
        upper.extend(int(starts[high]) for _, high in piece.levels)
        rest = iter(edges)
        parts.extend(points[np.concatenate([next(rest)[:-1] for _ in part or [()]])] for part in piece.passes)
        count += int(sizes.sum())
    passes = np.column_stack([lower, upper]).reshape(-1, 2)
    order = np.argsort(passes.min(axis=1))  # the order in which they are reached
    over = passes.argmax(axis=1) == 0
    return Drawing(Curve.from_components(parts), np.sort(passes, axis=1)[order].astype(float), over[order])


def relaxed(piece: Diagram) -> tuple[FloatArray, list[IntArray]]:
    """Places of the crossings of a connected diagram, and then of other vertices; and the vertices on each edge."""
    grid = grid_drawing(piece)
    paths = [np.concatenate([path, grid[after][:1]]) for path, after in zip(grid, piece.next, strict=True)]
    on_grid = np.array([arc_lengths(path)[-1] for path in paths])
    for power, tolerance in ((1.0, 1e-2), (0.5, 1e-2), (0.0, 1e-6), (None, 1e-6), (None, 1e-6)):
        if power is not None:
            spans = on_grid**power
            pieces = np.maximum(10, np.round(3.0 * on_grid))  # finer than the strands of the grid are apart
        else:
            spans = np.array([arc_lengths(path)[-1] for path in paths])
            pieces = np.maximum(6, np.round(12.0 * spans / spans.mean()))
        new = np.split(np.arange(int(pieces.sum()) - len(pieces)), np.cumsum(pieces.astype(np.intp) - 1)[:-1])
        edges = [
            np.concatenate([[crossing], piece.crossings + inner, [piece.sequence[after][0]]])
            for (crossing, _), inner, after in zip(piece.sequence, new, piece.next, strict=True)
        ]
        x = np.empty((piece.crossings + sum(map(len, new)), 2))
        for edge, path in zip(edges, paths, strict=True):
            x[edge] = at_shares(path, False, np.linspace(0.0, 1.0, len(edge)))
        if sum(sum(pieces[dart // 2] for dart in face) ** 2 for face in piece.faces) > 4e6:
            break  # pairs of vertices: where faces have hundreds of edges, strands stay on the grid
        moved = at_rest(charged(piece, edges, spans / spans.mean()), x, tolerance)
        # it is a drawing if edges cross nowhere, and come to crossings in the order of the diagram
        rest = iter(edges)
        curve = Curve.from_components([moved[np.concatenate([next(rest)[:-1] for _ in p])] for p in piece.passes])
        around = np.array([[edges[dart // 2][-2 if dart % 2 else 1] for dart in darts] for darts in piece.darts])
        leave = moved[around] - moved[: len(around), None]
        angles = np.arctan2(leave[..., 1], leave[..., 0])
        turns = (np.roll(angles, -1, axis=1) - angles) % (2.0 * np.pi)
        crossed = plane_crossings(curve.mesh, curve.vertices, -1e-6).turn  # but for ends, which meet at crossings
        if len(crossed) or turns.sum(axis=1).max() >= 6.5 or turns.min() <= 0.1:
            break
        x, paths = moved, [moved[edge] for edge in edges]
    return x, edges


class ChargedStrands(NamedTuple):
    """The energy of strands x, shape (n, 2): ½ x·A x + Σ w |xᵢ − xⱼ|⁻⁴."""

    elastic: Any  # A, sparse
    mass: FloatArray  # parameter length at each vertex
    pairs: IntArray  # i and j, shape (2, k)

    def energy(self, x: FloatArray) -> float:
        (i, j), mass = self.pairs, self.mass
        repulsion = mass[i] * mass[j] * np.square(x[i] - x[j]).sum(axis=1) ** -2
        return float(0.5 * np.sum(x * (self.elastic @ x)) + repulsion.sum())

    def derivative(self, x: FloatArray) -> FloatArray:
        (i, j), mass = self.pairs, self.mass
        apart = x[i] - x[j]
        force = (-4.0 * mass[i] * mass[j] * np.square(apart).sum(axis=1) ** -3)[:, None] * apart
        push = [np.bincount(i, f, len(x)) - np.bincount(j, f, len(x)) for f in force.T]
        return np.asarray(self.elastic @ x + np.column_stack(push))


def charged(piece: Diagram, edges: list[IntArray], spans: FloatArray) -> ChargedStrands:
    """The strands of a connected diagram with these vertices, and lengths in the parameter, on each of its edges."""
    sizes = np.array([len(edge) - 1 for edge in edges])
    ends = np.cumsum(sizes)
    step, count = np.repeat(spans / sizes, sizes), piece.crossings + int((sizes - 1).sum())
    tails, heads = (np.concatenate([edge[part] for edge in edges]) for part in (slice(None, -1), slice(1, None)))
    after = np.arange(len(tails)) + 1
    after[ends - 1] = (ends - sizes)[piece.next]
    between = 0.5 * (step + step[after])
    rows = np.arange(len(tails))
    entries = np.concatenate([1.0 / step, -1.0 / step])
    slope = sp.coo_array((entries, (np.tile(rows, 2), np.concatenate([heads, tails]))), (len(rows), count)).tocsr()
    bend = sp.diags_array(1.0 / between) @ (slope[after] - slope)
    elastic = slope.T @ sp.diags_array(step) @ slope + 0.3 * bend.T @ sp.diags_array(between) @ bend
    mass = np.asarray(0.5 * (np.bincount(tails, step) + np.bincount(heads, step)), dtype=np.float64)
    mass[: piece.crossings] *= 0.5  # which are on two strands, but one place
    pairs = []  # of vertices round each face that are not next to each other
    for face in piece.faces:
        ways = [(edges[dart // 2][:: -1 if dart % 2 else 1], spans[dart // 2]) for dart in face]
        walk = np.concatenate([way[:-1] for way, _ in ways])
        at = np.cumsum(np.concatenate([np.full(len(way) - 1, span / (len(way) - 1)) for way, span in ways]))
        i, j = np.triu_indices(len(walk), 1)
        apart = at[j] - at[i]
        far = np.minimum(apart, at[-1] - apart) > 0.16
        pairs.append(np.stack([walk[i], walk[j]])[:, far & (walk[i] != walk[j])])
    return ChargedStrands(elastic, mass, np.concatenate(pairs, axis=1))


def at_rest(strands: ChargedStrands, x: FloatArray, tolerance: float) -> FloatArray:
    """Let the energy fall until the square of its derivative is a part ``tolerance`` of it."""
    energy, solve = strands.energy, splu((strands.elastic + 0.01 * sp.diags_array(strands.mass)).tocsc()).solve
    stretch = 0.5 * float(np.sum(x * (strands.elastic @ x)))
    x = x * (2.0 * (energy(x) - stretch) / stretch) ** (1.0 / 6.0)  # the best scale
    value, size, way, last, before = energy(x), 0.1, np.zeros_like(x), np.zeros_like(x), 1.0
    for _ in range(1000):  # conjugate gradients (Polak and Ribière 1969)
        derivative = strands.derivative(x)
        steepest = -solve(derivative)
        norm = -float(np.sum(derivative * steepest))
        if norm < tolerance * value:
            break
        way = steepest + max(0.0, (norm + float(np.sum(derivative * last))) / before) * way
        if -np.sum(derivative * way) < 0.1 * norm:
            way = steepest
        last, before, fall, reach = steepest, norm, float(np.sum(derivative * way)), float(np.abs(way).max())
        while size * reach > 0.3 or not (lower := energy(trial := x + size * way)) <= value + 1e-4 * size * fall:
            size *= 0.5
            if size < 1e-9:
                return x
        x, value, size = trial, lower, min(1.7 * size, 1.0)
    return x


def upright(outline: FloatArray) -> FloatArray:
    """The rotation, for rows of points, after which a drawing's best axis of symmetry stands, its heavier end below.

    ``outline`` are points on the drawing, shape (n, 2), dense and about as far apart everywhere.
    """
    middle = outline - outline.mean(axis=0)
    tree, few = cKDTree(middle), middle[:: max(1, len(middle) // 300)]

    def miss(angle: float) -> float:
        """How far the points are from their mirror images in the axis at an angle: the mean square."""
        axis = np.array([np.cos(angle), np.sin(angle)])
        return float(np.square(tree.query(few @ (2.0 * np.outer(axis, axis) - np.eye(2)))[0]).mean())

    angle = 0.0
    for steps in (np.linspace(0.0, np.pi, 90, endpoint=False), np.linspace(-0.035, 0.035, 29)):
        angle = min((angle + step for step in steps.tolist()), key=miss)
    c, s = np.sin(angle), np.cos(angle)
    turn = np.array([[c, s], [-s, c]])
    height = (middle @ turn)[:, 1]
    return -turn if height.min() + height.max() < 0.0 else turn
