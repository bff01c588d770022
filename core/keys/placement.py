"""Where objects are, places on them, and the size in which moving curves are shown.

Each object keeps points in coordinates of its own; the motions of all are proved in one space.

The flow keeps lengths, but viewers may want the size kept instead.  Each key is shown scaled by a factor of its own
about a centre of its own, which makes no contact: factors and the images of the origin are linear in between, and so is
the motion, and at each moment it is one common similarity of all points.
Where scaled points themselves are keyed, the straight motion between keys A and B scaled by a, b > 0 is

    (1 − t) a A + t b B = ((1 − t) a + t b) ((1 − u) A + u B),    u = t b / ((1 − t) a + t b),

up to a translation: the straight motion from A to B, passed at another pace and seen at another size.  What remains to
be proved then, as always, is what rounding to Blender's numbers makes of it.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from itertools import accumulate, pairwise

import numpy as np
import numpy.typing as npt

from ..base import TINY, FloatArray, Place
from ..curve import Curve, Mesh

Frame = npt.NDArray[np.float32]


class Measure(Enum):
    """The quantity that stays constant; the values are its names for people."""

    LENGTH = "Length"
    BOX = "Bounding Box"
    RADIUS = "Radius"

    def of(self, curve: Curve) -> float:
        """How large a curve is: its length, the longest side of its box, or its radius of gyration."""
        if self is Measure.LENGTH:
            return curve.length
        if self is Measure.BOX:
            return float(np.ptp(curve.vertices, axis=0).max())
        away = np.square(curve.midpoints - curve.barycenter).sum(axis=1) + curve.edge_lengths**2 / 12
        return float(np.sqrt(curve.edge_lengths @ away / curve.length))


@dataclass(frozen=True, eq=False)
class Similarity:
    """The map x ↦ shift + factor · x."""

    factor: float = 1.0
    shift: FloatArray = field(default_factory=lambda: np.zeros(3))  # shape (3,)

    @classmethod
    def about(cls, center: FloatArray, factor: float) -> "Similarity":
        return cls(factor, (1.0 - factor) * center)

    @classmethod
    def giving(cls, measure: Measure, size: float, curve: Curve) -> "Similarity":
        """The one about its barycenter that gives a curve a size."""
        center = curve.barycenter
        return cls.about(np.pad(center, (0, 3 - len(center))), size / measure.of(curve))

    def after(self, other: "Similarity") -> "Similarity":
        """The similarity that is the other one and then this."""
        return Similarity(self.factor * other.factor, self.of(other.shift))

    @property
    def is_identity(self) -> bool:
        return self.factor == 1.0 and not self.shift.any()

    def of(self, points: FloatArray) -> FloatArray:
        """Points, (n, 3), as they are shown; the same array if that is where they are."""
        return points if self.is_identity else np.asarray(self.shift + self.factor * points)

    def undone(self, point: FloatArray) -> FloatArray:
        """The point, shape (3,), that is shown at a given one."""
        return np.asarray((point - self.shift) / self.factor)


@dataclass(frozen=True, eq=False)
class Placement:
    """The affine map from an object's coordinates to the world's, x_world = origin + linear · x_local."""

    linear: FloatArray
    origin: FloatArray

    @classmethod
    def from_matrix(cls, matrix: npt.ArrayLike) -> "Placement":
        """The affine map that a matrix describes in homogeneous coordinates; shape (4, 4)."""
        linear_and_origin = np.array(matrix, dtype=np.float64)[:3]
        return cls(linear_and_origin[:, :3], linear_and_origin[:, 3])

    def equals(self, other: "Placement") -> bool:
        """Whether both are the same, bit for bit."""
        return np.array_equal(self.linear, other.linear) and np.array_equal(self.origin, other.origin)

    @cached_property
    def _is_identity(self) -> bool:
        return np.array_equal(self.linear, np.eye(3)) and not self.origin.any()

    def to_world(self, points: FloatArray) -> FloatArray:
        """Points of the object in the world; shape (n, 3)."""
        # no BLAS: the same bits in Blender and in its worker; for the identity the points with the signs of their zeros
        return points if self._is_identity else np.asarray(np.einsum("nj,ij->ni", points, self.linear) + self.origin)

    def to_local(self, points: FloatArray) -> FloatArray:
        """Points of the world in the object; shape (n, 3)."""
        return points if self._is_identity else np.asarray(np.linalg.solve(self.linear, (points - self.origin).T).T)

    def similarity(self, size: Similarity) -> Similarity:
        """A similarity of the world in the object's coordinates."""
        return Similarity(size.factor, self.to_local(self.origin * size.factor + size.shift[None])[0])

    def in_world(self, size: Similarity) -> Similarity:
        """A similarity of the object's coordinates in the world."""
        return Similarity(size.factor, self.to_world(size.shift[None])[0] - size.factor * self.origin)

    @property
    def stretch(self) -> float:
        """The largest factor by which the object's coordinates are stretched on the way to the world."""
        return float(np.linalg.norm(self.linear, 2))

    def relative_to(self, base: "Placement") -> "Placement":
        """The affine map from this object's coordinates to another's; the identity if they are the same."""
        same = np.array_equal(self.linear, base.linear)
        linear = np.eye(3) if same else np.asarray(np.linalg.solve(base.linear, self.linear))
        return Placement(linear, np.asarray(np.linalg.solve(base.linear, self.origin - base.origin)))


