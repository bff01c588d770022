"""Which frames of a relaxation to key, so that the straight lines between the keys are proved too.

The relaxation certifies its own path in doubles. Blender keeps keys as 32-bit floats and moves points straight
from one key to the next: another path, which needs its own proof, in the numbers that Blender stores.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ...core import Curve, Iterate, MobiusFlowError
from ...core.curve import Mesh
from ...core.curve.refine import subdivide, subdivision
from ...core.types import FloatArray
from .key_options import Course, Pace
from .placement import Frame, Link

Proof = Callable[[Mesh, FloatArray, FloatArray], bool]

_HALVINGS = 5  # of one leg; its keys are then still further apart in time than what Blender tells apart


@dataclass(frozen=True, eq=False)
class Key:
    """One key: the time, counted in iterates (2.5 is halfway from iterate 2 to 3), and the vertices, (n, 3)."""

    time: float
    points: Frame


@dataclass(frozen=True, eq=False)
class Keys:
    """The keys of an animation."""

    keys: tuple[Key, ...]  # in order of time
    # number of gaps between keys whose straight motion could not be proved free of contact; rounding the start to
    # Blender's numbers counts as one more gap
    unproved: int

    @property
    def certified(self) -> bool:
        return self.unproved == 0

    def part(self, vertices: slice) -> "Keys":
        """The same keys for some of the vertices."""
        return Keys(tuple(Key(key.time, key.points[vertices]) for key in self.keys), self.unproved)


def frames_of(link: Link, iterate: Iterate) -> list[Frame]:
    """The ends of an iterate's legs, or the iterate itself where there are none, as Blender will store them."""
    ends = iterate.path or (iterate.curve.vertices,)
    return [link.to_stored(iterate.curve.mesh, end).astype(np.float32) for end in ends]


