"""From a tangled curve to one with few crossings, by strand moves that are found on its diagram and made in space."""

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import suppress
from functools import partial
from typing import NamedTuple

import numpy as np

from ..collision import free_motion
from ..curve import Curve
from ..curve.pins import NOWHERE
from ..diagrams.rerouting import shortenings, simplified
from ..messages import Message
from ..obstacle import Obstacle
from ..types import IntArray
from .drawing import combed
from .moving import MovingCurve, Stage
from .passing import passed
from .spread import spread
from .thin import thin
from .triangles import UnclearError
from .views import MOST_VERTICES, drawn, face, shows_least, turn

_ATTEMPTS = 6  # from different views, as long as moves lead to fewer crossings
_FAILURES = 8  # moves in a row that are not free, after which a view is given up
_NEAR = 4e-3  # of the curve's size: strands nearer than that are spread
_NEARER = 1e-4  # of its size: spreading must not leave strands nearer than that, unless they were nearer before
_PART = 0.9  # of a motion's free part, if it is not free as a whole

UNTOUCHED = Message("only curves in space with at most {most:,} vertices are untangled", most=MOST_VERTICES)
NONE_LEFT = Message("no crossing is left")
BLOCKED = "{count} crossings are left, as no way for a strand is free"
STUCK = "{count} crossings are left, as no move of a strand is known that saves any"


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
        return Untangled(None, False, UNTOUCHED)
    rng = np.random.default_rng(seed)
    body = MovingCurve(curve, pins, obstacles)
    reached: int | None = None
    blocked = False
    try:
        face(body, rng)
        yield from _taken(body, rng)
        thin(body)
        _settle(body, rng)
        for _ in range(_ATTEMPTS):
            yield from _taken(body, rng)
            reached = drawn(body, rng).diagram.crossings
            if turn(body, rng, away=blocked) >= reached:
                break
            blocked = yield from _moved(body, rng)
        diagram = drawn(body, rng).diagram
        reached = diagram.crossings
    except UnclearError as error:
        return Untangled(reached, False, error.reason, body.moves)
    if simplified(diagram).crossings == reached and shows_least(diagram):
        body.resize(curve.length)
        yield from _taken(body, rng)
        left = Message("{count} crossings are left, as few as can be", count=reached) if reached else NONE_LEFT
        return Untangled(reached, True, left, body.moves)
    return Untangled(reached, False, Message(BLOCKED if blocked else STUCK, count=reached), body.moves)


def _moved(body: MovingCurve, rng: np.random.Generator) -> Generator[Stage, None, bool]:
    """Make moves in one view until none is left to make; return whether that is because they are not free."""
    failures = 0
    _settle(body, rng)
    while failures <= _FAILURES:
        yield from _taken(body, rng)
        drawing = drawn(body, rng)
        move = next(shortenings(drawing.diagram, rng if failures else None), None)
        if move is None:
            return False
        if _made(body, partial(passed, body, drawing, move)):
            failures = 0
            body.moves += 1
            _settle(body, rng)
        else:
            failures += 1
    return True


def _made(body: MovingCurve, motions: Callable[[], bool]) -> bool:
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
    if gap < _NEAR * body.size and not body.held.any() and _made(body, lambda: spread(body, drawn(body, rng))):
        _level(body, rng)
        if body.gap < min(gap, _NEARER * body.size):
            body.rewind(mark)


def _level(body: MovingCurve, rng: np.random.Generator) -> None:
    """Level the curve, and drop vertices that it can do without."""
    _lower(body, rng)
    thin(body)
    _lower(body, rng)


def _lower(body: MovingCurve, rng: np.random.Generator) -> None:
    """Make heights as level as crossings and free motion allow; not where nothing crosses."""
    drawing = drawn(body, rng)
    heights = combed(drawing, body.held) if drawing.diagram.crossings else None
    if heights is None:
        return
    everything, targets = np.arange(body.mesh.size), np.column_stack([drawing.points[:, :2], heights])
    if not body.move(everything, targets):
        end = targets @ body.frame.T
        part = _PART * free_motion(body.mesh, body.curve.vertices, end, body.obstacles).time
        body.move(everything, drawing.points + part * (targets - drawing.points))


def _taken(body: MovingCurve, rng: np.random.Generator) -> Iterator[Stage]:
    """Yield the stages not yet taken, with what is seen at the end."""
    yield from body.taken(drawn(body, rng).diagram.crossings)
