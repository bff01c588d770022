"""Which frames of a relaxation to key, so that the straight lines between the keys are proved too.

The relaxation certifies its own path in doubles. Blender keeps keys as 32-bit floats and moves points straight
from one key to the next: another path, which needs its own proof, in the numbers that Blender stores. Keys are the
iterates themselves; others come in between where a straight motion is not proved, or would be seen to turn sharply.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from itertools import pairwise
from typing import ClassVar

import numpy as np
from scipy.interpolate import PchipInterpolator

from ..base.errors import MobiusFlowError
from ..base.types import FloatArray
from ..curve import Curve, Mesh
from ..curve.refine import Markers, interpolated
from ..io.trajectory import Iterate
from ..proof.checker import RefusedError, kept_vertices
from .key_options import Course, Timing
from .placement import Frame, Link, Measure, Origin, Similarity

Proof = Callable[[Mesh, FloatArray, FloatArray], bool]


class Kind(Enum):
    """What a key shows; the values are beginnings of names of shape keys."""

    STEP = "Step"  # an iterate of the descent, or the start
    MOVE = "Strand Move"
    MESH = "Mesh"  # an iterate that changes the mesh and moves nothing
    ADDED = "Between"  # iterates, for a proof or a smooth motion


@dataclass(frozen=True, eq=False)
class Key:
    """One key: the time, counted in iterates (2.5 is halfway from iterate 2 to 3), and the vertices, (n, 3)."""

    time: float
    points: Frame
    kind: Kind = Kind.ADDED
    size: Similarity = field(default_factory=Similarity)  # by which it is shown, in the world


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

    @property
    def kinds(self) -> Counter[Kind]:
        """How many keys there are of each kind."""
        return Counter(key.kind for key in self.keys)

    @property
    def moves(self) -> list[bool]:
        """Whether the way to each key belongs to a strand move."""
        kinds = [key.kind for key in self.keys]
        for k in range(len(kinds) - 2, -1, -1):
            kinds[k] = kinds[k + 1] if kinds[k] is Kind.ADDED else kinds[k]
        return [kind is Kind.MOVE for kind in kinds]

    def part(self, vertices: slice) -> "Keys":
        return Keys(tuple(replace(key, points=key.points[vertices]) for key in self.keys), self.unproved)


def frames_of(link: Link, iterate: Iterate) -> list[Frame]:
    """The ends of an iterate's legs, or the iterate itself where there are none, as Blender will store them."""
    ends = iterate.path or (iterate.curve.vertices,)
    return [link.to_stored(iterate.curve.mesh, end).astype(np.float32) for end in ends]


