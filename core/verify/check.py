"""Check that a trajectory is an isotopy: no two non-neighbour edges ever meet, nor any obstacle, and stages fit.

Pinned vertices must not move, either.

Why this is enough: if two neighbour edges fold onto each other, or an edge shrinks to a point, then an edge meets the
one after its neighbour at the same moment, in every closed polygon of 4 or more vertices. A triangle, which has no such
edges, is one as long as no vertex lies on the opposite edge. Of an open polygon the first edge can fold onto the second
one with no edge before it that would meet this; so its first vertex must not lie on the second edge, or on its other
end if there is none, and likewise at the last edge. A motion free of such contact is a motion through embedded
polygons, all frames included.

This package shares no code with ``core.collision``, which the program uses to find its steps.
"""

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import MobiusFlowError, counted
from ..types import FloatArray, IntArray
from .filter import doubtful_pairs
from .obstacles import Obstacles
from .segments import Point, meet, meet_triangle
from .trajectory import Components, TrajectoryError, count_legs, obstacle_parts, pinned_points, stages
from .transition import DifferentCurveError, HeldVertices, LostPinError, common_vertices, straightened

_DECISIONS = 1500.0  # exact ones of a file, about two seconds, before its length counts,
_PER_LEG = 100.0  # and those that each leg adds. Runs need one in a hundred legs; files made to take days, millions.
_WORD = 64  # bits of the numbers of a plain decision; more bits take more than proportionally more time


@dataclass(frozen=True)
class Verdict:
    """The findings; numbers of what failed count from 0, and are None if that is not the reason."""

    accepted: bool  #: whether every leg and every change of stage is proved free of contact
    stages: int  #: how many were checked, including the one that failed
    legs: int
    reason: str = ""  #: why the trajectory is not accepted; empty if it is
    stage: int | None = None  #: the stage of the failure
    frame: int | None = None  #: the frame with which the failed leg begins
    edges: tuple[int, ...] | None = None  #: the edges that meet, or the one that meets an obstacle
    obstacles: int = 0  #: how many there are
    obstacle: int | None = None  #: the one that an edge meets
    pins: int = 0  #: how many vertices are held, in every frame

    def __str__(self) -> str:
        if self.accepted:
            nor = f", nor with {counted(self.obstacles, 'obstacle')}" if self.obstacles else ""
            held = f"; {counted(self.pins, 'pin')} in place" if self.pins else ""
            return f"accepted: no contact on {counted(self.legs, 'leg')} in {counted(self.stages, 'stage')}{nor}{held}"
        place = "" if self.stage is None else f"stage {self.stage}"
        place += "" if self.frame is None else f", frame {self.frame}"
        return f"rejected: {place}: {self.reason}" if place else f"rejected: {self.reason}"


class ContactError(Exception):
    """Two edges meet, or an edge and an obstacle; the message says which."""

    def __init__(self, message: str, edges: tuple[int, ...], obstacle: int | None = None) -> None:
        super().__init__(message)
        self.edges, self.obstacle = edges, obstacle

    @classmethod
    def between(cls, heads: IntArray, x0: int, x1: int, y0: int, y1: int) -> "ContactError":
        """Two edges, or a vertex x₀ = x₁ of a triangle or at the end of an open polygon and an edge."""
        first, second = _edge_number(heads, x0, x1), _edge_number(heads, y0, y1)
        edges = f"edges {first + 1} and {second + 1} (counted from 1) meet"
        kind = "a triangle" if heads[heads[heads[x0]]] == x0 != heads[x0] else "an open polygon"
        return cls(f"{kind} collapses at vertex {x0 + 1}" if x0 == x1 else edges, (first, second))

    @classmethod
    def with_obstacle(cls, heads: IntArray, x0: int, x1: int, obstacle: int) -> "ContactError":
        """An edge and an obstacle."""
        edge = _edge_number(heads, x0, x1)
        return cls(f"edge {edge + 1} meets obstacle {obstacle + 1} (counted from 1)", (edge,), obstacle)


class UndecidedError(Exception):
    """More edges are within rounding of each other than are worth deciding exactly; the message says so."""


def _edge_number(heads: IntArray, a: int, b: int) -> int:
    """Number of the edge between two vertices, or of one at a vertex given twice; ends of open polygons begin none."""
    tail = b if heads[b] == a != b else a - int(heads[a] == a)
    return int(np.count_nonzero(heads[:tail] != np.arange(tail)))


@dataclass
class _Progress:
    obstacles: Obstacles = field(default_factory=lambda: Obstacles.of(()))
    pins: int = 0
    stages: int = 0
    legs: int = 0
    frame: int | None = None
    tell: Callable[[int], None] = lambda legs: None
    decided: float = 0.0

    def decide(self, points: Sequence[Point]) -> None:
        """Count an exact decision about some points; raise if there are more than this program takes on."""
        numbers = [x for point in points for x in point]
        bits = max(x.denominator for x in numbers).bit_length() + max(int(abs(x)) for x in numbers).bit_length()
        self.decided += (bits / _WORD) ** 1.5
        if self.decided > _DECISIONS + _PER_LEG * self.legs:
            raise UndecidedError(
                "too many edges are so near to each other that rounding hides whether they meet; "
                "write a trajectory whose strands are further apart"
            )

    def verdict(self, **values: Any) -> Verdict:
        return Verdict(stages=self.stages, legs=self.legs, obstacles=len(self.obstacles), pins=self.pins, **values)


