"""Drawings of links as figures, on sheets with captions, arrows and numbers; and where a rope presses on itself."""

import colorsys
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..base import CurveError, FloatArray
from ..base.arguments import check_options, documented, option
from ..curve import Curve, arc_lengths
from ..knots import Drawing
from .arcs import Arc, widest

INKS = ("#1c1c1c", "#c8402f", "#2f6db3", "#3c8d5a", "#d08c1d", "#8a4f9e")  # of components; then they begin again
COLOURS = ("component", "along", "black")
LINES = {"solid": (), "dashed": (4.0, 3.0), "dotted": (0.0, 2.5)}  # dashes and what is between them, in widths


@documented
@dataclass(frozen=True)
class Pen:
    """How figures are drawn.

    Raises
    ------
    OptionError
        If a value is not allowed.
    """

    size: float = option(100.0, "Size", "side of the square that each diagram fills, in points", low=0.0, high=1e4)
    width: float = option(2.0, "Width", "width of strands, in points, where there is room", low=1e-3, high=1e3)
    gap: float = option(1.5, "Gap", "space beside upper strands, in widths", low=0.0, high=100.0)
    colours: str = option("component", "Colours", "what has colours of its own", choices=COLOURS)
    line: str = option("solid", "Line", "what strands look like", choices=LINES)
    arrows: bool = option(False, "Arrows", "show orientations")
    numbers: bool = option(False, "Numbers", "number crossings in the order in which they are reached")
    columns: int | None = option(
        None,
        "Columns",
        "diagrams side by side",
        low=1,
        high=1000,
        automatic="as many as rows; all frames of a trajectory",
    )

    def __post_init__(self) -> None:
        check_options(self)


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


