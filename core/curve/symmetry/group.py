"""Groups of isometries that map a curve nearly to itself, how they are found and named, and symmetric polygons nearby.

Names are Schoenflies symbols of finite groups: C3, D2, S4, Td, …
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...base import CurveError, FloatArray, IntArray, check_number, checked
from .. import Curve, Mesh, check_closed
from ..alignment import Freedom, alignments
from ..refine import at_shares
from .action import Fit, Isometry, Symmetry

IS_NAME = re.compile(r"C[1-9]\d*[vh]?|S[1-9]\d*|D[2-9][dh]?|D[1-9]\d+[dh]?|C[si]|T[dh]?|Oh?|Ih?")
_POLYHEDRAL = {(12, 3): "T", (24, 4): "O", (60, 5): "I"}  # by the number of rotations and their largest order
TOLERANCE = 0.02  # radii of gyration: relaxed and balanced polygons are some .002 off
DISTINCT = 0.15  # norm of the difference between matrices of distinct elements


@dataclass(frozen=True, eq=False)
class SymmetryGroup:
    """A finite group of isometries, the identity first, with its name after Schoenflies: C1, C3, D2, S4, Td, …"""

    name: str
    centre: FloatArray  #: the curve's barycenter, which all elements leave in place; shape (3,)
    elements: tuple[Isometry, ...]

    @classmethod
    def of(cls, elements: Sequence[Isometry], centre: FloatArray) -> "SymmetryGroup":
        return cls(schoenflies(np.stack([each.matrix for each in elements])), centre, tuple(elements))

    def __repr__(self) -> str:
        return f"<SymmetryGroup {self.name}, {self.distance:.2g} radii of gyration off>"

    @property
    def distance(self) -> float:
        """The largest distance of an element's image from the curve, root mean square, in radii of gyration."""
        return max(each.distance for each in self.elements)

    @property
    def matrices(self) -> FloatArray:
        """Orthogonal matrices, those of the elements adjusted to multiply as a group does; shape (k, 3, 3)."""
        found = np.stack([each.matrix for each in self.elements])
        table = multiplication(found)
        for _ in range(4):  # the mean converges quadratically
            u, _, v = np.linalg.svd(np.einsum("ghij,hkj->gik", found[table], found))
            found = u @ v
        return found

    def subgroup(self, name: str) -> "SymmetryGroup | None":
        """The subgroup of that name whose elements are nearest to symmetries of the curve; None if there is none."""
        table = multiplication(np.stack([each.matrix for each in self.elements]))
        named, found, new = [], set[frozenset[int]](), {frozenset([0])}
        while new:
            groups = [SymmetryGroup.of([self.elements[k] for k in sorted(each)], self.centre) for each in new]
            named += [each for each in groups if each.name == name]
            found, before = found | new, new
            new = {_generated({*each, g}, table) for each in before for g in range(len(table)) if g not in each} - found
        return min(named, key=lambda each: each.distance, default=None)

    def symmetrised(self, curve: Curve, sizes: Sequence[int]) -> tuple[Curve, Symmetry, tuple[float, ...]]:
        """The mean of a curve's images, on a mesh of at least ``sizes`` vertices, spread evenly over each component.

        With it come the group's action, and the share of each component at which its first vertex was.  A curve whose
        vertices are symmetric keeps them.
        """
        symmetry = Symmetry(self.name, self.centre, self.matrices).on(curve)
        if symmetry.error(curve) < 1e-9:  # of an edge: rounding
            return self._mean(curve, symmetry), symmetry, (0.0,) * len(sizes)
        # of each component: a number of vertices that the group permutes, the place of the first one, a share of the
        # length, and the number of turns along the curve
        counts, begins, steps = np.array(sizes), np.zeros(len(sizes)), np.ones(len(sizes), dtype=np.intp)
        actions = zip(*((g.order, g.signs, g.shifts) for g in self.elements), strict=True)
        orders, signs, shifts = map(np.stack, actions)
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

    def _mean(self, curve: Curve, symmetry: Symmetry) -> Curve:
        return curve.with_vertices(self.centre + symmetry.mean(curve.vertices - self.centre))


def _generated(elements: set[int], table: IntArray) -> frozenset[int]:
    """The subgroup that elements generate."""
    size = 0
    while len(elements) > size:
        size, own = len(elements), list(elements)
        elements = set(table[np.ix_(own, own)].ravel().tolist())
    return frozenset(elements)


