"""From a tangled curve to one with few crossings: strand moves that are found on its diagram, and made by a rope.

The curve lies down on a table as it looks best.  Of the moves that lead on, the shortest are made; those that turn out
to save nothing are taken back.  A knot that is stuck in one view comes apart in another.
"""

import math
from collections.abc import Generator, Sequence
from itertools import chain

import numpy as np

from ..base import BoolArray, FloatArray, IntArray, Message
from ..collision import is_rope, survives_rounding
from ..curve import NOWHERE, Curve, Obstacle, Pins, holds, refine
from ..knots.diagrams import Diagram, factors, is_least, simplified
from ..knots.diagrams.projection import Projection, UnclearError, frames, projections, rotation
from ..knots.diagrams.rerouting import Strand, StrandMove, reduced, shortenings, shortest_route, strands
from .leading import Lead, lead
from .rope import ElasticRope, Legs
from .ways import Plane

MOST_VERTICES, MOST_CROSSINGS = 20_000, 5_000  # of the curve, and in a view
WORK = 60_000  # crossings that may be visited to find out how few moves lead to


def untangled(
    curve: Curve,
    pins: IntArray = NOWHERE,
    obstacles: Sequence[Obstacle] = (),
    radius: FloatArray | None = None,
    seed: int = 20231,
    share: float = 0.0,
) -> Generator[Legs, None, str]:
    """Yield motions, all of them proved, to a curve with fewer crossings; return how it ended.

    Parameters
    ----------
    curve
        Embedded polygons in space, closed or open; ends of open ones are held.
    pins
        Vertices that stay where they are.
    obstacles
        What the curve must not meet.
    radius
        That of each component, shape (components,), if the curve is a rope, and stays one.
    seed
        The same seed gives the same motions.
    share
        Of the crossings that can go, so many may be left to the flow.
    """
    if curve.dimension != 3 or len(curve) > MOST_VERTICES:
        return Message("only curves in space with at most {most:,} vertices are untangled", most=MOST_VERTICES)
    rng, moves, few = np.random.default_rng(seed), 0, 0
    reached: int | None = None
    held: BoolArray = holds(curve.mesh, np.concatenate([pins, curve.mesh.ends.ravel()]))
    rope: ElasticRope | None = None
    try:
        for _ in range(6):  # from different views, as long as moves lead to fewer crossings
            found = _best_view(curve, held, rng, reached)
            if found is None:
                break
            if rope is not None:
                yield rope.take(found[1].diagram.crossings, moves)
            frame, drawing = found
            crossings = drawing.diagram.crossings
            if reached is None:
                few = math.floor(share * (crossings - outlook(drawing.diagram, rng)))
                fine = refine(curve, max(len(curve), 6 * crossings + 60))
                still, room = (fine.mesh, fine.vertices, fine.vertices), None if radius is None else 1.2 * radius
                # corners of a rope may be too sharp for more vertices
                if survives_rounding(fine) if room is None else is_rope(*still, room):
                    held = holds(fine.mesh, Pins(np.flatnonzero(held), curve.vertices[held]).on(fine).vertices)
                    curve = fine
            rope = ElasticRope(curve, frame, held, obstacles, radius)
            rope.lie_down(crossings)
            drawing = draw(rope, rng)
            yield rope.take(drawing.diagram.crossings, moves)
            drawing, moves = yield from _make_moves(rope, drawing, moves, rng, few)
            reached = drawing.diagram.crossings
            left = simplified(drawing.diagram)
            if left.crossings == reached and shows_least(left):
                told = Message("{count} crossings are left, as few as can be", count=reached)
                return told if reached else Message("no crossing is left")
            if few and reached <= left.crossings + few:
                return Message("{count} crossings are left to the flow", count=reached)
            rope.rise()
            curve = rope.curve
    except UnclearError as error:
        return str(error)
    return Message("{count} crossings are left, as no free way of a strand is known that saves any", count=reached)