@dataclass(frozen=True, eq=False)
class Link:
    """One or more objects whose splines form one link.

    Blender rounds points in each object's own coordinates. What is proved about all of them together is proved in
    one common space, the coordinates of the first object: the rounded points, mapped there in doubles. Invertible
    affine maps create no contact and undo none, so what is free there is free in the world, and for a single object
    wherever that object goes.
    """

    placements: tuple[Placement, ...]  # one for each object
    counts: tuple[int, ...]  # number of components of the link that each object has; they are numbered object by object

    @cached_property
    def _to_first(self) -> tuple[Placement, ...]:
        return tuple(placement.relative_to(self.placements[0]) for placement in self.placements)

    @cached_property
    def scales(self) -> tuple[float, ...]:
        """The largest factor by which each object's coordinates are stretched on the way to the common space."""
        return tuple(placement.stretch for placement in self._to_first)

    def slices(self, mesh: Mesh) -> tuple[slice, ...]:
        """The vertices of each object."""
        ends = [int(mesh.offsets[k]) for k in accumulate(self.counts, initial=0)]
        return tuple(slice(a, b) for a, b in pairwise(ends))

    def split(self, curve: Curve) -> Iterator[Curve]:
        """Yield each object's components as a curve of their own."""
        for a, b in pairwise(accumulate(self.counts, initial=0)):
            yield Curve.from_components(curve.components[a:b], curve.mesh.closed[a:b])

    def to_stored(self, mesh: Mesh, vertices: FloatArray) -> FloatArray:
        """From the world to each object's own coordinates; (n, 2) or (n, 3) to (n, 3)."""
        points = np.pad(vertices, ((0, 0), (0, 3 - vertices.shape[1])))
        pieces = zip(self.placements, self.slices(mesh), strict=True)
        return np.concatenate([placement.to_local(points[s]) for placement, s in pieces])

    def to_world(self, mesh: Mesh, stored: FloatArray | Frame) -> FloatArray:
        """From each object's own coordinates to the world; shape (n, 3)."""
        pieces = zip(self.placements, self.slices(mesh), strict=True)
        return np.concatenate([placement.to_world(stored[s].astype(np.float64)) for placement, s in pieces])

    def to_common(self, mesh: Mesh, stored: FloatArray | Frame) -> FloatArray:
        """From each object's own coordinates to the common space; shape (n, 3)."""
        return Link(self._to_first, self.counts).to_world(mesh, stored)

    def from_world(self, points: FloatArray) -> FloatArray:
        """From the world to the common space; shape (n, 3)."""
        return Placement(np.eye(3), np.zeros(3)).relative_to(self.placements[0]).to_world(points)


