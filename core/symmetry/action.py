"""A finite group of isometries as it acts on the vertices of a mesh: those of an orbit are one unknown.

A symmetric polygon's energy, metric and lengths are symmetric, so that gradients are as well (Palais, The principle of
symmetric criticality, 1979): what is left to do is to take rounding off, by means over the group.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.spatial import cKDTree

from ..curve import Curve, Mesh
from ..types import FloatArray, IntArray

FIXED = 1e-3


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
        """Whether a vector of length 1 or less is where all isometries take it, but for what minimisers leave open."""
        return not len(self) or bool(np.abs(self.matrices @ v - v).max() < FIXED)

    def error(self, curve: Curve) -> float:
        """How far an image is from the vertex it should be, at most, in lengths of the shortest edge."""
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
