"""From a tangled curve to one with few crossings, by strand moves that are found on its diagram and made in space.

A knot that is stuck in one view comes apart in another: with level heights, two dozen views from the side were enough.
"""

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from itertools import chain
from typing import NamedTuple

import numpy as np

from ..base.deadline import check_time
from ..base.messages import Message
from ..base.types import FloatArray, IntArray
from ..collision import free_motion
from ..curve import Curve
from ..curve.obstacle import Obstacle
from ..curve.pins import NOWHERE
from ..knots.diagrams.diagram import Diagram
from ..knots.diagrams.projection import rotation
from ..knots.diagrams.rerouting import factors, is_least, shortenings, simplified
from .drawing import PlaneDrawing, UnclearError, level_heights
from .moving import MovingCurve, Stage
from .strand_move import make_move
from .tidying import spread, thin

MOST_VERTICES = 20_000
_VIEWS = 24
_FEW = 4  # of them are looked at before it is known whether any move is worthwhile


class Untangled(NamedTuple):
    """How it ended: the number of crossings, whether no diagram has fewer, both in words, and the number of moves."""

    crossings: int | None
    least: bool
    reason: Message
    moves: int = 0


def untangled(
    curve: Curve, pins: IntArray = NOWHERE, obstacles: Sequence[Obstacle] = (), seed: int = 20231
) -> Generator[Stage, None, Untangled]:
    """Yield stages of motions, all proved free of contact, to a curve with fewer crossings; return how it ended.

    Parameters
    ----------
    curve
        Embedded polygons in space, closed or open; ends of open ones are held.
    pins
        Vertices that stay where they are.
    obstacles
        What the curve must not meet.
    seed
        The same seed gives the same motions.
    """
    if curve.dimension != 3 or len(curve) > MOST_VERTICES:
        told = Message("only curves in space with at most {most:,} vertices are untangled", most=MOST_VERTICES)
        return Untangled(None, False, told)
    rng = np.random.default_rng(seed)
    body = MovingCurve(curve, pins, obstacles)
    reached: int | None = None
    blocked = False
    try:
        face(body, rng)
        yield from _take(body, rng)
        thin(body)
        _settle(body, rng)
        for _ in range(6):  # from different views, as long as moves lead to fewer crossings
            yield from _take(body, rng)
            reached = draw(body, rng).diagram.crossings
            if turn(body, rng, away=blocked) >= reached:
                break
            blocked = yield from _make_moves(body, rng)
        diagram = draw(body, rng).diagram
        reached = diagram.crossings
    except UnclearError as error:
        return Untangled(reached, False, error.reason, body.moves)
    if simplified(diagram).crossings == reached and shows_least(diagram):
        body.resize(curve.length)
        yield from _take(body, rng)
        left = Message("{count} crossings are left, as few as can be", count=reached)
        return Untangled(reached, True, left if reached else Message("no crossing is left"), body.moves)
    why = "{count} crossings are left, as no move of a strand is known that saves any"
    if blocked:
        why = "{count} crossings are left, as no way for a strand is free"
    return Untangled(reached, False, Message(why, count=reached), body.moves)


def _make_moves(body: MovingCurve, rng: np.random.Generator) -> Generator[Stage, None, bool]:
    """Make moves in one view until none is left to make; return whether that is because they are not free."""
    failures = 0
    _settle(body, rng)
    while failures <= 8:  # moves in a row that are not free, after which a view is given up
        yield from _take(body, rng)
        drawing = draw(body, rng)
        move = next(shortenings(drawing.diagram, rng if failures else None), None)
        if move is None:
            return False
        if _succeeds(body, partial(make_move, body, drawing, move)):
            failures = 0
            body.moves += 1
            _settle(body, rng)
        else:
            failures += 1
    return True


def _succeeds(body: MovingCurve, motions: Callable[[], bool]) -> bool:
    """Make motions, or none if one is not free or rounding leaves the way unclear; return whether they are made."""
    mark = body.mark()
    with suppress(UnclearError):
        if motions():
            return True
    body.rewind(mark)
    return False


