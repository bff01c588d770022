"""Link diagrams as figures: views of curves or layouts of diagrams, with gaps where strands pass under others."""

import colorsys
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..base import CurveError, FloatArray, check_known, checked_fields, number
from ..collision import check_embedded
from ..curve import Curve, arc_lengths
from ..knots.diagrams.projection import plane_crossings, project, rotation
from ..knots.drawings import Drawing
from ..knots.inscribed import rounded
from ..knots.layout import upright

INKS = ("#1c1c1c", "#c8402f", "#2f6db3", "#3c8d5a", "#d08c1d", "#8a4f9e")  # of components; then they begin again
COLOURS = ("component", "along", "black")
LINES = {"solid": (), "dashed": (4.0, 3.0), "dotted": (0.0, 2.5)}  # dashes and what is between them, in widths


@checked_fields
@dataclass(frozen=True)
class Pen:
    """How figures are drawn; lengths in points.

    Parameters
    ----------
    size
        Side of the square that each diagram fills.
    width
        Width of strands, which are thinner where they would come too near to each other.
    gap
        Space beside upper strands, in widths.
    colours
        ``component``, ``along`` each component, or ``black``.
    line
        ``solid``, ``dashed`` or ``dotted``.
    arrows
        Whether arrows show orientations.
    numbers
        Whether crossings are numbered, in the order in which they are reached.
    columns
        Of a figure of several diagrams.
    """

    size: float = number(100.0, most=10_000.0)
    width: float = number(2.0, most=1_000.0)
    gap: float = number(1.5, most=100.0)
    colours: str = "component"
    line: str = "solid"
    arrows: bool = False
    numbers: bool = False
    columns: int | None = None

    def __post_init__(self) -> None:
        check_known("colours", self.colours, COLOURS)
        check_known("line", self.line, LINES)
        if self.columns is not None and not 0 < self.columns <= 1000:
            raise CurveError(f"columns is {self.columns}; give 1 to 1000")


class Stroke(NamedTuple):
    """A smooth line with round ends through points, shape (k, 2); closed if the last point is the first."""

    points: FloatArray
    width: float
    colour: str

    @property
    def controls(self) -> FloatArray:
        """Control points of cubic Bézier curves through the points, shape (3 k − 2, 2) (Catmull and Rom 1974)."""
        p, found = self.points, np.empty((3 * len(self.points) - 2, 2))
        before, after = (p[-2], p[1]) if (p[0] == p[-1]).all() else (2.0 * p[0] - p[1], 2.0 * p[-1] - p[-2])
        steps = np.diff(p, axis=0, prepend=before[None], append=after[None])
        spans = np.linalg.norm(steps, axis=1)[:, None]
        unit = steps / spans
        velocity = (unit[:-1] * spans[1:] + unit[1:] * spans[:-1]) / (spans[:-1] + spans[1:])
        third = spans[1:-1] / 3.0
        found[::3], found[1::3], found[2::3] = p, p[:-1] + third * velocity[:-1], p[1:] - third * velocity[1:]
        return found


class Label(NamedTuple):
    """A text around a place; what stands between an underscore and the next sign that is no digit is a subscript."""

    place: tuple[float, float]
    text: str
    height: float


@dataclass(frozen=True, eq=False)
class Figure:
    """Strokes, filled arrowheads and texts on a sheet of a size in points, from its lower left corner."""

    size: tuple[float, float]
    dashes: tuple[float, ...]
    strokes: list[Stroke] = field(default_factory=list)
    heads: list[Stroke] = field(default_factory=list)
    labels: list[Label] = field(default_factory=list)


class Strand(NamedTuple):
    """A part of a drawing between two gaps, or a whole component."""

    component: int
    points: FloatArray
    along: FloatArray  # distance from where the component begins


