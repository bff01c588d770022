"""Check that a trajectory is an isotopy: no two non-neighbour edges ever meet, nor any obstacle, and stages fit.

Why this is enough: if two neighbour edges fold onto each other, or an edge shrinks to a point, then an edge meets the
one after its neighbour at the same moment, in every polygon of 4 or more vertices. A triangle, which has no such edges,
is one as long as no vertex lies on the opposite edge. So a motion free of such contact is a motion through embedded
polygons, all frames included.

This package shares no code with ``core.collision``, which the program uses to find its steps.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from ..types import FloatArray, IntArray
from .filter import doubtful_pairs
from .obstacles import Obstacles
from .segments import Point, meet
from .trajectory import TrajectoryError, count_legs, stages, still_parts
from .transition import DifferentCurveError, common_vertices, straightened
from .triangles import meet_triangle
from .verdict import ContactError, Verdict


@dataclass
class _Progress:
    stages: int = 0
    legs: int = 0
    obstacles: int = 0
    frame: int | None = None
    tell: Callable[[int], None] = lambda legs: None

    def verdict(self, **values: Any) -> Verdict:
        """The verdict, with what has been counted."""
        return Verdict(stages=self.stages, legs=self.legs, obstacles=self.obstacles, **values)


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
        return progress.verdict(accepted=False, reason=str(error))
    except (ContactError, DifferentCurveError) as failure:
        what = {"edges": failure.edges, "obstacle": failure.obstacle} if isinstance(failure, ContactError) else {}
        place = {"stage": progress.stages - 1, "frame": progress.frame}
        return progress.verdict(accepted=False, reason=str(failure), **place, **what)
    return progress.verdict(accepted=True)


def _check_file(path: Path | str, progress: _Progress) -> None:
    last: FloatArray | None = None
    sizes: tuple[int, ...] = ()
    obstacles = Obstacles.of(still_parts(path))
    progress.obstacles = len(obstacles)
    for stage in stages(path):
        progress.stages, progress.frame = progress.stages + 1, None
        heads = _heads(stage.component_sizes)
        first = next(stage.frames)
        if len(obstacles) and first.shape[1] != 3:
            raise TrajectoryError(f"{stage.name} is not in space, as obstacles are")
        if last is not None:
            _check_transition(last, sizes, first, stage.component_sizes, obstacles)
        progress.frame = 0
        _check_leg(first, first, heads, obstacles)  # a single frame is a polygon, too
        last, sizes = first, stage.component_sizes
        for frame in stage.frames:
            progress.legs += 1
            _check_leg(last, frame, heads, obstacles)
            last, progress.frame = frame, progress.frame + 1
            progress.tell(progress.legs)


def _heads(sizes: Sequence[int]) -> IntArray:
    """Head vertex of each edge; its tail has the edge's number."""
    heads = np.arange(1, sum(sizes) + 1)
    after = np.cumsum(sizes)
    heads[after - 1] = after - np.asarray(sizes)
    return heads


def _check_leg(start: FloatArray, end: FloatArray, heads: IntArray, obstacles: Obstacles) -> None:
    """Raise if edges meet, or an edge an obstacle, while the vertices go from start to end."""
    first, last = _exact_points(start), _exact_points(end)
    _check_pairs(doubtful_pairs(start, end, heads), first, last)
    _check_obstacles(obstacles, obstacles.doubtful(start, end, heads), first, last)


def _check_transition(
    old: FloatArray, old_sizes: Sequence[int], new: FloatArray, new_sizes: Sequence[int], obstacles: Obstacles
) -> None:
    """Raise unless two polygons differ only by vertices on edges."""
    if len(old_sizes) != len(new_sizes) or old.shape[1] != new.shape[1]:
        raise DifferentCurveError("the stage before has another number of components or another dimension")
    kept = []
    for a, b in zip(_parts(old_sizes), _parts(new_sizes), strict=True):
        kept.append(common_vertices(old[a], new[b]))
    _check_straightening(old, old_sizes, [here for here, _ in kept], obstacles)
    _check_straightening(new, new_sizes, [sorted(there) for _, there in kept], obstacles)


def _check_straightening(
    points: FloatArray, sizes: Sequence[int], kept: Sequence[Sequence[int]], obstacles: Obstacles
) -> None:
    """Raise unless the vertices that are not kept can move onto the edges between the others without contact."""
    moved: dict[int, Point] = {}
    change = 0.0
    for part, vertices in zip(_parts(sizes), kept, strict=True):
        places, largest = straightened(points[part], vertices)
        moved |= {part.start + k: place for k, place in places.items()}
        change = max(change, largest)
    if change > 0:
        heads, here = _heads(sizes), _exact_points(points)

        def there(k: int) -> Point:
            return moved.get(k) or here(k)

        _check_pairs(doubtful_pairs(points, points, heads, clearance=change), here, there)
        _check_obstacles(obstacles, obstacles.doubtful(points, points, heads, clearance=change), here, there)


def _check_pairs(batches: Iterable[IntArray], first: Callable[[int], Point], last: Callable[[int], Point]) -> None:
    """Decide pairs, given by their vertices, shapes (4, pairs), exactly; raise at the first that meets."""
    for corners in chain.from_iterable(batch.T.tolist() for batch in batches):
        if meet([first(k) for k in corners], [last(k) for k in corners]):
            raise ContactError.between(*corners)


def _check_obstacles(
    obstacles: Obstacles, batches: Iterable[IntArray], first: Callable[[int], Point], last: Callable[[int], Point]
) -> None:
    """The same for edges and triangles, shapes (5, pairs)."""
    still = _exact_points(obstacles.vertices)
    for x0, x1, *triangle in chain.from_iterable(batch.T.tolist() for batch in batches):
        corners = [still(k) for k in triangle]
        if meet_triangle([first(x0), first(x1), *corners], [last(x0), last(x1), *corners]):
            raise ContactError.with_obstacle(x0, obstacles.number_of(triangle[0]))


def _exact_points(points: FloatArray) -> Callable[[int], Point]:
    return lambda k: [Fraction(x) for x in points[k].tolist()]


def _parts(sizes: Sequence[int]) -> list[slice]:
    ends = np.cumsum(sizes).tolist()
    return [slice(end - size, end) for size, end in zip(sizes, ends, strict=True)]