def multiplication(matrices: FloatArray) -> IntArray:
    """The numbers of g·h by those of g and h, in a group of approximate matrices, shape (k, 3, 3); shape (k, k)."""
    products = np.einsum("gij,hjk->ghik", matrices, matrices)
    return np.asarray(np.einsum("ghij,kij->ghk", products, matrices).argmax(axis=2))  # ⟨A, B⟩ is 3 where they agree


def schoenflies(matrices: FloatArray) -> str:
    """The name of a group of approximate orthogonal matrices, the identity first; shape (k, 3, 3).

    Its rotations form one of C_n, D_n, T, O and I, and the number of mirror planes decides the rest.
    """
    table = multiplication(matrices)
    proper = np.linalg.det(matrices) > 0.0
    count, n = int(np.count_nonzero(proper)), max(order_of(table, g) for g in np.flatnonzero(proper).tolist())
    improper = zip(np.flatnonzero(~proper).tolist(), np.trace(matrices[~proper], axis1=1, axis2=2), strict=True)
    mirrors = sum(trace > 0.0 and order_of(table, g) == 2 for g, trace in improper)  # an inversion has -3
    if (count, n) in _POLYHEDRAL:
        more = "" if proper.all() else "h" if (count, mirrors) != (12, 6) else "d"
        return _POLYHEDRAL[count, n] + more
    if count == 2 * n:
        return f"D{n}" + ("" if proper.all() else "h" if mirrors > n else "d")
    if proper.all():
        return f"C{n}"
    if n == 1:
        return "Cs" if mirrors else "Ci"
    return f"C{n}v" if mirrors == n else f"C{n}h" if mirrors else f"S{2 * n}"


def order_of(table: IntArray, element: int) -> int:
    power, order = element, 1
    while power:
        power, order = int(table[power, element]), order + 1
    return order


@checked
def symmetries(curve: Curve, tolerance: float = TOLERANCE) -> SymmetryGroup:
    """Find the isometries that map a closed curve in space to itself, but for a tolerance in radii of gyration.

    The directions of components do not matter, nor does their order.  Möbius images of a symmetric curve are symmetric
    only where they are balanced (``--balance``).  Coaxial circles have the group C∞v or D∞h, of which only the identity
    is among the elements here.

    Raises CurveError if a component is open, or the curve is in another dimension or has over 10 components.
    """
    check_number("tolerance", tolerance, 0.0, 1.0)
    check_closed(curve, "symmetries")
    components = len(curve.mesh.component_sizes)
    if curve.dimension != 3:
        raise CurveError(f"the curve is in dimension {curve.dimension}; symmetries are for curves in space")
    if components > 10:  # for so many all orders are looked at in a second
        raise CurveError(f"the curve has {components} components; symmetries are found with up to 10")
    centre = curve.barycenter
    ones = np.ones(components, dtype=np.intp)
    identity = Isometry(np.eye(3), np.arange(components), ones, np.zeros(components), 0.0)
    fit = Fit(curve, centre)
    mirrored = curve.with_vertices(2.0 * centre - curve.vertices)
    near = [
        Isometry.of(alignment, sign)
        for sign, other in ((1, curve), (-1, mirrored))
        for alignment in alignments(curve, other, Freedom(fixed=centre))
        if alignment.distance < tolerance + fit.coarseness
    ]
    if (axis := fit.axis_of_rotation(tolerance)) is not None:
        flips = any(each.matrix @ axis @ axis < -1.0 + DISTINCT for each in near)
        return SymmetryGroup("D∞h" if flips else "C∞v", centre, (identity,))
    elements = [identity]
    for each in sorted(map(fit, near), key=lambda each: each.distance):
        if each.distance <= tolerance and not _has(elements, each):
            elements = _closed([*elements, each], fit, tolerance) or elements
    return SymmetryGroup.of(elements, centre)


def _closed(
    elements: Sequence[Isometry], fit: Callable[[Isometry], Isometry], tolerance: float
) -> list[Isometry] | None:
    """All products of elements; None if some are not symmetries within the tolerance, or there are too many."""
    found = list(elements)
    for k, one in enumerate(found):  # which grows
        for other in found[: k + 1]:
            for product in (one.after(other), other.after(one)):
                if not _has(found, product):
                    fitted = fit(product)
                    # the icosahedron's group has 120 elements; only round curves have more
                    if fitted.distance > tolerance or len(found) == 120:
                        return None
                    found.append(fitted)
    return found


def _has(elements: Sequence[Isometry], one: Isometry) -> bool:
    return any(np.linalg.norm(each.matrix - one.matrix) < DISTINCT for each in elements)