class Motion:
    """The frames of a relaxation in the numbers that Blender will store, collected as they come.

    All have as many points as the last one: where edges are split on the way, those of earlier frames are split too, at
    the same fractions. ``first``: the start as it is stored already, where keys are added to others.
    """

    def __init__(self, link: Link, first: Frame | None = None) -> None:
        self._link, self._first = link, first
        self._start: Iterate | None = None
        self._last: Iterate | None = None
        self._keys: list[Key] = []
        self._ends: list[int] = []  # positions of the iterates among the keys; the others are inner ends of legs
        self._steps: list[float] = []  # sizes of the steps that led to the iterates

    def add(self, iterate: Iterate) -> None:
        """Append an iterate with its legs; raises MobiusFlowError if its mesh differs by more than split edges."""
        if self._last is not None and iterate.curve.mesh != self._last.curve.mesh:
            self._split(iterate.curve)
        frames = frames_of(self._link, iterate)
        if self._start is None and self._first is not None:
            frames = [self._first]
        for frame in frames if self._keys else ():
            held = list(iterate.pins)
            frame[held] = self._keys[-1].points[held]  # rounding them anew might move them
        self._start = self._start or iterate
        self._last = iterate
        times = self._leg_times(iterate.index, frames)
        self._keys += map(Key, times, frames)
        self._ends.append(len(self._keys) - 1)
        self._steps.append(iterate.step_size if iterate.index else 0.0)

    def _split(self, finer: Curve) -> None:
        """Split the edges of all frames as those of the last iterate are split in a finer curve."""
        mesh, pieces = self.last.curve.mesh, subdivision(self.last.curve, finer)
        if pieces is None:
            raise MobiusFlowError(
                "keyframes need the same vertices throughout; relax with mesh='fixed' or mesh='finer'"
            )
        self._start = replace(self.start, curve=subdivide(self.start.curve, pieces))
        for k, key in enumerate(self._keys):
            points = subdivide(Curve(key.points, mesh), pieces).vertices
            self._keys[k] = replace(key, points=points.astype(np.float32))

    def _leg_times(self, index: int, frames: Sequence[Frame]) -> list[float]:
        """End times of the legs, so that the fastest vertex keeps its speed from leg to leg."""
        if len(frames) == 1:
            return [float(index)]
        corners = [self._common(frame) for frame in (self._keys[-1].points, *frames)]
        ways = [float(np.abs(b - a).max()) for a, b in pairwise(corners)]
        passed = np.cumsum(np.maximum(ways, 1e-3 * (max(ways) or 1.0)))
        return [*(index - 1 + passed[:-1] / passed[-1]).tolist(), float(index)]

    def keys(self, free: Proof, limit: int | None = None, pace: Pace = Pace.ITERATE) -> Keys:
        """Choose the keys of an animation from the start to the last iterate.

        ``free``: ``free(mesh, start, end)`` proves a straight motion free of contact; ``limit``: wanted number of keys,
        at least 2, spread evenly over the frames; None keys every iterate. Keys are added beyond it where the straight
        motion from one to the next cannot be proved; ``pace``: what passes evenly from frame to frame.
        """
        chosen = self._spread(limit, pace)
        keys, unproved = [self._keys[chosen[0]]], int(not self._rounds_freely(self.start, 0, free))
        for a, b in pairwise(chosen):
            for key, proved in self._way(a, b, free):
                keys.append(key)
                unproved += not proved
        return Keys(tuple(keys), unproved)

    def result(self, free: Proof) -> Keys:
        """Return the last iterate alone; it counts as proved if the way there and its rounding were."""
        proved = self.last.certified and self._rounds_freely(self.last, -1, free)
        return Keys((self._keys[-1],), int(not proved))

    def course(self, keys: Keys) -> Course:
        """How far the relaxation has come at each of some keys.

        The way is measured along all that was recorded: thinning changes no key's frame.
        """
        times = [key.time for key in keys.keys]
        recorded, whole = [key.time for key in self._keys], self._course
        columns = (whole.iterates, whole.distance, whole.flow_time)
        return Course(*(np.interp(times, recorded, column) for column in columns))

    @property
    def _course(self) -> Course:
        """How far the relaxation has come at each of the recorded frames."""
        times = np.array([key.time for key in self._keys])
        ways = [_way(self._common(a.points), self._common(b.points)) for a, b in pairwise(self._keys)]
        flow_time = np.interp(times, times[self._ends], np.cumsum(self._steps))
        return Course(times, np.concatenate([[0.0], np.cumsum(ways)]), flow_time)

    @property
    def start(self) -> Iterate:
        assert self._start is not None, "a relaxation yields at least its start"
        return self._start

    @property
    def frame(self) -> Frame:
        """The last iterate's vertices as Blender will store them."""
        return self._keys[-1].points

    @property
    def last(self) -> Iterate:
        assert self._last is not None, "a relaxation yields at least its start"
        return self._last

    def _spread(self, limit: int | None, pace: Pace) -> list[int]:
        """Positions of the iterates nearest to so many evenly spread frames; several may have the same."""
        if limit is None or limit >= len(self._ends):
            return self._ends
        passed = self._course.share(pace)[self._ends]
        places = np.interp(np.linspace(0, 1, max(limit, 2)), passed, np.arange(len(passed))).round().astype(int)
        places[0], places[-1] = 0, len(passed) - 1
        return [self._ends[k] for k in np.unique(places)]

    def _way(self, a: int, b: int, free: Proof) -> Iterator[tuple[Key, bool]]:
        """Yield the keys after position ``a`` up to ``b``, each with whether the motion to it was proved."""
        if self._proved(self._keys[a], self._keys[b], free):
            yield self._keys[b], True
        elif b - a == 1:
            halves = self._halves(self._keys[a], self._keys[b], free, _HALVINGS)
            yield from ((key, True) for key in halves) if halves else ((self._keys[b], False),)
        else:
            # An iterate makes a better key than the inner end of a leg.
            inside = [k for k in self._ends if a < k < b] or range(a + 1, b)
            middle = inside[len(inside) // 2]
            yield from self._way(a, middle, free)
            yield from self._way(middle, b, free)

    def _halves(self, start: Key, end: Key, free: Proof, depth: int) -> list[Key]:
        """Keys that lead along one leg in shorter pieces, each proved; empty if that fails."""
        if depth == 0:
            return []
        middle = 0.5 * (start.points.astype(np.float64) + end.points.astype(np.float64))
        middle_key = Key(0.5 * (start.time + end.time), middle.astype(np.float32))
        keys: list[Key] = []
        for a, b in ((start, middle_key), (middle_key, end)):
            part = [b] if self._proved(a, b, free) else self._halves(a, b, free, depth - 1)
            if not part:
                return []
            keys += part
        return keys

    def _proved(self, start: Key, end: Key, free: Proof) -> bool:
        return free(self.start.curve.mesh, self._common(start.points), self._common(end.points))

    def _rounds_freely(self, iterate: Iterate, position: int, free: Proof) -> bool:
        """Whether rounding an iterate to the numbers that Blender stores pushes nothing through anything."""
        mesh = iterate.curve.mesh
        exact = self._link.to_stored(mesh, iterate.curve.vertices)
        return free(mesh, self._common(exact), self._common(self._keys[position].points))

    def _common(self, points: Frame | FloatArray) -> FloatArray:
        """Stored points where motions are proved; shape (n, 3)."""
        return self._link.to_common(self.start.curve.mesh, points)


def _way(a: FloatArray, b: FloatArray) -> float:
    """Root mean square over the vertices of the way from one frame to another."""
    return float(np.sqrt(np.square(b - a).sum(axis=1).mean()))
