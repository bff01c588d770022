"""Groups of isometries that map a curve to about itself, and the exactly symmetric polygons near it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..curve import Curve, Mesh
from ..curve.smooth import at_shares
from ..types import FloatArray, IntArray
from .action import Symmetry
from .isometry import Isometry
from .names import multiplication, schoenflies

TURNS = 4  # of a mean that converges quadratically
ROUNDING = 1e-9  # of an edge, which is what images of symmetric vertices are off at most


@dataclass(frozen=True, eq=False)
class SymmetryGroup:
    """A finite group of isometries, the identity first, with its name after Schoenflies: C1, C3, D2, S4, Td, …"""

    name: str
    centre: FloatArray  #: the curve's barycenter, which all of them leave in place; shape (3,)
    elements: tuple[Isometry, ...]

    @classmethod
    def of(cls, elements: Sequence[Isometry], centre: FloatArray) -> "SymmetryGroup":
        return cls(schoenflies(np.stack([each.matrix for each in elements])), centre, tuple(elements))

    def __repr__(self) -> str:
        return f"<SymmetryGroup {self.name}, {self.distance:.2g} radii of gyration off>"

    @property
    def distance(self) -> float:
        """The largest of its elements': how far an image is from the curve, root mean square, in radii of gyration."""
        return max(each.distance for each in self.elements)

    @property
    def matrices(self) -> FloatArray:
        """Orthogonal matrices that are those of the elements, but multiply as a group does; shape (k, 3, 3)."""
        found = np.stack([each.matrix for each in self.elements])
        table = multiplication(found)
        for _ in range(TURNS):
            u, _, v = np.linalg.svd(np.einsum("ghij,hkj->gik", found[table], found))
            found = u @ v
        return found

    def subgroup(self, name: str) -> "SymmetryGroup | None":
        """The one of that name whose elements are nearest to symmetries of the curve; None if there is none."""
        named = [SymmetryGroup.of([self.elements[k] for k in each], self.centre) for each in self._subgroups()]
        return min((each for each in named if each.name == name), key=lambda each: each.distance, default=None)

    def _subgroups(self) -> Iterator[list[int]]:
        """The elements' numbers, ascending, of all subgroups."""
        table = multiplication(np.stack([each.matrix for each in self.elements]))
        found = new = {frozenset([0])}
        while new:
            yield from map(sorted, new)
            found = found | new
            new = {_generated({*each, g}, table) for each in new for g in range(len(table)) if g not in each} - found

    def symmetrised(self, curve: Curve, sizes: Sequence[int]) -> tuple[Curve, Symmetry, tuple[float, ...]]:
        """The mean of a curve's images, on a mesh of at least so many vertices, spread evenly over each component.

        With it come the group's action, and the share of each component at which its first vertex was.  A curve whose
        vertices are symmetric keeps them.
        """
        symmetry = Symmetry(self.name, self.centre, self.matrices).on(curve)
        if symmetry.error(curve) < ROUNDING:
            return self._mean(curve, symmetry), symmetry, (0.0,) * len(sizes)
        counts, begins, steps = self._spread(sizes)
        mesh = Mesh(tuple(counts.tolist()))
        parts = zip(curve.components, begins, counts, strict=True)
        points = np.concatenate([at_shares(part, True, (b + np.arange(n) / n) % 1.0) for part, b, n in parts])
        images = np.empty((len(self.elements), mesh.size), dtype=np.intp)
        for row, each in zip(images, self.elements, strict=True):
            turns = np.rint(steps * (each.signs * begins + each.shifts - begins[each.order])).astype(np.intp)
            for c, (n, sign, turn) in enumerate(zip(counts, each.signs, turns * (counts // steps), strict=True)):
                row[mesh.slices[c]] = mesh.offsets[each.order[c]] + (sign * np.arange(n) + turn) % n
        symmetry = Symmetry(self.name, self.centre, self.matrices, images)
        return self._mean(Curve(points, mesh), symmetry), symmetry, tuple(begins.tolist())

    def _spread(self, sizes: Sequence[int]) -> tuple[IntArray, FloatArray, IntArray]:
        """Numbers of vertices that the group permutes, where the first ones are, and how often components are turned.

        Each is for each component, the places as shares of their lengths.
        """
        counts, begins, steps = np.array(sizes), np.zeros(len(sizes)), np.ones(len(sizes), dtype=np.intp)
        orders, signs, shifts = (
            np.stack([getattr(each, name) for each in self.elements]) for name in ("order", "signs", "shifts")
        )
        for c in range(len(sizes)):
            orbit = np.unique(orders[:, c])
            if orbit[0] < c:
                continue
            own = orders[:, c] == c
            rotations, reversals = own & (signs[:, c] > 0), np.flatnonzero(own & (signs[:, c] < 0))
            # rotations along the curve are by multiples of 1/k, but of a plane one reflections keep all points
            turns = np.abs((shifts[rotations, c] + 0.5) % 1.0 - 0.5)
            k = len(turns) // np.count_nonzero(turns < 0.5 / len(turns))
            begins[c] = shifts[reversals[0], c] / 2.0 if len(reversals) else 0.0
            for e in orbit[orbit > c]:
                g = np.flatnonzero(orders[:, c] == e)[0]
                begins[e] = (signs[g, c] * begins[c] + shifts[g, c]) % 1.0
            counts[orbit], steps[orbit] = -(-counts[orbit].max() // k) * k, k
        return counts, begins, steps

    def _mean(self, curve: Curve, symmetry: Symmetry) -> Curve:
        return curve.with_vertices(self.centre + symmetry.mean(curve.vertices - self.centre))


def _generated(elements: set[int], table: IntArray) -> frozenset[int]:
    """The subgroup that elements generate."""
    size = 0
    while len(elements) > size:
        size, own = len(elements), list(elements)
        elements = set(table[np.ix_(own, own)].ravel().tolist())
    return frozenset(elements)