@dataclass(frozen=True, eq=False)
class Origin:
    """Where a curve's object is put and how it is scaled: x_world = location + scale · x_local."""

    location: FloatArray
    scale: float

    @classmethod
    def of(cls, curve: Curve) -> "Origin":
        """The origin for a curve: neither moved nor scaled if it has everyday size and is near the origin."""
        size = float(np.ptp(curve.vertices, axis=0).max())
        middle = np.zeros(3)
        middle[: curve.dimension] = 0.5 * (curve.vertices.min(axis=0) + curve.vertices.max(axis=0))
        scale = 1.0 if 1e-3 <= size <= 1e3 else float(2.0 ** np.round(np.log2(size)))
        near = np.abs(middle).max() <= 8.0 * size  # further away 32 bits are few
        return cls(np.zeros(3) if near and scale == 1.0 else middle.astype(np.float32).astype(float), scale)

    def link(self, mesh: Mesh) -> Link:
        return Link((Placement(self.scale * np.eye(3), self.location),), (len(mesh.component_sizes),))


@dataclass(frozen=True, eq=False)
class Spot:
    """Points of one object."""

    member: int  # number of the object among those that are relaxed together
    points: FloatArray  # the points to select, in the object's coordinates; shape (k, 3)
    marks: FloatArray  # the places to mark, likewise; one for the object that has the place, none for others


def spots(place: Place, curve: Curve, link: Link) -> list[Spot]:
    """The spots of a place on a curve in the world, object by object, the one with the mark first."""
    vertices = list(place.vertices)
    if not vertices:  # the nearest one
        vertices = [int(np.linalg.norm(curve.vertices - place.position, axis=1).argmin())]
    stored = link.to_stored(curve.mesh, curve.vertices)
    members = [next(k for k, part in enumerate(link.slices(curve.mesh)) if v < part.stop) for v in vertices]
    mark = link.placements[members[0]].to_local(np.array([place.position]))
    return [
        Spot(
            member,
            stored[[v for v, owner in zip(vertices, members, strict=True) if owner == member]],
            mark if member == members[0] else mark[:0],
        )
        for member in dict.fromkeys(members)
    ]


def at(points: FloatArray, wanted: FloatArray) -> FloatArray:
    """Which points, (n, 3), are nearest to one of those wanted, (k, 3), or coincide with such a point; shape (n,)."""
    distances = np.linalg.norm(points[:, None] - wanted[None], axis=2)
    return np.asarray((distances <= distances.min(axis=0)).any(axis=1))


def framed(curve: Curve, across: float = 0.9, curled: float = 1.2, most: int = 600) -> FloatArray:
    """The points that a picture is made around, (n, 3): ends of ropes with a knot in them are drawn in.

    The knot is between the first and the last point of a rope that is nearer to another one than all beside both, where
    strands cross, at an angle whose cosine is less than ``across``, if the rope is longer there than that part's box is
    across, by the factor ``curled``, as cables that pass each other are not; ends may reach from it as far as the box.
    About ``most`` points are looked at.
    """
    points, mesh = curve.vertices.copy(), curve.mesh
    if mesh.all_closed:
        return points
    some = np.unique(np.concatenate([mesh.ends.ravel(), np.arange(0, len(points), 1 + len(points) // most)]))
    at, own, inner = points[some], mesh.component[some], ~np.isin(some, mesh.ends)
    along = np.roll(at, -1, axis=0) - np.roll(at, 1, axis=0)
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), TINY)
    apart = np.linalg.norm(at[:, None] - at, axis=2)
    least = (abs(along @ along.T) < across) & inner[:, None] & inner & (apart > 0.0)
    for axis in (0, 1):
        for step in (-1, 1):
            least &= apart <= np.roll(apart, step, axis)
    crossing = least.any(axis=1)
    for k, (piece, closed) in enumerate(zip(mesh.slices, mesh.closed, strict=True)):
        knot = some[crossing & (own == k)] - piece.start
        if closed or not len(knot):
            continue
        part, first, last = points[piece], knot[0], knot[-1]
        size = float(np.linalg.norm(np.ptp(part[first : last + 1], axis=0)))
        if np.linalg.norm(np.diff(part[first : last + 1], axis=0), axis=1).sum() <= curled * size:
            continue
        for end, tied in ((part[:first], part[first]), (part[last + 1 :], part[last])):
            away = end - tied
            far = np.linalg.norm(away, axis=1, keepdims=True)
            end[:] = tied + away * np.minimum(1.0, size / np.maximum(far, size))
    return points
