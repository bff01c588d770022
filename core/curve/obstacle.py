"""What a curve must not touch: still surfaces of triangles, and polylines."""

import hashlib
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from ..base import OBSTACLE, BoolArray, CurveError, FloatArray, IntArray, Message, checked, frozen, real

NAMELESS = "obstacle"
MAX_COORDINATE = 1e40  # and the inverse of the smallest size of a curve: even seventh powers of both are still numbers


@dataclass(frozen=True, eq=False)
class Obstacle:
    """A set of triangles and segments in space, which share vertices.

    A segment among triangles is one that names a vertex twice. Triangles whose vertices are in a line are welcome, for
    meshes have some. So are open meshes, meshes that cross themselves, and triangles of either orientation: there is no
    inside and no outside.

    ``vertices``, shape (k, 3), are in the user's units, ``faces`` indices of each simplex's vertices, shape (f, 3) for
    triangles or (f, 2) for segments.  Raises CurveError if there is no simplex, a coordinate is not finite or too
    large, an index has no vertex, or a shape or type is wrong; the message says which, counted from 1.
    """

    vertices: FloatArray
    faces: IntArray
    name: str

    @checked
    def __init__(self, vertices: npt.ArrayLike, faces: npt.ArrayLike, name: str = NAMELESS) -> None:
        try:
            points, simplices = real(vertices), np.array(faces)
        except (TypeError, ValueError, OverflowError) as error:
            raise CurveError(f"{name}: vertices and faces must be arrays of numbers: {error}") from error
        if points.ndim != 2 or points.shape[1] != 3:
            raise CurveError(f"{name}: vertices have shape {points.shape}; they must be an array (k, 3)")
        if simplices.ndim != 2 or simplices.shape[1] not in (2, 3) or not len(simplices):
            raise CurveError(f"{name}: faces have shape {simplices.shape}; they must be an array (f, 3) or (f, 2)")
        if simplices.dtype.kind not in "iu":
            raise CurveError(f"{name}: faces are of type {simplices.dtype}; they must be whole numbers")
        sizes = np.abs(points).max(axis=1)
        bad = np.flatnonzero(~(sizes <= MAX_COORDINATE))  # NaN is not
        if bad.size:
            place = ", ".join(f"{x:.6g}" for x in points[bad[0]])
            finite = np.isfinite(sizes[bad[0]])
            reason = f"beyond {MAX_COORDINATE:g}; use a larger unit of length" if finite else "not finite"
            raise CurveError(f"{name}: vertex {bad[0] + 1}, ({place}), is {reason}")
        bad = np.flatnonzero(((simplices < 0) | (simplices >= len(points))).any(axis=1))
        if bad.size:
            where = f"face {bad[0] + 1} has vertices {simplices[bad[0]].tolist()}"
            raise CurveError(f"{name}: {where}, counted from 0; there are {len(points)}")
        object.__setattr__(self, "vertices", frozen(points))
        object.__setattr__(self, "faces", frozen(simplices.astype(np.intp)))
        object.__setattr__(self, "name", name)

    def __repr__(self) -> str:
        return f"<Obstacle {self.name!r:.40}: {len(self.faces)} faces, {len(self.vertices)} vertices>"

    @cached_property
    def key(self) -> bytes:
        """The same for obstacles that are in the same place, whatever they are called."""
        parts = (str(self.faces.shape).encode(), self.vertices.tobytes(), self.faces.tobytes())
        return hashlib.blake2b(b"".join(parts)).digest()

    @property
    def title(self) -> Message:
        """What sentences call it."""
        return Message(NAMELESS) if self.name == NAMELESS else Message(OBSTACLE, name=self.name)

    @cached_property
    def corners(self) -> FloatArray:
        """The simplices' vertices, shape (f, 3, 3) or (f, 2, 3)."""
        return frozen(self.vertices[self.faces])

    @property
    def triangles(self) -> FloatArray:
        """Corners of the triangles proper, shape (t, 3, 3)."""
        return np.asarray(self.corners[~self._are_segments].reshape(-1, 3, 3))

    @property
    def segments(self) -> FloatArray:
        """Ends of the segments, and twice the same of what is a point; shape (s, 2, 3)."""
        named = self.faces[self._are_segments]
        return np.asarray(self.vertices[np.stack([named.min(axis=1), named.max(axis=1)], axis=1)])

    @property
    def _are_segments(self) -> BoolArray:
        i, j, k = self.faces[:, [0, 1, -1]].T
        return np.asarray((i == j) | (j == k) | (k == i))

    @cached_property
    def size(self) -> float:
        """The largest coordinate, in the user's units and without its sign."""
        return float(np.abs(self.vertices).max())