def figure(drawings: Sequence[Drawing], captions: Sequence[str] = (), pen: Pen = Pen()) -> Figure:
    """Draw drawings on a sheet, row by row, each with its caption, if any, below.

    Raises CurveError if there are none, or strands are too near to each other to be drawn.
    """
    if not drawings:
        raise CurveError("there is nothing to draw; give a curve, a code or a name")
    columns = min(pen.columns or math.ceil(math.sqrt(len(drawings))), len(drawings))
    margin, below = 0.06 * pen.size, 0.2 * pen.size if any(captions) else 0.0
    cell = np.array([pen.size + 2.0 * margin, pen.size + 2.0 * margin + below])
    rows = -(-len(drawings) // columns)
    sheet = Figure((columns * cell[0], rows * cell[1]), tuple(pen.width * each for each in LINES[pen.line]))
    for index, drawing in enumerate(drawings):
        row, column = divmod(index, columns)
        corner = np.array([column, rows - 1 - row]) * cell
        low, high = drawing.curve.vertices.min(axis=0), drawing.curve.vertices.max(axis=0)
        scale = (pen.size - pen.width) / max(high - low)
        middle = corner + np.array([0.5 * cell[0], below + margin + 0.5 * pen.size])
        points = (drawing.curve.vertices - 0.5 * (low + high)) * scale + middle
        placed = replace(drawing, curve=drawing.curve.with_vertices(points))
        width, arcs = widest(placed, pen.width, pen.gap)
        if not arcs:
            told = f" of drawing {index + 1}" if len(drawings) > 1 else ""
            raise CurveError(f"strands{told} are too near to each other to be drawn; try smaller gaps, or a layout")
        for arc in arcs:
            sheet.strokes.extend(_strokes(placed, arc, width, pen))
        if pen.arrows:
            sheet.heads.extend(_heads(placed, width, pen))
        if pen.numbers:
            sheet.labels.extend(_numbers(placed, arcs, pen))
        if any(captions):
            sheet.labels.append(
                Label((float(middle[0]), float(corner[1] + 0.45 * below)), captions[index], 0.5 * below)
            )
    return sheet


def _strokes(drawing: Drawing, arc: Arc, width: float, pen: Pen) -> Iterator[Stroke]:
    """An arc in its colour, or in pieces of many."""
    if pen.colours != "along":
        yield Stroke(arc.points, width, _ink(arc.component, pen))
        return
    length = float(drawing.curve.component_lengths[arc.component])
    inner = np.arange(*np.ceil(arc.along[[0, -1]] / length * 96.0)) * length / 96.0
    inner = inner[(inner > arc.along[0] + 0.1 * width) & (inner < arc.along[-1] - 0.1 * width)]
    marks = np.concatenate([arc.along[:1], inner, arc.along[-1:]])
    for a, b in pairwise(marks.tolist()):
        along = np.concatenate([[a], arc.along[(arc.along > a) & (arc.along < b)], [b]])
        points = np.stack([np.interp(along, arc.along, x) for x in arc.points.T], axis=1)
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
        yield Stroke(tip + shape @ [way, across], 0.0, _ink(k, pen))


def _numbers(drawing: Drawing, arcs: Sequence[Arc], pen: Pen) -> Iterator[Label]:
    """The number of each crossing, as near to it as strands, and numbers before, leave room."""
    height, taken = 0.07 * pen.size, [arc.points for arc in arcs]
    angles = 2.0 * np.pi * np.arange(24) / 24
    around = np.concatenate([r * height * np.column_stack([np.cos(angles), np.sin(angles)]) for r in (1.0, 1.3, 1.7)])
    for index, place in enumerate(drawing.crossings, start=1):
        free = np.minimum(cKDTree(np.concatenate(taken)).query(place + around)[0], 0.8 * height)
        here = place + around[int(free.argmax())]
        taken.append(here + 0.5 * height * np.array([[-0.5, 0.0], [0.0, 0.0], [0.5, 0.0]]))
        yield Label((float(here[0]), float(here[1])), str(index), height)


def _ink(component: int, pen: Pen) -> str:
    return INKS[0 if pen.colours == "black" else component % len(INKS)]


def contact_map(curve: Curve, struts: Sequence[tuple[int, int, float]]) -> Figure:
    """A dot, whose area is the force, for each two edges that press on each other, by their places along the rope.

    Both axes run along all components, with lines where one begins.  Each contact is there twice, by either edge first.
    """
    size, margin = 360.0, 12.0  # points
    ends = np.cumsum(curve.edge_lengths)
    place = margin + (ends - 0.5 * curve.edge_lengths) * (size / ends[-1])
    starts = np.append(0.0, np.cumsum(curve.component_lengths)) * (size / ends[-1]) + margin
    low, high = margin, margin + size
    figure = Figure((size + 2.0 * margin,) * 2, ())
    for x in starts:
        for line in ([[x, low], [x, high]], [[low, x], [high, x]]):
            figure.strokes.append(Stroke(np.array(line), 0.6, "#8c8c8c"))
    largest = max((force for *_, force in struts), default=1.0)
    dot = np.array([[-0.005, 0.0], [0.005, 0.0]])  # with round ends
    for edge, other, force in struts:
        for x, y in pairwise((place[edge], place[other], place[edge])):
            figure.strokes.append(Stroke(dot + np.array([x, y]), 5.0 * (force / largest) ** 0.5, "#1f4e8c"))
    return figure


def contact_forces(curve: Curve, struts: Sequence[tuple[int, int, float]], radius: float) -> FloatArray:
    """Force per length that presses on the rope at each vertex, relative to its tension over its radius; (n,)."""
    forces = np.zeros(len(curve.edge_lengths))
    for *edges, force in struts:
        forces[edges] += radius * force
    at_ends = np.stack([curve.mesh.tails, curve.mesh.heads])
    pressing, lengths = (np.bincount(at_ends.ravel(), np.tile(x, 2), len(curve)) for x in (forces, curve.edge_lengths))
    return np.asarray(pressing / lengths)