class Recording:
    """The frames of a relaxation in the numbers that Blender will store, collected as they come.

    All keys have as many points: where the mesh changes on the way, vertices and points on edges, see `Markers`.
    ``measure``: what stays constant of how they are shown, see `placement`; lengths are left to the flow. Where keys
    are added to others, ``first`` is the last of these as stored, and ``size`` how it is shown. ``in_points``: keyed
    points are those shown, since nothing else can be keyed.
    """

    def __init__(
        self,
        link: Link,
        first: Frame | None = None,
        measure: Measure = Measure.LENGTH,
        size: Similarity | None = None,
        in_points: bool = False,
    ) -> None:
        self._link, self._first, self._measure, self._in_points = link, first, measure, in_points
        self._first_size = size
        self._start: Curve | None = None
        self.last: Iterate | None = None
        self.natural = [0]  # numbers of iterates that are shown in their own size, which changes evenly in between
        self._shapes: list[Key] = []  # what was recorded, each on the mesh that there was:
        self._stages: list[int] = []  # its number
        self._meshes: list[Mesh] = []
        self._markers: list[Markers] = []  # of each component
        self._ways: list[float] = []  # from each to the next, in sizes of the curve
        self._ends: list[int] = []  # positions of the iterates among the shapes; the others are inner ends of legs
        self._curves: list[Curve] = []  # the iterates in their own size
        self._like: list[int | None] = []  # numbers of others that they are shown like, as a hand has pinned something
        self._steps: list[float] = []  # sizes of the steps that led to the iterates
        self._energies: list[float] = []

    def add(self, iterate: Iterate) -> None:
        """Append an iterate with its legs; raises MobiusFlowError if none lead to it, and it is not the last one.

        An iterate of the same number is replaced, and those after it are dropped: a drag was taken back.
        """
        index, curve, frames = iterate.index, iterate.curve, frames_of(self._link, iterate)
        if 0 < index < len(self._ends):  # forget those from there on, and the meshes that came with them
            del self._ends[index:], self._steps[index:], self._energies[index:], self._curves[index:]
            del self._like[index:]
            del self._shapes[self._ends[-1] + 1 :], self._stages[self._ends[-1] + 1 :], self._ways[self._ends[-1] :]
            del self._meshes[self._stages[-1] + 1 :]
            for markers, size in zip(self._markers, self._meshes[-1].component_sizes, strict=True):
                markers.back(self._stages[-1], size)
            self._mesh = Mesh(tuple(map(len, self._markers)), self._meshes[-1].closed)
        kind, like, ways = Kind.STEP, None, list[float]()
        if not self._curves:
            self._start, self._mesh = curve, curve.mesh
            self._meshes.append(self._mesh)
            self._markers = list(map(Markers, self._mesh.component_sizes, self._mesh.closed))
            frames = frames if self._first is None else [self._first]
        elif iterate.path:
            kind = Kind.STEP if iterate.strand_moves is None or iterate.strand_moves.done else Kind.MOVE
            held, mesh = list(iterate.pins), self._meshes[-1]
            for frame in frames:
                frame[held] = self._shapes[-1].points[held]  # rounding them anew might move them
            seen = [self._link.to_common(mesh, frame) for frame in (self._shapes[-1].points, *frames)]
            if self._measure is not Measure.LENGTH:  # in some size of its own: its growth is no motion
                seen = [Similarity.giving(self._measure, 1.0, Curve(each, mesh)).of(each) for each in seen]
            for a, b in pairwise(seen):  # what the eye follows: the fastest vertex, in sizes of the curve
                size = max(np.ptp(a, axis=0).max(), np.ptp(b, axis=0).max())  # the larger one: it may just be scaled
                ways.append(float(np.linalg.norm(b - a, axis=1).max() / size))
        else:  # another mesh, on which vertices that stay keep their stored coordinates
            kind, ways = Kind.MESH, [0.0]
            old = self._curves[-1]
            for markers, was, now in zip(self._markers, old.mesh.slices, curve.mesh.slices, strict=True):
                try:
                    first, second = (
                        [*map(tuple, points.tolist())] for points in (old.vertices[was], curve.vertices[now])
                    )
                    here, there = kept_vertices(first, second, markers.closed)
                except RefusedError as error:
                    raise MobiusFlowError(f"keyframes cannot follow a change to another curve: {error}") from error
                markers.change(here, there, now.stop - now.start)
                frames[0][now][there] = self._shapes[-1].points[was][here]
            self._meshes.append(curve.mesh)
            sizes = tuple(map(len, self._markers))
            self._mesh = self._mesh if sizes == self._mesh.component_sizes else Mesh(sizes, curve.mesh.closed)
        if iterate.pins and self._curves:
            like = len(self._curves) - 1 if self._like[-1] is None else self._like[-1]
        times = [float(index)]
        if len(ways) > 1:  # the fastest vertex keeps its speed from leg to leg
            passed = np.cumsum(np.maximum(ways, 1e-3 * (max(ways) or 1.0)))
            times = [*(index - 1 + passed[:-1] / passed[-1]).tolist(), *times]
        self.last = iterate
        self._curves.append(curve)
        self._like.append(like)
        self._shapes += map(Key, times, frames, [Kind.ADDED] * (len(times) - 1) + [kind])
        self._ways += ways
        self._stages += len(frames) * [len(self._meshes) - 1]
        self._ends.append(len(self._shapes) - 1)
        self._steps.append(iterate.step_size if index and kind is not Kind.MOVE else 0.0)
        self._energies.append(iterate.energy)

    @property
    def size(self) -> Similarity:
        """How the last iterate is shown."""
        return self._size(len(self._curves) - 1)

    def _size(self, time: float, points: Frame | None = None) -> Similarity:
        """How an iterate is shown, or stored points in between."""
        number = int(np.ceil(time))
        if (like := self._like[number]) is not None:
            return self._size(like)
        first = self._first_size or Similarity()
        if self._measure is Measure.LENGTH:
            return first
        natural = [self._measure.of(self._curves[k]) for k in self.natural]
        wanted = first.factor * np.exp(np.interp(time, self.natural, np.log(natural)))
        curve = self._curves[number]
        if points is not None:
            pieces = zip(self._link.placements, self._link.slices(self._mesh), strict=True)
            world = [each.to_world(points[piece].astype(np.float64)) for each, piece in pieces]
            curve = Curve(np.concatenate(world), self._mesh)
        return Similarity.giving(self._measure, float(wanted), curve)

    def keys(self, free: Proof, limit: int | None = None, timing: Timing | None = None) -> Keys:
        """Choose the keys of an animation from the start to the last iterate.

        ``free``: ``free(mesh, start, end)`` proves a straight motion free of contact; ``limit``: wanted number of keys,
        at least 2, spread over the iterates as over the frames of an even motion; None keys every iterate. More are
        added where the straight motion from one to the next cannot be proved, and, if every iterate is keyed, where
        ``timing`` leaves room: on interpolating curves through the iterates, where that can be proved. By default they
        are no more than half of all, but for short runs.
        """
        most = len(self._ends) if timing is None else timing.most_keys
        if len(self._ends) > most:
            limit = int(most) if limit is None else min(limit, int(most))
        chosen = self._ends
        if limit is not None and limit < len(chosen):  # as evenly spread over an even motion as can be
            passed = self._course.evenly[self._ends]
            places = np.interp(np.linspace(0, 1, max(limit, 2)), passed, np.arange(len(passed))).round().astype(int)
            places[0], places[-1] = 0, len(passed) - 1
            number = np.arange(len(places))
            later = np.maximum.accumulate(places - number) + number
            chosen = [self._ends[k] for k in np.minimum(later, len(passed) - len(places) + number)]
        ends = [self._key(position) for position in chosen]
        start = self._link.to_stored(self._mesh, self.start.vertices)
        unproved = int(not self._proved(start, ends[0].points, free))  # rounding may push something through another
        keys, between = [self._stored(ends[0])], dict[int, list[Key]]()
        if timing is not None and len(ends) > 1:
            steps = sum(key.kind is Kind.STEP for key in ends)
            # with 120 keys a motion looks smooth
            room = (max(120, 2 * steps) if limit is None else limit) - len(ends)
            room = max(room, 0) if len(ends) == len(self._ends) else 0
            frames = timing.frames(self.course(Keys(tuple(ends), 0)))
            gaps, spacing = np.diff(frames), 1.0  # no nearer than a frame
            while (pieces := np.ceil(gaps / spacing - 1e-3)).sum() - len(gaps) > room:
                spacing *= 1.05
            for k in np.flatnonzero(pieces > 1).tolist():
                near = slice(max(k - 1, 0), k + 3)  # the slopes at both ends need one more key on either side
                shares = np.arange(1, int(pieces[k])) / pieces[k]
                shapes = np.stack([key.points for key in ends[near]]).astype(np.float64)
                # curves that overshoot in no coordinate
                points = PchipInterpolator(frames[near], shapes)(frames[k] + shares * gaps[k]).astype(np.float32)
                times = ends[k].time + shares * (ends[k + 1].time - ends[k].time)
                between[k] = [Key(float(time), shape) for time, shape in zip(times, points, strict=True)]
        for k, (a, b) in enumerate(pairwise(chosen)):
            added = (replace(key, size=self._size(key.time, key.points)) for key in between.get(k, ()))
            smooth = [*map(self._stored, (*added, ends[k + 1]))]
            if all(self._proved(one.points, other.points, free) for one, other in pairwise([keys[-1], *smooth])):
                keys += smooth
                continue
            for key, proved in self._way(a, b, free):
                keys.append(key)
                unproved += not proved
        return Keys(tuple(keys), unproved)

    def _stored(self, key: Key) -> Key:
        """A key as it is stored: where nothing but points can be keyed, they are those shown."""
        if not self._in_points or key.size.is_identity:
            return key
        return replace(key, points=self._shown(key.points, key.size).astype(np.float32), size=Similarity())

    def _shown(self, points: Frame | FloatArray, size: Similarity) -> FloatArray:
        """Points as stored, (n, 3), in the size in which they are shown."""
        pieces = zip(self._link.placements, self._link.slices(self._mesh), strict=True)
        shown = [each.similarity(size).of(points[piece].astype(np.float64)) for each, piece in pieces]
        return np.concatenate(shown)

    def result(self, free: Proof) -> Keys:
        """Return the last iterate alone; it counts as proved if the way there and its rounding were."""
        last = self._stored(key := self._key(-1))
        assert self.last is not None, "a relaxation yields at least its start"
        exact = self._link.to_stored(self._mesh, self._marked(self.last.curve.vertices, -1))
        exact = self._shown(exact, key.size) if self._in_points else exact
        proved = self.last.certified and self._proved(exact, last.points, free)
        return Keys((last,), int(not proved))

    def course(self, keys: Keys) -> Course:
        """How far the relaxation has come at each of some keys.

        The distance is measured along everything recorded: thinning changes no key's frame.
        """
        return self._course.at(np.array([key.time for key in keys.keys]))

    def at(self, frame: float, timing: Timing) -> Key:
        """The shape that an animation of what was recorded so far has at a scene frame; nothing is proved of it."""
        place = np.interp(frame, timing.moments(self._course), np.arange(len(self._shapes)))
        around = [self._key(k) for k in (int(place), min(int(place) + 1, len(self._shapes) - 1))]
        part = np.array([place % 1.0])
        (points,) = interpolated(np.stack([self._shown(key.points, key.size) for key in around]), part)
        (time,) = interpolated(np.array([key.time for key in around]), part)
        return Key(float(time), points.astype(np.float32))

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
        ways = np.array([0.0, *self._ways])
        moves = np.repeat([self._shapes[k].kind is Kind.MOVE for k in self._ends], np.diff(self._ends, prepend=-1))
        # by how much the logarithm of the energy above its least, and a bit (less is not visible), has fallen or risen:
        # it rises on the way from one curve to another; that a finer mesh has more does not count
        energies = np.array(self._energies)
        least = int(energies.argmin())
        falling = np.minimum.accumulate(energies[: least + 1])
        rising = np.minimum.accumulate(energies[:least:-1])[::-1]
        above = np.log(np.concatenate([falling, rising]) - energies[least] + 0.01 * max(abs(energies[least]), 1e-300))
        changes = np.abs(np.diff(above))
        changes[least : least + 1] = 0.0
        fall = np.interp(times, reached, np.concatenate([[0.0], np.cumsum(changes)]))
        return Course(times, np.cumsum(ways), flow_time, fall, np.cumsum(moves * ways))

    @property
    def start(self) -> Curve:
        """The curve that the relaxation started from, with all points that keys have."""
        assert self._start is not None, "a relaxation yields at least its start"
        return Curve(self._marked(self._start.vertices, 0), self._mesh)

    @property
    def frame(self) -> Frame:
        """The last iterate as it is shown, with all points that keys have."""
        key = self._key(-1)
        return self._shown(key.points, key.size).astype(np.float32)

    def _key(self, position: int) -> Key:
        shape, stage = self._shapes[position], self._stages[position]
        points = self._marked(shape.points, stage).astype(np.float32)
        return replace(shape, points=points, size=self._size(shape.time, points if shape.time % 1.0 else None))

    def _marked(self, points: Frame | FloatArray, stage: int) -> FloatArray:
        """All markers of a polygon on the mesh of a stage."""
        mesh = self._meshes[stage]
        pieces = zip(self._markers, mesh.slices, strict=True)
        return np.concatenate([each.on(points[piece].astype(np.float64), stage) for each, piece in pieces])

    def _way(self, a: int, b: int, free: Proof) -> Iterator[tuple[Key, bool]]:
        """Yield the keys after position ``a`` up to ``b``, each with whether the motion to it was proved."""
        start, end = self._stored(self._key(a)), self._stored(self._key(b))
        if self._proved(start.points, end.points, free):
            yield end, True
        elif b - a == 1:
            halves = self._halves(start, end, free, 5)  # still apart in time for Blender
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
        time, points = 0.5 * (start.time + end.time), middle.astype(np.float32)
        middle_key = Key(time, points, size=Similarity() if self._in_points else self._size(time, points))
        keys: list[Key] = []
        for a, b in ((start, middle_key), (middle_key, end)):
            part = [b] if self._proved(a.points, b.points, free) else self._halves(a, b, free, depth - 1)
            if not part:
                return []
            keys += part
        return keys

    def _proved(self, start: Frame | FloatArray, end: Frame, free: Proof) -> bool:
        """Whether the straight motion between stored points is free of contact."""
        return free(self._mesh, *(self._link.to_common(self._mesh, points) for points in (start, end)))


