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
from ...core.types import FloatArray
from ...core.verify.transition import DifferentCurveError, common_vertices
from .interpolation import Markers, interpolated
from .key_options import Course, Pace, Timing
from .placement import Frame, Link
from .size import Measure, Size

Proof = Callable[[Mesh, FloatArray, FloatArray], bool]

_HALVINGS = 5  # of one leg; its keys are then still further apart in time than Blender can resolve
_MANY, _CUTS = 120, 8  # keys with which a rounded motion looks smooth, and at most so many for each that there is
_BIT = 0.01  # of the least energy: falls far below this are not visible
_TINY = 1e-300


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
        return Keys(tuple(Key(key.time, key.points[vertices]) for key in self.keys), self.unproved)


def frames_of(link: Link, iterate: Iterate) -> list[Frame]:
    """The ends of an iterate's legs, or the iterate itself where there are none, as Blender will store them."""
    ends = iterate.path or (iterate.curve.vertices,)
    return [link.to_stored(iterate.curve.mesh, end).astype(np.float32) for end in ends]


class Motion:
    """The frames of a relaxation in the numbers that Blender will store, collected as they come.

    All keys have as many points: where the mesh changes on the way, vertices and points on edges, see `Markers`.
    ``first``: the start as already stored, where keys are added to others; ``measure``: what stays constant,
    see `engine.size`; lengths are left to the flow.
    """

    def __init__(self, link: Link, first: Frame | None = None, measure: Measure = Measure.LENGTH) -> None:
        self._link, self._first, self._measure = link, first, measure
        self._size: Size | None = None
        self._start: Curve | None = None
        self.last: Iterate | None = None  # as it is shown
        self._reached: list[Curve] = []  # the iterates in their own size
        self._shapes: list[Key] = []  # what was recorded, each on the mesh that there was:
        self._stages: list[int] = []  # its number
        self._meshes: list[Mesh] = []
        self._markers: list[Markers] = []  # of each component
        self._ways: list[float] = []  # from each to the next, see `_way`
        self._ends: list[int] = []  # positions of the iterates among the shapes; the others are inner ends of legs
        self._steps: list[float] = []  # sizes of the steps that led to the iterates
        self._energies: list[float] = []

    def add(self, iterate: Iterate) -> None:
        """Append an iterate with its legs; raises MobiusFlowError if none lead to it, and it is not the last one.

        An iterate of the same number is replaced, and those after it are dropped: a drag was taken back.
        """
        if 0 < iterate.index < len(self._ends):
            self._go_back(iterate.index)
        if not self._reached and self._measure is not Measure.LENGTH:
            self._size = Size.of(self._measure, iterate.curve)
        if self._size is not None and self._reached:  # what a hand has pinned stays where it is
            self._size = replace(self._size, like=(self._size.like or self._reached[-1]) if iterate.pins else None)
        shown = iterate if self._size is None else self._size.given_to_iterate(iterate)
        frames = frames_of(self._link, shown)
        if not self._reached:
            self._start, self._mesh = shown.curve, iterate.curve.mesh
            self._meshes.append(self._mesh)
            self._markers = list(map(Markers, self._mesh.component_sizes, self._mesh.closed))
            frames = frames if self._first is None else [self._first]
            ways = []
        elif iterate.path:
            held = list(shown.pins)
            for frame in frames:
                frame[held] = self._shapes[-1].points[held]  # rounding them anew might move them
            corners = [self._link.to_common(self._meshes[-1], each) for each in (self._shapes[-1].points, *frames)]
            ways = [_way(a, b) for a, b in pairwise(corners)]
        else:
            self._change(self._reached[-1], iterate.curve, frames[0])
            ways = [0.0]
        self.last = shown
        self._reached.append(iterate.curve)
        self._shapes += map(Key, _leg_times(iterate.index, ways), frames)
        self._ways += ways
        self._stages += len(frames) * [len(self._meshes) - 1]
        self._ends.append(len(self._shapes) - 1)
        self._steps.append(iterate.step_size if iterate.index else 0.0)
        self._energies.append(iterate.energy)

    def unsized(self, point: FloatArray) -> FloatArray:
        """The point of the relaxation, shape (3,), that appears at a given one in the size of the last frame."""
        if self._size is None or not self._reached:
            return point
        return self._size.taken_from(point, self._reached[-1])

    def _go_back(self, index: int) -> None:
        """Forget the iterates from a number on, and the meshes that came with them."""
        del self._ends[index:], self._steps[index:], self._energies[index:], self._reached[index:]
        del self._shapes[self._ends[-1] + 1 :], self._stages[self._ends[-1] + 1 :], self._ways[self._ends[-1] :]
        del self._meshes[self._stages[-1] + 1 :]
        for markers, size in zip(self._markers, self._meshes[-1].component_sizes, strict=True):
            markers.back(self._stages[-1], size)
        self._mesh = Mesh(tuple(map(len, self._markers)), self._meshes[-1].closed)

    def _change(self, old: Curve, new: Curve, frame: Frame) -> None:
        """Go on to another mesh; vertices that stay keep their stored coordinates."""
        for markers, was, now in zip(self._markers, old.mesh.slices, new.mesh.slices, strict=True):
            try:
                here, there = common_vertices(old.vertices[was], new.vertices[now], markers.closed)
            except DifferentCurveError as error:
                raise MobiusFlowError(f"keyframes cannot follow a change to another curve: {error}") from error
            markers.change(here, there, now.stop - now.start)
            frame[now][there] = self._shapes[-1].points[was][here]
        self._meshes.append(new.mesh)
        sizes = tuple(map(len, self._markers))
        self._mesh = self._mesh if sizes == self._mesh.component_sizes else Mesh(sizes, new.mesh.closed)

    def keys(self, free: Proof, limit: int | None = None, pace: Pace = Pace.ITERATE) -> Keys:
        """Choose the keys of an animation from the start to the last iterate.

        ``free``: ``free(mesh, start, end)`` proves a straight motion free of contact; ``limit``: wanted number of keys,
        at least 2, spread evenly over the frames; None keys every iterate. Keys are added beyond it where the straight
        motion from one to the next cannot be proved; ``pace``: what advances evenly from frame to frame; with
        `Pace.EVEN` corners are rounded where that can be proved too.
        """
        chosen = self._spread(limit, pace)
        keys = [self._key(chosen[0])]
        unproved = int(not self._rounds_freely(self.start, keys[0], free))
        legs = self._rounded(chosen, free, limit is None) if pace is Pace.EVEN else {}
        for k, (a, b) in enumerate(pairwise(chosen)):
            for key, proved in ((key, True) for key in legs[k]) if k in legs else self._way(a, b, free):
                keys.append(key)
                unproved += not proved
        return Keys(tuple(keys), unproved)

    def _rounded(self, chosen: Sequence[int], free: Proof, more: bool) -> dict[int, list[Key]]:
        """The legs of a motion whose corners are rounded, by number, with the keys in which each goes on and ends.

        Those left out cannot be proved like that, and begin and end as they were recorded. Few are cut, if ``more``.
        """
        ends = [self._key(position) for position in chosen]
        cuts = min(_CUTS, -(-_MANY // len(ends))) if more else 1
        shown = [ends[0], *map(self._sized, _means(ends, cuts)[1:-1]), ends[-1]]
        left = list(range(len(ends) - 1))
        legs = {k: shown[k * cuts : (k + 1) * cuts + 1] for k in left}
        while left:
            k = left.pop()
            if k in legs and not all(self._proved(a, b, free) for a, b in pairwise(legs[k])):
                del legs[k]
                for beside, end, place in ((k - 1, -1, k), (k + 1, 0, k + 1)):
                    if beside in legs:
                        legs[beside][end] = ends[place]
                        left.append(beside)
        return {k: leg[1:] for k, leg in legs.items()}

    def _sized(self, mean: Key) -> Key:
        """A mean of keys, scaled to the size that the keys have."""
        if self._size is None or self._size.like is not None:
            return mean
        pieces = zip(self._link.placements, self._link.slices(self._mesh), strict=True)
        world = [place.to_world(mean.points[piece].astype(np.float64)) for place, piece in pieces]
        sized = self._size.given_to(Curve(np.concatenate(world), self._mesh)).vertices
        return Key(mean.time, self._link.to_stored(self._mesh, sized).astype(np.float32))

    def result(self, free: Proof) -> Keys:
        """Return the last iterate alone; it counts as proved if the way there and its rounding were."""
        last = Key(self._shapes[-1].time, self.frame)
        assert self.last is not None, "a relaxation yields at least its start"
        exact = Curve(self._marked(self.last.curve.vertices, -1), self._mesh)
        proved = self.last.certified and self._rounds_freely(exact, last, free)
        return Keys((last,), int(not proved))

    def course(self, keys: Keys) -> Course:
        """How far the relaxation has come at each of some keys.

        The distance is measured along everything recorded: thinning changes no key's frame.
        """
        times = [key.time for key in keys.keys]
        recorded, whole = [shape.time for shape in self._shapes], self._course
        columns = (whole.iterates, whole.distance, whole.flow_time, whole.fall)
        return Course(*(np.interp(times, recorded, column) for column in columns))

    def at(self, frame: float, timing: Timing) -> Key:
        """The shape that an animation of what was recorded so far has at a scene frame; nothing is proved of it."""
        place = np.interp(frame, timing.moments(self._course), np.arange(len(self._shapes)))
        around = [self._key(k) for k in (int(place), min(int(place) + 1, len(self._shapes) - 1))]
        part = np.array([place % 1.0])
        (points,) = interpolated(np.stack([key.points for key in around]), part).astype(np.float32)
        (time,) = interpolated(np.array([key.time for key in around]), part)
        return Key(float(time), points)

    @property
    def way(self) -> float:
        """How far the fastest vertices have gone, in sizes of the curve."""
        return float(self._course.distance[-1])

    @property
    def _course(self) -> Course:
        """How far the relaxation has come at each of the recorded frames."""
        times = np.array([shape.time for shape in self._shapes])
        reached = times[self._ends]
        flow_time = np.interp(times, reached, np.cumsum(self._steps))
        distance = np.concatenate([[0.0], np.cumsum(self._ways)])
        return Course(times, distance, flow_time, np.interp(times, reached, self._fall))

    @property
    def _fall(self) -> FloatArray:
        """By how much the logarithm of the energy above its least, and a bit, has fallen or risen up to each iterate.

        It rises on the way from one curve to another; that a finer mesh has more does not count.
        """
        energies = np.array(self._energies)
        least = int(energies.argmin())
        falling = np.minimum.accumulate(energies[: least + 1])
        rising = np.minimum.accumulate(energies[:least:-1])[::-1]
        above = np.log(np.concatenate([falling, rising]) - energies[least] + _BIT * max(abs(energies[least]), _TINY))
        changes = np.abs(np.diff(above))
        changes[least : least + 1] = 0.0
        return np.concatenate([[0.0], np.cumsum(changes)])

    @property
    def start(self) -> Curve:
        """The curve that the relaxation started from, with all points that keys have."""
        assert self._start is not None, "a relaxation yields at least its start"
        return Curve(self._marked(self._start.vertices, 0), self._mesh)

    @property
    def frame(self) -> Frame:
        """The last iterate as Blender will store it, with all points that keys have."""
        return self._key(-1).points

    def _key(self, position: int) -> Key:
        shape, stage = self._shapes[position], self._stages[position]
        return Key(shape.time, self._marked(shape.points, stage).astype(np.float32))

    def _marked(self, points: Frame | FloatArray, stage: int) -> FloatArray:
        """All markers of a polygon on the mesh of a stage."""
        mesh = self._meshes[stage]
        pieces = zip(self._markers, mesh.slices, strict=True)
        return np.concatenate([each.on(points[piece].astype(np.float64), stage) for each, piece in pieces])

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
        start, end = self._key(a), self._key(b)
        if self._proved(start, end, free):
            yield end, True
        elif b - a == 1:
            halves = self._halves(start, end, free, _HALVINGS)
            yield from ((key, True) for key in halves) if halves else ((end, False),)
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
        return free(self._mesh, self._common(start.points), self._common(end.points))

    def _rounds_freely(self, curve: Curve, key: Key, free: Proof) -> bool:
        """Whether rounding a curve to the numbers that Blender stores pushes nothing through anything."""
        exact = self._link.to_stored(self._mesh, curve.vertices)
        return free(self._mesh, self._common(exact), self._common(key.points))

    def _common(self, points: Frame | FloatArray) -> FloatArray:
        """Stored points where motions are proved; shape (n, 3)."""
        return self._link.to_common(self._mesh, points)


def _means(keys: Sequence[Key], cuts: int) -> list[Key]:
    """Cut legs between keys into ``cuts`` pieces each; average all but the first and the last key over nearby legs.

    A motion along straight lines then turns in many small corners instead of a few sharp ones; points at rest stay so.
    """
    places = np.linspace(0.0, len(keys) - 1.0, (len(keys) - 1) * cuts + 1)
    times = interpolated(np.array([key.time for key in keys]), places)
    points = interpolated(np.stack([key.points for key in keys]).astype(np.float64), places)
    for _ in range(2 * cuts**2):  # binomial means, as wide as a leg
        for values in (times, points):
            values[1:-1] = 0.25 * values[:-2] + 0.5 * values[1:-1] + 0.25 * values[2:]
    inner = [Key(float(time), shape.astype(np.float32)) for time, shape in zip(times, points, strict=True)]
    return [keys[0], *inner[1:-1], keys[-1]] if len(keys) > 1 else list(keys)


def _leg_times(index: int, ways: Sequence[float]) -> list[float]:
    """End times of an iterate's legs, so that the fastest vertex keeps its speed from leg to leg."""
    if len(ways) < 2:
        return [float(index)]
    passed = np.cumsum(np.maximum(ways, 1e-3 * (max(ways) or 1.0)))
    return [*(index - 1 + passed[:-1] / passed[-1]).tolist(), float(index)]


def _way(a: FloatArray, b: FloatArray) -> float:
    """Distance travelled by the fastest vertex between two frames, in sizes of the curve: what the eye follows."""
    size = max(np.ptp(a, axis=0).max(), np.ptp(b, axis=0).max())  # the larger one: it may just be scaled
    return float(np.linalg.norm(b - a, axis=1).max() / size)