def _settle(body: MovingCurve, rng: np.random.Generator) -> None:
    """Level the curve, drop vertices that it can do without, and spread it where strands are near each other."""
    _level(body, rng)
    gap, mark = body.gap, body.mark()
    near = gap < 4e-3 * body.size and not body.held.any()
    if near and _succeeds(body, lambda: spread(body, draw(body, rng))):
        _level(body, rng)
        if body.gap < min(gap, 1e-4 * body.size):  # spreading must not bring strands so near
            body.rewind(mark)


def _level(body: MovingCurve, rng: np.random.Generator) -> None:
    """Make heights as level as crossings and free motion allow, twice, and drop vertices in between."""
    for again in (False, True):
        if again:
            thin(body)
        drawing = draw(body, rng)
        heights = level_heights(drawing, body.held) if drawing.diagram.crossings else None
        if heights is None:
            continue
        everything, targets = np.arange(body.mesh.size), np.column_stack([drawing.points[:, :2], heights])
        if not body.move(everything, targets):  # then most of the way that is free
            end = targets @ body.frame.T
            part = 0.9 * free_motion(body.mesh, body.curve.vertices, end, body.obstacles).time
            body.move(everything, drawing.points + part * (targets - drawing.points))


def _take(body: MovingCurve, rng: np.random.Generator) -> Iterator[Stage]:
    """Yield the stages not yet taken, with what is seen at the end."""
    yield from body.take(draw(body, rng).diagram.crossings)


def draw(body: MovingCurve, rng: np.random.Generator) -> PlaneDrawing:
    """The drawing of the curve, in the frame or, if need be, in one turned from it by very little."""
    tilts = (rotation(np.eye(3) + 1e-3 * rng.normal(size=(3, 3))) for _ in range(8))
    body.frame, drawing = next(_draw_clear(body, chain([body.frame], (body.frame @ tilt for tilt in tilts))))
    return drawing


def face(body: MovingCurve, rng: np.random.Generator, count: int = _VIEWS) -> PlaneDrawing:
    """Turn the frame to where the fewest strands cross, as seen from where the curve is flattest or at random."""
    middle = body.curve.vertices - body.curve.vertices.mean(axis=0)
    flattest = np.linalg.svd(middle / np.abs(middle).max(), full_matrices=False)[2] + 0.02 * rng.normal(size=(3, 3))
    seen = _draw_clear(body, [rotation(each) for each in (flattest, *rng.normal(size=(count - 1, 3, 3)))])
    body.frame, drawing = min(seen, key=lambda each: each[1].diagram.crossings)
    return drawing


def turn(body: MovingCurve, rng: np.random.Generator, *, away: bool = False, count: int = _VIEWS) -> int:
    """Turn the frame to where moves lead to fewer crossings than are seen now, if there is such a view.

    Returns how many they lead to.  If it is to turn ``away``, moves that begin in the present frame do not count.
    """
    best, here = draw(body, rng).diagram.crossings, body.frame
    # random views of a curve that is taken to be three times as high as it is
    sides = [here @ rotation(each) for each in rng.normal(size=(count, 3, 3)) * [1.0, 1.0, 3.0]]
    for frame, drawing in sorted(_draw_clear(body, [here, *sides]), key=lambda each: each[1].diagram.crossings):
        if away and frame is here:
            continue
        left = simplified(drawing.diagram, work=60_000)
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
        heights = level_heights(drawing, body.held)
        if heights is not None:
            level = np.column_stack([drawing.points[:, :2], heights])
            body = MovingCurve(curve.with_vertices(level), NOWHERE)
        left = turn(body, rng, count=_FEW)
    except UnclearError:
        return 0, 0
    return crossings - left, left


def _draw_clear(body: MovingCurve, frames: Iterable[FloatArray]) -> Iterator[tuple[FloatArray, PlaneDrawing]]:
    """Yield the drawings in some frames, except where they are unclear; raise UnclearError if all of them are."""
    none, reason = True, UnclearError()
    for frame in frames:
        check_time()
        try:
            drawing = PlaneDrawing.of(body.mesh, body.curve.vertices @ frame, body.held)
        except UnclearError as error:
            reason = error
        else:
            none = False
            yield frame, drawing
    if none:
        raise reason
