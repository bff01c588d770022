"""The curve to be relaxed, the obstacles and pins that stand still meanwhile, and units for all.

The program's own units are similar to the user's: components are about 2π long in them.
"""

import logging
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from operator import itemgetter

import numpy as np

from ..base import VERTEX, CurveError, CurveOptionError, FloatArray, Message, OptionError, checked_fields, frozen
from ..collision import check_clear, check_embedded, check_gap, survives_rounding, written
from ..curve import MAX_COORDINATE, NO_PINS, Curve, Obstacle, Pins, at_vertices, refine

_log = logging.getLogger(__name__)


def check_units(curve: Curve) -> None:
    """Raise a CurveError if coordinates are so large, or the curve so small, that powers of lengths fail."""
    sizes = np.abs(curve.vertices).max(axis=1)
    k = int(sizes.argmax())
    if sizes[k] > MAX_COORDINATE:
        vertex, place = Message(VERTEX, number=k + 1), written(curve.vertices[k])
        far = "{vertex}, {place}, has a coordinate beyond {largest:g}; use a larger unit of length"
        raise CurveError(Message(far, vertex=vertex, place=place, largest=MAX_COORDINATE), at_vertices(curve, k))
    width = float(np.ptp(curve.vertices, axis=0).max())
    if 0 < width < 1 / MAX_COORDINATE:
        small = "the curve is only {width:.3g} wide, less than {least:g}; use a smaller unit of length"
        raise CurveError(Message(small, width=width, least=1 / MAX_COORDINATE))


def centred(curve: Curve) -> Curve:
    """The same polygon around the origin, since midpoints far away from it lose digits."""
    return curve.with_vertices(curve.vertices - _centre(curve))


def _centre(curve: Curve) -> FloatArray:
    return np.asarray(0.5 * (curve.vertices.min(axis=0) + curve.vertices.max(axis=0)))


@dataclass(frozen=True, eq=False)
class Units:
    """x_user = offset + scale · x, with ``scale`` a power of two so that only the shift rounds."""

    offset: FloatArray
    scale: float

    @classmethod
    def of(cls, curve: Curve) -> "Units":
        """Units that centre the curve and make its mean component 4 to 8 long."""
        exponent = np.frexp(curve.length / len(curve.mesh.component_sizes))[1] - 3
        return cls(_centre(curve), float(np.ldexp(1.0, exponent)))

    def from_user(self, vertices: FloatArray) -> FloatArray:
        """Vertices in the program's units; shape (n, m)."""
        return np.asarray((vertices - self.offset) / self.scale)

    def obstacle_from_user(self, obstacle: Obstacle) -> Obstacle:
        """An obstacle in the program's units; a CurveError if it is too large, or too far away, for the curve."""
        vertices = self.from_user(obstacle.vertices)
        reach = float(np.abs(vertices).max())
        if reach > 1e12:  # beyond it, their repulsion is lost in the rounding of their corners
            far = "{obstacle} reaches some {reach:.0e} times the curve's length; cut off distant parts, or leave it out"
            raise CurveError(Message(far, obstacle=obstacle.title, reach=reach))
        return Obstacle(vertices, obstacle.faces, obstacle.name)

    def to_user(self, vertices: FloatArray) -> FloatArray:
        """Vertices in the user's units, rounded to the doubles that are proved and written, read-only; shape (n, m)."""
        return frozen(np.asarray(self.offset + self.scale * vertices))


@checked_fields
@dataclass(frozen=True, eq=False, kw_only=True)
class Task:
    """A curve among obstacles, some of whose vertices are pinned.

    Raises OptionError if a pin is not a vertex of the curve or is named twice.
    """

    curve: Curve  #: an embedded polygon, in any units and place
    obstacles: tuple[Obstacle, ...] = ()  #: surfaces and polylines, in the curve's units, that it must never touch
    #: Indices, from 0, of vertices that stay exactly where they are.  Nothing can move on an arc that is straight from
    #: one of them to the next.
    pins: tuple[int, ...] = ()
    pin_tangents: bool = False  #: whether the neighbours of pins in the refined curve, and so its direction, are pinned

    def __post_init__(self) -> None:
        walls = {wall.key: wall for wall in self.obstacles}  # one that is given twice would repel twice
        object.__setattr__(self, "obstacles", tuple(walls.values()))
        object.__setattr__(self, "pins", tuple(map(int, self.pins)))
        pin, times = max(Counter(self.pins).items(), key=itemgetter(1), default=(0, 0))
        if times > 1:
            raise OptionError(f"pins names vertex {pin + 1} more than once")
        outside = next((pin for pin in self.pins if not 0 <= pin < len(self.curve)), None)
        if outside is not None:
            raise CurveOptionError(f"pins asks for vertex {outside + 1}, but the curve has {len(self.curve)} vertices")
        if self.pin_tangents and not self.pins:
            raise OptionError("pin_tangents pins the neighbours of pins, but there are none; give pins too")

    @classmethod
    def of(cls, given: "Task | Curve") -> "Task":
        """The task itself, or the task of a curve with nothing around it."""
        return given if isinstance(given, Task) else cls(curve=given)

    @property
    def held(self) -> Pins:
        """The pins, and the vertices of taut arcs between them."""
        return Pins.of(self.curve, np.array(self.pins, dtype=np.intp)) if self.pins else NO_PINS

    def refined(self, vertices: int | None = None) -> "Task":
        """The same task with vertices inserted on the edges, as `refine` does, and all that is held among its pins.

        A CurveError if the curve touches itself or an obstacle, is degenerate or has strands too near to compute with.
        """
        check_units(self.curve)
        check_embedded(self.curve)
        check_clear(self.curve, self.obstacles)
        start = refine(self.curve, vertices)
        check_refined(self.curve, start, self.obstacles)
        pins = Pins.at(start, self.curve.vertices[list(self.pins)]) if self.pins else NO_PINS
        if len(pins) > len(self.pins):
            more = len(pins) - len(self.pins)
            _log.warning("%d of %d vertices are on straight arcs between pins, and held as well", more, len(start))
        if self.pin_tangents:
            pins = pins.with_neighbours(start)
        return Task(curve=start, obstacles=self.obstacles, pins=tuple(pins.vertices.tolist()))


def check_refined(curve: Curve, refined: Curve, obstacles: Sequence[Obstacle]) -> None:
    """Refuse a refined curve that is no longer the same curve, or that cannot be computed with.

    Raises CurveError if strands are too near to compute with, or the new vertices, rounded to doubles, might not be
    near enough to their edges.
    """
    if len(refined) > len(curve) and not survives_rounding(refined, obstacles):
        digits = (
            "the curve is too far from the origin, or its strands are too close, to be refined in double precision; "
            "move it closer to the origin, or its strands apart"
        )
        raise CurveError(Message(digits))
    check_gap(refined)
