"""Check that a trajectory is an isotopy: no two non-neighbour edges ever meet, and stages fit together.

Why this is enough: if two neighbour edges fold onto each other, or an edge shrinks to a point, then an edge meets the
one after its neighbour at the same moment, in every closed polygon of 4 or more vertices. A triangle, which has no such
edges, is one as long as no vertex lies on the opposite edge. Of an open polygon the first edge can fold onto the second
one with no edge before it that would meet this; so its first vertex must not lie on the second edge, or on its other
end if there is none, and likewise at the last edge. A motion free of such contact is a motion through embedded
polygons, all frames included.

This package shares no code with ``core.collision``, which the program uses to find its steps.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain
from pathlib import Path

import numpy as np

from ..errors import counted
from ..types import FloatArray, IntArray
from .filter import doubtful_pairs
from .segments import Point, meet
from .trajectory import Components, TrajectoryError, count_legs, stages
from .transition import DifferentCurveError, common_vertices, straightened


@dataclass(frozen=True)
class Verdict:
    """What was found.

    Attributes
    ----------
    accepted
        True if every leg and every change of stage is proved free of contact.
    stages, legs
        How many were checked, including the one that failed.
    reason
        Why the trajectory is not accepted; empty if it is.
    stage, frame
        Place of the failure: number of the stage and of the frame that the leg begins with, from 0.
    edges
        The edges that meet, from 0, None if that is not the reason.
    """

    accepted: bool
    stages: int
    legs: int
    reason: str = ""
    stage: int | None = None
    frame: int | None = None
    edges: tuple[int, int] | None = None

    def __str__(self) -> str:
        if self.accepted:
            return f"accepted: no contact on {counted(self.legs, 'leg')} in {counted(self.stages, 'stage')}"
        place = "" if self.stage is None else f"stage {self.stage}"
        place += "" if self.frame is None else f", frame {self.frame}"
        return f"rejected: {place}: {self.reason}" if place else f"rejected: {self.reason}"


class ContactError(Exception):
    """Two edges meet, or a vertex x₀ = x₁ of a triangle or at the end of an open polygon lies on an edge."""

    def __init__(self, heads: IntArray, x0: int, x1: int, y0: int, y1: int) -> None:
        self.edges = _edge_number(heads, x0, x1), _edge_number(heads, y0, y1)
        first, second = self.edges
        edges = f"edges {first + 1} and {second + 1} (counted from 1) meet"
        kind = "a triangle" if heads[heads[heads[x0]]] == x0 != heads[x0] else "an open polygon"
        super().__init__(f"{kind} collapses at vertex {x0 + 1}" if x0 == x1 else edges)


def _edge_number(heads: IntArray, a: int, b: int) -> int:
    """Number of the edge between two vertices, or of one at a vertex given twice; ends of open polygons begin none."""
    tail = b if heads[b] == a != b else a - int(heads[a] == a)
    return int(np.count_nonzero(heads[:tail] != np.arange(tail)))


@dataclass
class _Progress:
    stages: int = 0
    legs: int = 0
    frame: int | None = None
    tell: Callable[[int], None] = lambda legs: None


def verify(path: Path | str, callback: Callable[[int, int], None] | None = None) -> Verdict:
    """Check a trajectory file; damaged files and failed checks give a verdict that is not accepted.

    ``callback`` is called after every leg with the number of legs checked and, by its headers, of those in the file.
    """
    progress = _Progress()
    if callback is not None:
        legs = count_legs(path)
        progress.tell = lambda done: callback(done, legs)
    try:
        _check_file(path, progress)
    except TrajectoryError as error:
        return Verdict(False, progress.stages, progress.legs, str(error))
    except (ContactError, DifferentCurveError) as failure:
        place = (progress.stages - 1, progress.frame)
        edges = failure.edges if isinstance(failure, ContactError) else None
        return Verdict(False, progress.stages, progress.legs, str(failure), *place, edges)
    return Verdict(True, progress.stages, progress.legs)


def _check_file(path: Path | str, progress: _Progress) -> None:
    last: FloatArray | None = None
    before: Components = ()
    for stage in stages(path):
        progress.stages, progress.frame = progress.stages + 1, None
        heads = _heads(stage.components)
        first = next(stage.frames)
        if last is not None:
            _check_transition(last, before, first, stage.components)
        progress.frame = 0
        _check_leg(first, first, heads)  # also a stage of a single frame is a polygon that doesn't touch itself
        last, before = first, stage.components
        for frame in stage.frames:
            progress.legs += 1
            _check_leg(last, frame, heads)
            last, progress.frame = frame, progress.frame + 1
            progress.tell(progress.legs)


def _heads(components: Components) -> IntArray:
    """The vertex that the edge from each vertex leads to: the vertex itself where an open polygon ends."""
    after = np.arange(1, sum(each.size for each in components) + 1)
    for part, each in zip(_parts(components), components, strict=True):
        after[part.stop - 1] = part.start if each.closed else part.stop - 1
    return after


def _check_leg(start: FloatArray, end: FloatArray, heads: IntArray) -> None:
    """Raise if two edges meet while the vertices go from start to end."""
    _check_pairs(heads, doubtful_pairs(start, end, heads), _exact_points(start), _exact_points(end))


def _check_transition(old: FloatArray, before: Components, new: FloatArray, after: Components) -> None:
    """Raise unless two curves differ only by vertices on edges."""
    if len(before) != len(after) or old.shape[1] != new.shape[1]:
        raise DifferentCurveError("the stage before has another number of components or another dimension")
    closed = [each.closed for each in before]
    if closed != [each.closed for each in after]:
        raise DifferentCurveError("a component is closed in one of two stages and open in the other")
    kept = []
    for a, b, is_closed in zip(_parts(before), _parts(after), closed, strict=True):
        kept.append(common_vertices(old[a], new[b], is_closed))
    _check_straightening(old, before, [here for here, _ in kept])
    _check_straightening(new, after, [sorted(there) for _, there in kept])


def _check_straightening(points: FloatArray, components: Components, kept: Sequence[Sequence[int]]) -> None:
    """Raise unless the vertices that are not kept can move onto the edges between the others without contact."""
    moved: dict[int, Point] = {}
    change = 0.0
    for part, each, vertices in zip(_parts(components), components, kept, strict=True):
        places, largest = straightened(points[part], vertices, each.closed)
        moved |= {part.start + k: place for k, place in places.items()}
        change = max(change, largest)
    if change > 0:
        heads, here = _heads(components), _exact_points(points)
        doubtful = doubtful_pairs(points, points, heads, clearance=change)
        _check_pairs(heads, doubtful, here, lambda k: moved.get(k) or here(k))


def _check_pairs(
    heads: IntArray, batches: Iterable[IntArray], first: Callable[[int], Point], last: Callable[[int], Point]
) -> None:
    """Decide pairs, given by their vertices, shapes (4, pairs), exactly; raise at the first that meets."""
    for corners in chain.from_iterable(batch.T.tolist() for batch in batches):
        if meet([first(k) for k in corners], [last(k) for k in corners]):
            raise ContactError(heads, *corners)


def _exact_points(points: FloatArray) -> Callable[[int], Point]:
    return lambda k: [Fraction(x) for x in points[k].tolist()]


def _parts(components: Components) -> list[slice]:
    ends = np.cumsum([each.size for each in components]).tolist()
    return [slice(end - each.size, end) for each, end in zip(components, ends, strict=True)]