def _make_moves(
    rope: ElasticRope,
    drawing: Projection,
    moves: int,
    rng: np.random.Generator,
    few: int,
    patience: int = 12,
    tabu_for: int = 8,
) -> Generator[Legs, None, tuple[Projection, int]]:
    """Make moves in one view until few crossings can still go; return the drawing, and the number of moves.

    A move that adds crossings may be what leads on; what does not is taken back. The view is given up after so many
    moves in vain as there is patience for, and a strand that has moved in vain is left alone for some moves.
    """
    lowest, best, vain, tried, made = drawing, outlook(drawing.diagram, rng), 0, 0, 0
    tabu: list[tuple[int, set[int]]] = []  # strands that have moved in vain, each with the number of moves by then
    mark = rope.mark()
    while drawing.diagram.crossings > best + few and vain < patience:
        left_alone = [strand for when, strand in tabu if tried - when < tabu_for]
        leads = _choose(rope, drawing, left_alone, best, rng, 4 if vain < 2 else 1)
        if not leads:
            break
        before, count, tried = rope.mark(), drawing.diagram.crossings, tried + 1
        led = [(tried, set(each.vertices.tolist())) for each in leads]
        lead(rope, leads)
        rope.settle()
        after = draw(rope, rng)
        seen, low = after.diagram.crossings, lowest.diagram.crossings
        if seen >= count and (seen > low + max(4, low // 8) or outlook(after.diagram, rng) > best):
            rope.rewind(before)
            tabu, vain = tabu + led, vain + 1
            continue
        drawing, made = after, made + len(leads)
        if seen < low:
            lowest, moves, made, vain = drawing, moves + made, 0, 0
            best = min(best, outlook(drawing.diagram, rng))
            yield rope.take(seen, moves)
            mark = rope.mark()
        else:
            tabu, vain = tabu + led, vain + 1
    rope.rewind(mark)
    return lowest, moves


def _choose(
    rope: ElasticRope,
    drawing: Projection,
    left_alone: Sequence[set[int]],
    best: int,
    rng: np.random.Generator,
    most: int,
) -> list[Lead]:
    """The strands that are nearest to where moves lead on, as many as are far from each other."""
    plane, diagram = Plane(drawing, rope.face), drawing.diagram
    found: list[Lead] = []
    whole = list(strands(diagram))
    short = (  # pieces of each
        Strand(piece := each.inner[k : k + n], diagram.previous[piece[0]], each.over)
        for each in whole
        for n in range(1, min(6, len(each.inner)))
        for k in range(len(each.inner) - n + 1)
    )
    for strand in chain(whole, short):
        if shortest_route(diagram, strand, len(strand.inner)) is None:
            continue
        way = plane.way(strand)
        if way is not None:
            each = Lead(rope, drawing, StrandMove(diagram, strand, way.route), way)
            own = set(each.vertices.tolist())
            if each.count > 3 and not any(2 * len(other & own) > len(other | own) for other in left_alone):
                found.append(each)
    found.sort(key=lambda each: each.cost)
    chosen: list[Lead] = []
    second: tuple[int, Lead] | None = None
    for each in found[:40]:
        gaps = (np.maximum(each.low - other.high, other.low - each.high).max() for other in chosen)
        if chosen and (len(chosen) == most or each.cost > 4.0 * chosen[0].cost or min(gaps) < 0.8 * rope.face):
            continue
        left = outlook(each.move.after, rng)
        if left <= best:
            chosen.append(each)
        elif second is None or left < second[0]:
            second = left, each
    return chosen or ([second[1]] if second else [])


def outlook(diagram: Diagram, rng: np.random.Generator) -> int:
    """How few crossings moves are known to lead to: the longest strands first, or in random orders."""
    best = simplified(diagram, WORK)
    left = best.crossings
    for _ in range(2 if left and not shows_least(best) else 0):
        trial, work = reduced(diagram), WORK
        while work > 0 and (move := next(shortenings(trial, rng), None)) is not None:
            trial, work = reduced(move.after), work - trial.crossings
        left = min(left, trial.crossings)
    return left


def shows_least(diagram: Diagram) -> bool:
    """Whether no diagram has fewer crossings than a simplified one: true for sums of alternating ones."""
    return all(is_least(factor) for piece in diagram.without_pins.pieces() for factor in factors(piece))


def worth(curve: Curve, least: int = 0, seed: int = 20231, count: int = 4) -> tuple[int, int]:
    """How many of the crossings seen in some views go by moves of diagrams, and how many of them stay.

    With fewer than ``least`` crossings to begin with, none counts as going.
    """
    if curve.dimension != 3 or len(curve) > MOST_VERTICES:
        return 0, 0
    axes = frames(curve.vertices - curve.vertices.mean(axis=0), count, np.random.default_rng(seed))
    try:
        views = projections(curve.mesh, curve.vertices, axes, curve.mesh.ends.ravel(), most=MOST_CROSSINGS)
        diagrams = [drawing.diagram for _, drawing in views]
    except UnclearError:
        return 0, 0
    crossings = left = min(diagram.crossings for diagram in diagrams)
    if crossings >= least:
        left = min(left, *(simplified(diagram, WORK).crossings for diagram in diagrams))
    return crossings - left, left


def draw(rope: ElasticRope, rng: np.random.Generator) -> Projection:
    """The drawing of a rope as it lies or, if need be, turned by very little."""
    turns = (rotation(np.eye(3) + 1e-4 * k * rng.normal(size=(3, 3))) for k in range(8))
    return next(projections(rope.mesh, rope.seen, turns, np.flatnonzero(rope.held), most=MOST_CROSSINGS))[1]


def _best_view(
    curve: Curve, held: BoolArray, rng: np.random.Generator, reached: int | None, count: int = 24
) -> tuple[FloatArray, Projection] | None:
    """The frame from which moves lead to the fewest crossings, and what is seen; None if not to fewer than now."""
    middle = curve.vertices - curve.vertices.mean(axis=0)
    axes = frames(middle, count, rng) if reached is None else map(rotation, rng.normal(size=(count, 3, 3)))
    views = projections(curve.mesh, curve.vertices, axes, np.flatnonzero(held), most=MOST_CROSSINGS)
    best, least = None, math.inf if reached is None else reached
    for frame, drawing in sorted(views, key=lambda each: each[1].diagram.crossings):
        left = simplified(drawing.diagram, WORK)
        if left.crossings < least:
            best, least = (frame, drawing), left.crossings
        if shows_least(left):
            break
    return best
