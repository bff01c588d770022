"""Isometries that map a closed curve nearly to itself, and a finite group of them as it acts on a mesh's vertices.

The vertices of an orbit are one unknown. A symmetric polygon's energy, metric and lengths are symmetric, so that
gradients are as well (Palais, The principle of symmetric criticality, 1979): it only remains to remove rounding, by
means over the group.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from ...base import FloatArray, IntArray
from .. import Curve, Mesh
from ..alignment import SAMPLES, Alignment
from ..refine import at_shares


@dataclass(frozen=True, eq=False)
class Symmetry:
    """x ↦ centre + Q_g (x − centre) takes vertex i to vertex ``images[g, i]``, for each of k isometries g.

    The centre is in the user's units.
    """

    name: str = ""
    centre: FloatArray = field(default_factory=lambda: np.empty(0))  # shape (3,)
    matrices: FloatArray = field(default_factory=lambda: np.empty((0, 3, 3)))  # Q, orthogonal; shape (k, 3, 3)
    images: IntArray = field(default_factory=lambda: np.empty((0, 0), dtype=np.intp))  # shape (k, n)

    def __len__(self) -> int:
        return len(self.matrices)

    def mean(self, u: FloatArray) -> FloatArray:
        """The symmetric part of displacements or forces, the orthogonal projection; shape (n, 3, …)."""
        if not len(self):
            return u
        total = np.zeros_like(u)
        for matrix, image in zip(self.matrices, self.images, strict=True):
            total += np.einsum("ij,ni...->nj...", matrix, u[image])
        return total / len(self)

    def within(self, hessian: FloatArray, gram: FloatArray) -> FloatArray:
        """H where displacements are symmetric, and the metric A ⊗ Id on the others, to which it is orthogonal.

        H has shape (n·3, n·3), A shape (n, n).
        """
        if not len(self):
            return hessian
        metric, shape = np.kron(gram, np.eye(3)), (len(gram), 3, -1)
        beyond = hessian - metric
        for _ in range(2):
            beyond = self.mean(beyond.reshape(shape)).reshape(hessian.shape).T
        return np.asarray(metric + beyond)

    def fixes(self, v: FloatArray) -> bool:
        """Whether all isometries leave a vector of length 1 or less in place, up to what minimisers leave open."""
        return not len(self) or bool(np.abs(self.matrices @ v - v).max() < 1e-3)

    def error(self, curve: Curve) -> float:
        """The largest distance of an image from the vertex it should be, in lengths of the shortest edge."""
        arms = curve.vertices - self.centre
        off = arms @ self.matrices.transpose(0, 2, 1) - arms[self.images]
        return float(np.abs(off).max() / curve.edge_lengths.min())

    def on(self, curve: Curve) -> "Symmetry":
        """The same on another mesh of a symmetric curve."""
        if not len(self):
            return self
        arms = curve.vertices - self.centre
        images = cKDTree(arms).query(arms @ self.matrices.transpose(0, 2, 1))[1]
        return Symmetry(self.name, self.centre, self.matrices, images)

    def most(self, pieces: IntArray, mesh: Mesh) -> IntArray:
        """The most pieces of an edge in each orbit of edges, shape (edges,); components are closed."""
        if not len(self):
            return pieces
        tails, heads = self.images, self.images[:, mesh.cycle]
        return np.asarray(pieces[np.where(mesh.cycle[tails] == heads, tails, heads)].max(axis=0))


NO_SYMMETRY = Symmetry()


@dataclass(frozen=True, eq=False)
class Isometry:
    """x ↦ centre + Q (x − centre), which takes the point at share s of component c to ``signs[c]`` s + ``shifts[c]``.

    That is a share of the length of component ``order[c]``.  ``distance`` is the distance of the image from the curve,
    root mean square, in radii of gyration.
    """

    matrix: FloatArray  # Q, orthogonal; shape (3, 3)
    order: IntArray
    signs: IntArray
    shifts: FloatArray
    distance: float = np.inf

    @classmethod
    def of(cls, alignment: Alignment, sign: int) -> "Isometry":
        """The isometry of an alignment of a curve with itself, or (−1) with its reflection in its centre."""
        signs = np.where(alignment.backwards, -1, 1)
        return cls(sign * alignment.rotation, np.array(alignment.order), signs, signs * np.array(alignment.begins))

    def after(self, first: "Isometry") -> "Isometry":
        """The composition of this one after another one."""
        signs = self.signs[first.order]
        shifts = (signs * first.shifts + self.shifts[first.order]) % 1.0
        return Isometry(self.matrix @ first.matrix, self.order[first.order], signs * first.signs, shifts)


class Fit:
    """The isometry nearest to a given one that maps a curve nearly to itself, by the Gauss-Newton method."""

    def __init__(self, curve: Curve, centre: FloatArray) -> None:
        self._parts = [part - centre for part in curve.components]
        self._shares = np.arange(SAMPLES) / SAMPLES
        self._x = np.stack([at_shares(part, True, self._shares) for part in self._parts])
        self._squares = float(np.square(self._x).sum())

    @property
    def coarseness(self) -> float:
        """Half the distance between samples, in radii of gyration: those of an alignment may miss each other by it."""
        apart = np.linalg.norm(self._x - np.roll(self._x, 1, axis=1), axis=2).max()
        return 0.5 * float(apart * np.sqrt(len(self._parts) * SAMPLES / self._squares))

    def __call__(self, near: Isometry) -> Isometry:
        matrix, shifts = near.matrix, near.shifts
        for _ in range(4):
            y = self._images(near.order, near.signs, shifts)
            x, slopes = self._x @ matrix.T, 0.5 * SAMPLES * (np.roll(y, -1, axis=1) - np.roll(y, 1, axis=1))
            # x + a × x − y − slope δ, in the turn a and the shifts δ, which on torus knots are hard to tell apart
            turns = np.cross(np.eye(3), x.reshape(-1, 1, 3)).transpose(0, 2, 1).reshape(-1, 3)
            slides = np.einsum("c,cki,ce->ckie", near.signs, slopes, np.eye(len(y))).reshape(len(turns), -1)
            found = np.linalg.lstsq(np.hstack([turns, -slides]), (y - x).ravel(), rcond=None)[0]
            matrix, shifts = Rotation.from_rotvec(found[:3]).as_matrix() @ matrix, shifts + found[3:]
        missing = self._x @ matrix.T - self._images(near.order, near.signs, shifts)
        distance = float(np.sqrt(np.square(missing).sum() / self._squares))
        return Isometry(matrix, near.order, near.signs, shifts % 1.0, distance)

    def axis_of_rotation(self, tolerance: float) -> FloatArray | None:
        """The axis about which small rotations move the curve along itself, up to less than a tolerance per radian.

        The tolerance is in radii of gyration; None if there is no such axis.
        """
        arc = SAMPLES // 32  # over which tangents are taken, so that polygons of many edges are as good as round
        tangents = np.roll(self._x, -arc, axis=1) - np.roll(self._x, arc, axis=1)
        tangents /= np.linalg.norm(tangents, axis=2)[:, :, None]
        fields = np.cross(np.eye(3), self._x[:, :, None])  # a × x for the axes a
        fields -= np.einsum("ckai,cki->cka", fields, tangents)[..., None] * tangents[:, :, None]
        values, vectors = np.linalg.eigh(np.einsum("ckai,ckbi->ab", fields, fields))
        return np.asarray(vectors[:, 0]) if values[0] < tolerance**2 * self._squares else None

    def _images(self, order: Sequence[int] | IntArray, signs: IntArray, shifts: FloatArray) -> FloatArray:
        """Where the samples go along the curve; shape (components, samples, 3)."""
        places = (signs[:, None] * self._shares + shifts[:, None]) % 1.0
        return np.stack([at_shares(self._parts[c], True, s) for c, s in zip(order, places, strict=True)])