def verify(path: Path | str, callback: Callable[[int, int], None] | None = None) -> Verdict:
    """Check a trajectory file; damaged files and failed checks give a verdict that is not accepted.

    ``callback`` is called after every leg with the number of legs checked and, by its headers, of those in the file.
    Raises MobiusFlowError if ``path`` is not a path or ``callback`` not a function.
    """
    if not isinstance(path, str | os.PathLike):
        raise MobiusFlowError(f"path is of type {type(path).__name__}; give the name of a trajectory file")
    if callback is not None and not callable(callback):
        raise MobiusFlowError(f"callback is of type {type(callback).__name__}; give a function of two numbers")
    progress = _Progress()
    if callback is not None:
        legs = count_legs(path)
        progress.tell = lambda done: callback(done, legs)
    try:
        _check_file(path, progress)
    except TrajectoryError as error:
        return progress.verdict(accepted=False, reason=str(error))
    except (ContactError, DifferentCurveError, LostPinError, UndecidedError) as failure:
        what = {"edges": failure.edges, "obstacle": failure.obstacle} if isinstance(failure, ContactError) else {}
        place = {"stage": progress.stages - 1, "frame": progress.frame}
        return progress.verdict(accepted=False, reason=str(failure), **place, **what)
    return progress.verdict(accepted=True)


def _check_file(path: Path | str, progress: _Progress) -> None:
    last: FloatArray | None = None
    before: Components = ()
    progress.obstacles = Obstacles.of(obstacle_parts(path))
    pins = pinned_points(path)
    progress.pins = len(pins)
    for stage in stages(path):
        progress.stages, progress.frame = progress.stages + 1, None
        heads = _heads(stage.components)
        first = next(stage.frames)
        if len(progress.obstacles) and first.shape[1] != 3:
            raise TrajectoryError(f"{stage.name} is not in space, as obstacles are")
        if last is not None:
            _check_transition(last, before, first, stage.components, progress)
        progress.frame = 0
        held = HeldVertices.among(first, pins)
        _check_leg(first, first, heads, progress)  # a single frame is a polygon, too
        last, before = first, stage.components
        for frame in stage.frames:
            progress.legs += 1
            held.check(frame)
            _check_leg(last, frame, heads, progress)
            last, progress.frame = frame, progress.frame + 1
            progress.tell(progress.legs)


def _heads(components: Components) -> IntArray:
    """The vertex that the edge from each vertex leads to: the vertex itself where an open polygon ends."""
    after = np.arange(1, sum(each.size for each in components) + 1)
    for part, each in zip(_parts(components), components, strict=True):
        after[part.stop - 1] = part.start if each.closed else part.stop - 1
    return after


def _check_leg(start: FloatArray, end: FloatArray, heads: IntArray, progress: _Progress) -> None:
    """Raise if edges meet, or an edge an obstacle, while the vertices go from start to end."""
    _decide(heads, progress, (start, end), _exact_points(start), _exact_points(end))


def _check_transition(
    old: FloatArray, before: Components, new: FloatArray, after: Components, progress: _Progress
) -> None:
    """Raise unless two curves differ only by vertices on edges."""
    if len(before) != len(after) or old.shape[1] != new.shape[1]:
        raise DifferentCurveError("the stage before has another number of components or another dimension")
    closed = [each.closed for each in before]
    if closed != [each.closed for each in after]:
        raise DifferentCurveError("a component is closed in one of two stages and open in the other")
    kept = []
    for a, b, is_closed in zip(_parts(before), _parts(after), closed, strict=True):
        kept.append(common_vertices(old[a], new[b], is_closed))
    _check_straightening(old, before, [here for here, _ in kept], progress)
    _check_straightening(new, after, [sorted(there) for _, there in kept], progress)


def _check_straightening(
    points: FloatArray, components: Components, kept: Sequence[Sequence[int]], progress: _Progress
) -> None:
    """Raise unless the vertices that are not kept can move onto the edges between the others without contact."""
    moved: dict[int, Point] = {}
    change = 0.0
    for part, each, vertices in zip(_parts(components), components, kept, strict=True):
        places, largest = straightened(points[part], vertices, each.closed)
        moved |= {part.start + k: place for k, place in places.items()}
        change = max(change, largest)
    if change > 0:
        heads, here = _heads(components), _exact_points(points)

        def there(k: int) -> Point:
            return moved.get(k) or here(k)

        _decide(heads, progress, (points, points), here, there, clearance=change)


def _decide(
    heads: IntArray,
    progress: _Progress,
    way: tuple[FloatArray, FloatArray],
    first: Callable[[int], Point],
    last: Callable[[int], Point],
    clearance: float = 0.0,
) -> None:
    """Decide exactly the doubtful pairs of a leg whose ends are wrong by the clearance; raise at the first contact."""
    for corners in chain.from_iterable(batch.T.tolist() for batch in doubtful_pairs(*way, heads, clearance)):
        start, end = [first(k) for k in corners], [last(k) for k in corners]
        progress.decide(start + end)
        if meet(start, end):
            raise ContactError.between(heads, *corners)
    still = _exact_points(progress.obstacles.vertices)
    doubtful = progress.obstacles.doubtful(*way, heads, clearance)
    for x0, x1, *triangle in chain.from_iterable(batch.T.tolist() for batch in doubtful):
        corners, start, end = [still(k) for k in triangle], [first(x0), first(x1)], [last(x0), last(x1)]
        progress.decide(start + end + corners)
        if meet_triangle(start + corners, end + corners):
            raise ContactError.with_obstacle(heads, x0, x1, progress.obstacles.number_of(triangle[0]))


def _exact_points(points: FloatArray) -> Callable[[int], Point]:
    return lambda k: [Fraction(x) for x in points[k].tolist()]


def _parts(components: Components) -> list[slice]:
    ends = np.cumsum([each.size for each in components]).tolist()
    return [slice(end - each.size, end) for each, end in zip(components, ends, strict=True)]
