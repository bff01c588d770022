"""What a relaxation is recorded as: its shapes in the numbers that Blender will store, their sizes and their pace."""

from collections import Counter
from dataclasses import dataclass, field, replace
from enum import Enum
from itertools import pairwise
from typing import NamedTuple, Protocol

import numpy as np

from ..base import FloatArray, MobiusFlowError
from ..curve import Curve, Mesh
from ..io.trajectory import Iterate
from ..proof.checker import RefusedError, kept_vertices
from .key_options import Course
from .markers import KEPT, Markers
from .placement import Frame, Link, Measure, Similarity


class Proof(Protocol):
    """Whether a straight motion is proved free of contact, or that of a rope if components have radii."""

    def __call__(self, mesh: Mesh, start: FloatArray, end: FloatArray, radius: FloatArray | None = None, /) -> bool: ...


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
    radius: float = 0.0  # of the rope that the curve is proved to be all along, as shown, in the common space; or 0


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


class _Shape(NamedTuple):
    """What was recorded: a key on the mesh that there was."""

    key: Key
    stage: int  # number of its mesh
    way: float  # to it from the shape before, in sizes of the curve


class _Passed(NamedTuple):
    """An iterate among the shapes; the others are inner ends of legs."""

    place: int  # its number among the shapes
    curve: Curve  # in its own size
    like: int | None  # number of the iterate that it is shown like, as a hand has pinned something
    step: float  # size of the step that led to it
    energy: float