@dataclass(frozen=True)
class Playing:
    """How a relaxation is played in a scene or a film."""

    MOVING: ClassVar = (72, 720)  # frames in motion, at least and at most
    RESTS: ClassVar = (6, 12)  # frames at rest before the motion and after it

    look: str | None = None  # one of `pictures.looks`; None: the default one, and films drawn plainly
    loop: bool = False  # there and back
    constant_radius: bool = False  # the tube is as thick at all keys as at the one where it is thinnest
    timing: Timing = field(default_factory=Timing)  # that of the keys

    def timed(self, motion: Recording) -> "Playing":
        """Let a curve move about evenly, no faster than can be followed, and rest for a moment before and after."""
        (low, high), (before, after) = self.MOVING, self.RESTS
        moving = round(min(max(20 * motion.way, low), high))  # as far as the curve is wide in 20 frames
        length = (before + moving + after) * (1 + self.loop) + (not self.loop)
        return replace(self, timing=Timing(length=length, hold_start=before, hold_end=after, loop=self.loop))


def spatial(vertices: FloatArray) -> FloatArray:
    """Vertices of a curve in the plane or in space, shape (n, 3)."""
    return np.pad(vertices, ((0, 0), (0, 3 - vertices.shape[1])))


def check_dimension(curve: Curve) -> None:
    """Raise a MobiusFlowError if a curve is not in the plane or in space."""
    if curve.dimension > 3:
        raise MobiusFlowError(f"the curve has {curve.dimension} coordinates; Blender shows curves in 2 or 3 dimensions")


def recorded(iterates: Sequence[Iterate], measure: Measure = Measure.LENGTH) -> tuple[Recording, Origin]:
    """Collect the iterates of a run in the numbers that Blender will store; raises MobiusFlowError if it cannot.

    ``measure``: what stays constant, see `Recording`.
    """
    start = iterates[0].curve
    check_dimension(start)
    origin = Origin.of(spatial(start.vertices))
    motion = Recording(origin.link(start.mesh), measure=measure, in_points=True)
    for iterate in iterates:
        motion.add(iterate)
    return motion, origin
