"""The directions from which to look at a curve: those where moves of its diagram lead to the fewest crossings.

A knot that is stuck in one view comes apart in another: with level heights, two dozen views from the side were enough.
"""

from collections.abc import Iterable, Iterator
from itertools import chain

import numpy as np

from ..curve import Curve
from ..curve.pins import NOWHERE
from ..deadline import check_time
from ..diagrams.diagram import Diagram
from ..diagrams.projection import rotation
from ..diagrams.rerouting import factors, is_least, simplified
from ..types import FloatArray
from .drawing import Drawing, combed
from .moving import MovingCurve
from .triangles import UnclearError

MOST_VERTICES = 20_000
_VIEWS = 24
_FEW = 4  # of them are looked at before it is known whether any move is worthwhile
_SIDES = 3.0  # times as high as it is a curve is taken to be, whose views are then random
_TILT = 1e-3  # radians, about, by which the frame is turned where rounding hides what is seen
_TURNS = 8
_WORK = 60_000  # crossings of diagrams that are visited to see where the moves in one view lead


def drawn(body: MovingCurve, rng: np.random.Generator) -> Drawing:
    """The drawing of the curve, in the frame or, if need be, in one turned from it by very little."""
    tilts = (rotation(np.eye(3) + _TILT * rng.normal(size=(3, 3))) for _ in range(_TURNS))
    body.frame, drawing = next(_seen(body, chain([body.frame], (body.frame @ tilt for tilt in tilts))))
    return drawing


def face(body: MovingCurve, rng: np.random.Generator, count: int = _VIEWS) -> Drawing:
    """Turn the frame to where the fewest strands cross, as seen from where the curve is flattest or at random."""
    middle = body.curve.vertices - body.curve.vertices.mean(axis=0)
    flattest = np.linalg.svd(middle / np.abs(middle).max(), full_matrices=False)[2] + 0.02 * rng.normal(size=(3, 3))
    seen = _seen(body, [rotation(each) for each in (flattest, *rng.normal(size=(count - 1, 3, 3)))])
    body.frame, drawing = min(seen, key=lambda each: each[1].diagram.crossings)
    return drawing


def turn(body: MovingCurve, rng: np.random.Generator, *, away: bool = False, count: int = _VIEWS) -> int:
    """Turn the frame to where moves lead to fewer crossings than are seen now, if there is such a view.

    Returns how many they lead to.  If it is to turn ``away``, moves that begin in the present frame do not count.
    """
    best, here = drawn(body, rng).diagram.crossings, body.frame
    sides = [here @ rotation(each) for each in rng.normal(size=(count, 3, 3)) * [1.0, 1.0, _SIDES]]
    for frame, drawing in sorted(_seen(body, [here, *sides]), key=lambda each: each[1].diagram.crossings):
        if away and frame is here:
            continue
        left = simplified(drawing.diagram, _WORK)
        if left.crossings < best:
            best, body.frame = left.crossings, frame
        if shows_least(left):
            break
    return best


def shows_least(diagram: Diagram) -> bool:
    """Whether no diagram has fewer crossings than a simplified one: true for sums of alternating ones."""
    return all(is_least(factor) for piece in diagram.without_pins.pieces() for factor in factors(piece))


def worth(curve: Curve, least: int = 0, seed: int = 20231) -> tuple[int, int]:
    """How many of the crossings seen go by moves of diagrams, and how many of them stay.

    With fewer than ``least`` crossings to begin with, none counts as going.
    """
    if curve.dimension != 3 or len(curve) > MOST_VERTICES:
        return 0, 0
    body, rng = MovingCurve(curve, NOWHERE), np.random.default_rng(seed)
    try:
        drawing = face(body, rng, _FEW)
        crossings = drawing.diagram.crossings
        if crossings < least:
            return 0, crossings
        heights = combed(drawing, body.held)
        if heights is not None:
            level = np.column_stack([drawing.points[:, :2], heights])
            body = MovingCurve(curve.with_vertices(level), NOWHERE)
        left = turn(body, rng, count=_FEW)
    except UnclearError:
        return 0, 0
    return crossings - left, left


def _seen(body: MovingCurve, frames: Iterable[FloatArray]) -> Iterator[tuple[FloatArray, Drawing]]:
    """Yield the drawings in some frames, except where they are unclear; raise UnclearError if all of them are."""
    clear, reason = False, UnclearError()
    for frame in frames:
        check_time()
        try:
            drawing = Drawing.of(body.mesh, body.curve.vertices @ frame, body.held)
        except UnclearError as error:
            reason = error
        else:
            clear = True
            yield frame, drawing
    if not clear:
        raise reason
