"""From a tangled curve to one with few crossings, by strand moves that are planned on its diagram and made in space."""

from collections.abc import Generator, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ..collision import free_motion
from ..curve import Curve
from ..curve.pins import NOWHERE
from ..diagrams.projection import rotation
from ..diagrams.rerouting import Move
from ..messages import Message
from ..obstacle import Obstacle
from ..types import FloatArray, IntArray
from .drawing import Drawing
from .heights import combed
from .matching import carried
from .moving import MovingCurve, Stage
from .passing import passed
from .plan import is_least, planned
from .spread import spread
from .thin import thin
from .triangles import UnclearError

MOST_VERTICES = 20_000
MOST_CROSSINGS = 1_000
_VIEWS = 24
_PLANS = 8  # one after the other, for a guess of what can go
_ATTEMPTS = 4  # from different views, as long as plans promise fewer crossings
_FAILURES = 8  # moves in a row that are not free, after which a view is given up
_NEAR = 4e-3  # of the curve's size: strands nearer than that are spread
_TILT = 1e-3  # radians, about, by which the frame is turned where rounding hides what is seen
_TURNS = 8
_PART = 0.9  # of a motion's free part, if it is not free as a whole

UNTOUCHED = Message("only curves in space with at most {most:,} vertices are untangled", most=MOST_VERTICES)
UNCLEAR = Message("strands touch, or nearly do: no view of the curve shows which one is in front")
NONE_LEFT = Message("no crossing is left")


class Untangled(NamedTuple):
    """How it ended: with so many crossings, whether no diagram of the curve has fewer, and both in words."""

    crossings: int | None
    least: bool
    reason: Message


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
        for _ in range(_ATTEMPTS):
            frame = _promising(body, rng, reached)
            if frame is None:
                break
            body.frame = frame
            count = _drawing(body, rng).diagram.crossings
            if count > MOST_CROSSINGS:
                return Untangled(
                    count, False, Message("there are {count:,} crossings, which are too many", count=count)
                )
            blocked = yield from _moved(body, rng)
            diagram = _drawing(body, rng).diagram
            reached = diagram.crossings
            if is_least(diagram):
                body.resize(curve.length)
                yield from _taken(body)
                return Untangled(
                    reached, True, Message("{count} crossings, the least", count=reached) if reached else NONE_LEFT
                )
    except UnclearError:
        return Untangled(reached, False, UNCLEAR)
    if blocked:
        left = Message("{count} crossings are left, as no way for a strand is free", count=reached)
    else:
        left = Message("{count} crossings are left, as no move of a strand is known that saves any", count=reached)
    return Untangled(reached, False, left)


def worth(curve: Curve, least: int = 0, seed: int = 20231) -> tuple[int, int]:
    """How many crossings of the best of a few views go by moves of its diagram, and how many of them stay.

    Of diagrams with fewer than ``least`` none goes; if that is above 0, moves that save nothing may come first.
    """
    if curve.dimension != 3 or len(curve) > MOST_VERTICES:
        return 0, 0
    body, rng = MovingCurve(curve, NOWHERE), np.random.default_rng(seed)
    seen = [drawing.diagram for _, drawing in _views(body, rng, 4)]
    diagram = min(seen, key=lambda diagram: diagram.crossings, default=None)
    if diagram is None or not least <= diagram.crossings <= MOST_CROSSINGS:
        return 0, 0
    left = diagram
    for _ in range(_PLANS):
        moves = planned(left, rng, shuffles=least > 0)
        if not moves:
            break
        left = moves[-1].after
    return diagram.crossings - left.crossings, left.crossings


def _moved(body: MovingCurve, rng: np.random.Generator) -> Generator[Stage, None, bool]:
    """Make moves in one view until none is left to make; whether that is because they are not free."""
    thin(body)
    _settle(body, rng)
    yield from _taken(body)
    plan: list[Move] = []
    failures = 0
    while not is_least((drawing := _drawing(body, rng)).diagram):
        move = carried(plan[0], drawing.diagram) if plan else None
        if move is None:
            plan = planned(drawing.diagram, rng, settled=not failures)
            if not plan:
                return False
            move = plan[0]
        mark = body.mark()
        if not passed(body, drawing, move):
            body.rewind(mark)
            plan, failures = [], failures + 1
            if failures > _FAILURES:
                return True
            continue
        plan, failures = plan[1:], 0
        _settle(body, rng)
        yield from _taken(body)
    return False


def _settle(body: MovingCurve, rng: np.random.Generator) -> None:
    """Level the curve, leave out what it can do without, and spread it where strands are near each other."""
    _lower(body, rng)
    thin(body)
    _lower(body, rng)
    if body.gap < _NEAR * body.size and not body.held.any():
        mark = body.mark()
        if spread(body, _drawing(body, rng)):
            _lower(body, rng)
            thin(body)
            _lower(body, rng)
        else:
            body.rewind(mark)


def _lower(body: MovingCurve, rng: np.random.Generator) -> None:
    """Make heights as level as crossings allow, or as free motion does; not where nothing crosses."""
    drawing = _drawing(body, rng)
    heights = combed(drawing, body.held) if drawing.diagram.crossings else None
    if heights is None:
        return
    everything, targets = np.arange(body.mesh.size), np.column_stack([drawing.points[:, :2], heights])
    if not body.move(everything, targets):
        end = targets @ body.frame.T
        part = _PART * free_motion(body.mesh, body.curve.vertices, end, body.obstacles).time
        body.move(everything, drawing.points + part * (targets - drawing.points))


def _taken(body: MovingCurve) -> Iterator[Stage]:
    """The stages made so far, each once."""
    stages, body.stages = body.stages, []
    yield from stages


def _drawing(body: MovingCurve, rng: np.random.Generator) -> Drawing:
    """What is seen, if need be from a direction very near the frame's."""
    for _ in range(_TURNS):
        try:
            return Drawing.of(body.mesh, body.seen, body.held)
        except UnclearError:
            body.frame = body.frame @ rotation(np.eye(3) + _TILT * rng.normal(size=(3, 3)))
    raise UnclearError


def _views(body: MovingCurve, rng: np.random.Generator, count: int) -> Iterator[tuple[FloatArray, Drawing]]:
    """Frames and what is seen in them: first from where the curve looks flattest, then from random directions."""
    middle = body.curve.vertices - body.curve.vertices.mean(axis=0)
    flattest = np.linalg.svd(middle / np.abs(middle).max(), full_matrices=False)[2] + 0.02 * rng.normal(size=(3, 3))
    for frame in (rotation(flattest), *map(rotation, rng.normal(size=(count - 1, 3, 3)))):
        try:
            yield frame, Drawing.of(body.mesh, body.curve.vertices @ frame, body.held)
        except UnclearError:
            continue


def _promising(body: MovingCurve, rng: np.random.Generator, below: int | None) -> FloatArray | None:
    """The frame with the fewest crossings; if a number is given, of those from which plans lead to fewer."""
    best: tuple[int, FloatArray] | None = None
    none = True
    for frame, drawing in _views(body, rng, _VIEWS):
        none = False
        crossings = drawing.diagram.crossings
        if (best is not None and crossings >= best[0]) or (below is not None and crossings > MOST_CROSSINGS):
            continue
        if below is not None:
            saved = sum(move.saved for move in planned(drawing.diagram, rng, shuffles=False))
            if crossings - saved >= below:
                continue
        best = crossings, frame
    if none:
        raise UnclearError
    return None if best is None else best[1]