class Shapes:
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
        self._first_size = size or Similarity()
        self.last: Iterate | None = None
        self._radius = np.inf  # of the thinnest rope that the curve has been
        self.natural = [0]  # numbers of iterates that are shown in their own size, which changes evenly in between
        self._shapes: list[_Shape] = []
        self._passed: list[_Passed] = []
        self._meshes: list[Mesh] = []
        self._markers: list[Markers] = []  # of each component

    def add(self, iterate: Iterate) -> None:
        """Append an iterate with its legs; raises MobiusFlowError if none lead to it, and it is not the last one.

        An iterate of the same number is replaced, and those after it are dropped: a drag was taken back.
        """
        index, curve, frames = iterate.index, iterate.curve, frames_of(self._link, iterate)
        if 0 < index < len(self._passed):  # forget those from there on, and the meshes that came with them
            place = self._passed[index - 1].place
            stage = self._shapes[place].stage
            del self._passed[index:], self._shapes[place + 1 :], self._meshes[stage + 1 :]
            for markers, size in zip(self._markers, self._meshes[-1].component_sizes, strict=True):
                markers.back(stage, size)
        kind, like, ways = Kind.STEP, None, [0.0]
        if not self._passed:
            self._meshes.append(curve.mesh)
            self._markers = list(map(Markers, curve.mesh.component_sizes, curve.mesh.closed))
            frames = frames if self._first is None else [self._first]
        elif iterate.path:
            kind = Kind.STEP if iterate.strand_moves is None or iterate.strand_moves.done else Kind.MOVE
            held, mesh, before = list(iterate.pins), self._meshes[-1], self._shapes[-1].key.points
            for frame in frames:
                frame[held] = before[held]  # rounding them anew might move them
            seen = [self._link.to_common(mesh, frame) for frame in (before, *frames)]
            if self._measure is not Measure.LENGTH:  # in some size of its own: its growth is no motion
                seen = [Similarity.giving(self._measure, 1.0, Curve(each, mesh)).of(each) for each in seen]
            # what the eye follows: the fastest vertex, in sizes of the curve, the larger one, as it may just be scaled
            sizes = [np.ptp(each, axis=0).max() for each in seen]
            moved = [np.linalg.norm(b - a, axis=1).max() for a, b in pairwise(seen)]
            ways = [float(way / max(pair)) for way, pair in zip(moved, pairwise(sizes), strict=True)]
        else:  # another mesh, on which vertices that stay keep their stored coordinates
            kind, old, before = Kind.MESH, self._passed[-1].curve, self._shapes[-1].key.points
            for markers, was, now in zip(self._markers, old.mesh.slices, curve.mesh.slices, strict=True):
                first, second = (list(map(tuple, x.tolist())) for x in (old.vertices[was], curve.vertices[now]))
                try:
                    here, there = kept_vertices(first, second, markers.closed)
                except RefusedError as error:
                    raise MobiusFlowError(f"keyframes cannot follow a change to another curve: {error}") from error
                markers.change(here, there, now.stop - now.start)
                frames[0][now][there] = before[was][here]
            self._meshes.append(curve.mesh)
        if iterate.pins and self._passed:
            like = len(self._passed) - 1 if self._passed[-1].like is None else self._passed[-1].like
        times = [float(index)]
        if len(ways) > 1:  # the fastest vertex keeps its speed from leg to leg
            along = np.cumsum(np.maximum(ways, 1e-3 * (max(ways) or 1.0)))
            times = [*(index - 1 + along[:-1] / along[-1]).tolist(), *times]
        for time, frame, way in zip(times, frames, ways, strict=True):
            key = Key(time, frame, kind if time == index else Kind.ADDED)
            self._shapes.append(_Shape(key, len(self._meshes) - 1, way))
        self._radius = min(self._radius, min(iterate.radius or (0.0,)) / self._link.placements[0].stretch)
        step = iterate.step_size if index and kind is not Kind.MOVE else 0.0
        self._passed.append(_Passed(len(self._shapes) - 1, curve, like, step, iterate.energy))
        self._mesh, self.last = Mesh(tuple(map(len, self._markers)), curve.mesh.closed), iterate

    @property
    def way(self) -> float:
        """How far the fastest vertices have gone, in sizes of the curve."""
        return float(self._course.distance[-1])

    @property
    def size(self) -> Similarity:
        """How the last iterate is shown."""
        return self._size(len(self._passed) - 1)

    @property
    def start(self) -> Curve:
        """The curve that the relaxation started from, with all points that keys have."""
        return Curve(self._marked(self._passed[0].curve.vertices, 0), self._mesh)

    @property
    def shown(self) -> Key:
        """The last iterate as it is shown, with all points that keys have."""
        return self._in_view(self._key(-1))

    @property
    def _course(self) -> Course:
        """How far the relaxation has come at each of the recorded shapes."""
        times = np.array([shape.key.time for shape in self._shapes])
        places = [each.place for each in self._passed]
        flow_time = np.interp(times, times[places], np.cumsum([each.step for each in self._passed]))
        ways = np.array([shape.way for shape in self._shapes])
        moves = np.repeat([self._shapes[k].key.kind is Kind.MOVE for k in places], np.diff(places, prepend=-1))
        # by how much the logarithm of the energy above its least, and a bit (less is not visible), has fallen or risen:
        # it rises on the way from one curve to another; that a finer mesh has more does not count
        energies = np.array([each.energy for each in self._passed])
        least = int(energies.argmin())
        falling = np.minimum.accumulate(energies[: least + 1])
        rising = np.minimum.accumulate(energies[:least:-1])[::-1]
        above = np.log(np.concatenate([falling, rising]) - energies[least] + 0.01 * max(abs(energies[least]), 1e-300))
        changes = np.abs(np.diff(above))
        changes[least : least + 1] = 0.0
        fall = np.interp(times, times[places], np.concatenate([[0.0], np.cumsum(changes)]))
        return Course(times, np.cumsum(ways), flow_time, fall, np.cumsum(moves * ways))

    def _key(self, place: int) -> Key:
        """A shape with all points that keys have."""
        key, stage, _ = self._shapes[place]
        points = self._marked(key.points, stage).astype(np.float32)
        return replace(key, points=points, size=self._size(key.time, points if key.time % 1.0 else None))

    def _marked(self, points: Frame | FloatArray, stage: int) -> FloatArray:
        """All markers of a polygon on the mesh of a stage."""
        pieces = zip(self._markers, self._meshes[stage].slices, strict=True)
        return np.concatenate([each.on(points[piece].astype(np.float64), stage) for each, piece in pieces])

    def _size(self, time: float, points: Frame | None = None) -> Similarity:
        """How an iterate is shown, or stored points in between."""
        if self._measure is Measure.LENGTH:
            return self._first_size
        number = int(np.ceil(time))
        if (like := self._passed[number].like) is not None:
            time, number, points = like, like, None
        natural = [self._measure.of(self._passed[k].curve) for k in self.natural]
        wanted = self._first_size.factor * np.exp(np.interp(time, self.natural, np.log(natural)))
        curve = (
            self._passed[number].curve if points is None else Curve(self._link.to_world(self._mesh, points), self._mesh)
        )
        return Similarity.giving(self._measure, float(wanted), curve)

    def _shown(self, points: Frame | FloatArray, size: Similarity) -> FloatArray:
        """Points as stored, (n, 3), in the size in which they are shown."""
        pieces = zip(self._link.placements, self._link.slices(self._mesh), strict=True)
        shown = [each.similarity(size).of(points[piece].astype(np.float64)) for each, piece in pieces]
        return np.concatenate(shown)

    def _stored(self, key: Key) -> Key:
        """A key as it is stored: where nothing but points can be keyed, they are those shown."""
        shown = self._in_view(key)
        return shown if self._in_points else replace(key, radius=shown.radius)

    def _in_view(self, key: Key) -> Key:
        """A key with points and rope in the size in which they are shown."""
        points, radius = self._shown(key.points, key.size).astype(np.float32), KEPT * self._radius * key.size.factor
        return replace(key, points=points, size=Similarity(), radius=radius)