def seen(curves: Sequence[Curve], trials: int = 200, seed: int = 20231) -> list[Drawing]:
    """Curves as seen from where the fewest strands cross in all of them, and of these where they are best apart.

    Corners are rounded first, by motions proved free of contact.  Raises CurveError for curves that are not in space or
    the plane, have more than 20,000 vertices, or touch themselves.
    """
    for curve in curves:
        if curve.dimension > 3 or len(curve) > 20_000:
            told = f"has dimension {curve.dimension}" if curve.dimension > 3 else f"has {len(curve)} vertices"
            raise CurveError(f"the curve {told}; drawings are of curves in space of at most 20000 vertices")
        check_embedded(curve)
    smooth = [rounded(Curve(np.pad(each.vertices, ((0, 0), (0, 3 - each.dimension))), each.mesh)) for each in curves]
    middles = [each.vertices - each.vertices.mean(axis=0) for each in smooth]
    rng, found = np.random.default_rng(seed), list[list[Drawing]]()
    # turned by about 0.02 radians, so that nothing special is seen
    flattest = np.linalg.svd(np.concatenate(middles), full_matrices=False)[2] + 0.02 * rng.normal(size=(3, 3))
    fewer = max(5, min(trials, 100_000 // sum(map(len, smooth))))
    for frame in (flattest, *rng.normal(size=(fewer, 3, 3))):
        drawings = []
        for curve, middle in zip(smooth, middles, strict=True):
            points, mesh = middle @ rotation(frame), curve.mesh
            view = project(mesh, points, plane_crossings(mesh, points, 1e-9), mesh.ends.ravel(), 1e-9)
            if view is None:
                break
            passes = (mesh.tails[view.crossings.edges] + view.crossings.at).T
            order = np.argsort(passes[:, 0])
            over = (view.heights[0] > view.heights[1])[order]
            drawings.append(Drawing(Curve(points[:, :2], mesh), passes[order], over))
        else:
            found.append(drawings)
    if not found:
        raise CurveError("strands touch, or nearly do: no view of the curve shows which one is in front")

    def crossings(drawings: list[Drawing]) -> int:
        return sum(len(each.passes) for each in drawings)

    def merit(drawings: list[Drawing]) -> tuple[float, int, float]:
        least = room(drawings)
        return min(least, 0.02), -crossings(drawings), least  # thinner strands than 2 % are worse than more crossings

    best = max(sorted(found, key=crossings)[:20], key=merit)
    turn = upright(np.concatenate([each.curve.vertices for each in best]))
    return [replace(each, curve=each.curve.with_vertices(each.curve.vertices @ turn)) for each in best]


def room(drawings: Sequence[Drawing]) -> float:
    """The width of the widest strands with which drawings can be drawn, relative to their size, at most 1/12."""
    sizes = [float(np.ptp(each.curve.vertices, axis=0).max()) for each in drawings]
    return min(widest(each, size / 12.0, 1.5)[0] / size for each, size in zip(drawings, sizes, strict=True))


def widest(drawing: Drawing, width: float, gap: float) -> tuple[float, list[Strand]]:
    """The strands of a drawing, and their width: the given one, or less where they would be too near to each other.

    The width is 0, and there are no strands, where it would be less than a thousandth of the drawing's size.
    """
    least = 1e-3 * float(np.ptp(drawing.curve.vertices, axis=0).max())
    while (strands := gaps_cut(drawing, width, gap)) is None:
        width *= 0.85
        if width < least:
            return 0.0, []
    return width, strands


def gaps_cut(drawing: Drawing, width: float, gap: float) -> list[Strand] | None:
    """The strands of a drawing, with gaps at passes below; None if any two would be less than 0.8 gaps apart."""
    mesh, need, reach = drawing.curve.mesh, width * (1.0 + gap), np.linspace(0.0, 1.0, 161) * 8.0 * width * (1.0 + gap)
    lines = [
        np.concatenate([part, part[:1]]) if closed else part
        for part, closed in zip(drawing.curve.components, mesh.closed, strict=True)
    ]
    arcs = [arc_lengths(line) for line in lines]

    def points(k: int, at: FloatArray) -> FloatArray:
        at = at % arcs[k][-1] if mesh.closed[k] else at
        return np.stack([np.interp(at, arcs[k], x) for x in lines[k].T], axis=1)

    def located(at: float) -> tuple[int, float]:
        k = int(mesh.component[int(at)])
        return k, float(np.interp(at - mesh.offsets[k], np.arange(len(arcs[k])), arcs[k]))

    cuts: list[list[tuple[float, float]]] = [[] for _ in lines]
    for (first, second), first_over in zip(drawing.passes.tolist(), drawing.first_over.tolist(), strict=True):
        (k, below), (upper, above) = map(located, (second, first) if first_over else (first, second))
        tree = cKDTree(points(upper, above + np.concatenate([-reach[:0:-1], reach])))
        clear = [tree.query(points(k, below + way * reach))[0] >= need for way in (-1.0, 1.0)]
        if not (clear[0].any() and clear[1].any()):
            return None
        cuts[k].append((below - reach[clear[0].argmax()], below + reach[clear[1].argmax()]))
    strands: list[Strand] = []
    for k, arc in enumerate(arcs):
        whole, own = arc, sorted(cuts[k])
        if mesh.closed[k]:
            whole = np.concatenate([arc[:-1], arc + arc[-1]])
            again = [(before + arc[-1], after) for before, after in own[:1]]
            spans = [(a, b) for (_, a), (b, _) in pairwise([*own, *again])] or [(0.0, arc[-1])]
        else:
            marks = [0.0, *(end for cut in own for end in cut), arc[-1]]
            spans = list(zip(marks[::2], marks[1::2], strict=True))
        near = 0.3 * arc[-1] / len(arc)  # vertices nearer than this to an end are left out
        for a, b in spans:
            if b - a < 1.5 * width:  # a dot, rather than a strand
                return None
            along = np.concatenate([[a], whole[(whole > a + near) & (whole < b - near)], [b]])
            strands.append(Strand(k, points(k, along), along))
    fine = [np.linspace(each.along[0], each.along[-1], 2 + int(2.0 * np.ptp(each.along) / width)) for each in strands]
    owner = np.repeat(np.arange(len(strands)), [len(at) for at in fine])
    places = np.concatenate([points(each.component, at) for each, at in zip(strands, fine, strict=True)])
    least = width * (1.0 + 0.8 * gap)
    i, j = cKDTree(places).query_pairs(least, output_type="ndarray").T
    at = np.concatenate(fine)
    apart = np.abs(at[i] - at[j])
    loops = np.array([arcs[each.component][-1] if mesh.closed[each.component] else math.inf for each in strands])
    apart = np.minimum(apart, loops[owner[i]] - apart)
    return None if ((owner[i] != owner[j]) | (apart > 3.0 * least)).any() else strands


def figure(drawings: Sequence[Drawing], captions: Sequence[str] = (), pen: Pen = Pen(), alike: bool = False) -> Figure:
    """Draw drawings on a sheet, row by row, each with its caption, if any, below; ``alike``: on one scale.

    Raises CurveError if there are none, or strands are too near to each other to be drawn.
    """
    if not drawings:
        raise CurveError("there is nothing to draw; give a curve, a code or a name")
    columns = min(pen.columns or math.ceil(math.sqrt(len(drawings))), len(drawings))
    margin, below = 0.06 * pen.size, 0.2 * pen.size if any(captions) else 0.0
    cell = np.array([pen.size + 2.0 * margin, pen.size + 2.0 * margin + below])
    rows = -(-len(drawings) // columns)
    sheet = Figure((columns * cell[0], rows * cell[1]), tuple(pen.width * each for each in LINES[pen.line]))
    sizes = [float(np.ptp(each.curve.vertices, axis=0).max()) for each in drawings]
    for index, (drawing, size) in enumerate(zip(drawings, sizes, strict=True)):
        row, column = divmod(index, columns)
        corner = np.array([column, rows - 1 - row]) * cell
        low, high = drawing.curve.vertices.min(axis=0), drawing.curve.vertices.max(axis=0)
        scale = (pen.size - pen.width) / (max(sizes) if alike else size)
        middle = corner + np.array([0.5 * cell[0], below + margin + 0.5 * pen.size])
        points = (drawing.curve.vertices - 0.5 * (low + high)) * scale + middle
        placed = replace(drawing, curve=drawing.curve.with_vertices(points))
        width, strands = widest(placed, pen.width, pen.gap)
        if not strands:
            told = f" of {captions[index]}" if any(captions) else ""
            raise CurveError(f"strands{told} are too near to each other to be drawn; draw the diagram with --layout")
        for strand in strands:
            sheet.strokes.extend(_strokes(placed, strand, width, pen))
        if pen.arrows:
            sheet.heads.extend(_heads(placed, width, pen))
        if pen.numbers:
            sheet.labels.extend(_numbers(placed, strands, pen))
        if any(captions):
            sheet.labels.append(
                Label((float(middle[0]), float(corner[1] + 0.45 * below)), captions[index], 0.5 * below)
            )
    return sheet


def _strokes(drawing: Drawing, strand: Strand, width: float, pen: Pen) -> Iterator[Stroke]:
    """A strand in its colour, or in pieces of many."""
    if pen.colours != "along":
        single = pen.colours == "black" or len(drawing.curve.components) == 1
        yield Stroke(strand.points, width, INKS[0 if single else strand.component % len(INKS)])
        return
    length = float(drawing.curve.component_lengths[strand.component])
    inner = np.arange(*np.ceil(strand.along[[0, -1]] / length * 96.0)) * length / 96.0
    inner = inner[(inner > strand.along[0] + 0.1 * width) & (inner < strand.along[-1] - 0.1 * width)]
    marks = np.concatenate([strand.along[:1], inner, strand.along[-1:]])
    for a, b in pairwise(marks.tolist()):
        along = np.concatenate([[a], strand.along[(strand.along > a) & (strand.along < b)], [b]])
        points = np.stack([np.interp(along, strand.along, x) for x in strand.points.T], axis=1)
        tone = colorsys.hls_to_rgb(0.5 * (a + b) / length % 1.0, 0.42, 0.75)
        yield Stroke(points, width, "#" + "".join(f"{round(255 * each):02x}" for each in tone))


def _heads(drawing: Drawing, width: float, pen: Pen) -> Iterator[Stroke]:
    """An arrowhead on each component, in the middle of its longest stretch without crossings."""
    mesh = drawing.curve.mesh
    for k, (part, closed) in enumerate(zip(drawing.curve.components, mesh.closed, strict=True)):
        line = np.concatenate([part, part[:1]]) if closed else part
        arc, own = arc_lengths(line), mesh.slices[k]
        passes = drawing.passes[(drawing.passes >= own.start) & (drawing.passes < own.stop)] - own.start
        at = np.sort(np.interp(passes, np.arange(len(arc)), arc))
        marks = np.array([at[-1] - arc[-1], *at] if closed and len(at) else [0.0, *at, arc[-1]])
        longest = int(np.diff(marks).argmax())
        middle = 0.5 * (marks[longest] + marks[longest + 1]) + width * np.array([-0.5, 0.0, 0.5])
        back, tip, ahead = (np.array([np.interp(s % arc[-1], arc, x) for x in line.T]) for s in middle)
        way = (ahead - back) / np.linalg.norm(ahead - back)
        across = np.array([-way[1], way[0]])
        shape = np.array([[2.6, 0.0], [-2.0, 2.2], [-1.0, 0.0], [-2.0, -2.2]]) * width
        single = pen.colours == "black" or len(drawing.curve.components) == 1
        yield Stroke(tip + shape @ [way, across], 0.0, INKS[0 if single else k % len(INKS)])


def _numbers(drawing: Drawing, strands: Sequence[Strand], pen: Pen) -> Iterator[Label]:
    """The number of each crossing, as near to it as strands, and numbers before, leave room."""
    height, taken = 0.07 * pen.size, [strand.points for strand in strands]
    angles = 2.0 * np.pi * np.arange(24) / 24
    around = np.concatenate([r * height * np.column_stack([np.cos(angles), np.sin(angles)]) for r in (1.0, 1.3, 1.7)])
    for index, place in enumerate(drawing.crossings, start=1):
        free = np.minimum(cKDTree(np.concatenate(taken)).query(place + around)[0], 0.8 * height)
        here = place + around[int(free.argmax())]
        taken.append(here + 0.5 * height * np.array([[-0.5, 0.0], [0.0, 0.0], [0.5, 0.0]]))
        yield Label((float(here[0]), float(here[1])), str(index), height)
