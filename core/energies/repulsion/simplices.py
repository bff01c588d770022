"""The potential of single triangles and segments in closed form, and how far it is analytic along a line.

    Φ(x) = ∫_T dA(y)/|x − y|³ = Ω/h       for triangles,
    Φ(x) = 2 ∫_S ds(y)/|x − y|² = 2 ψ/h    for segments,

with the solid angle Ω or the angle ψ that the simplex subtends at x, and the distance h from its plane or line.  By
tan(Ω/2) = N/D (Van Oosterom and Strackee, 1983) and tan ψ = N/D, with N proportional to h, both are a constant times
g(N², D) = atan2(N, D)/N, which is also regular beside the simplex, where x is in the plane or on the line.

Points may be after complex steps.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial.polynomial import polyval

from ...base import FloatArray, IntArray, frozen
from ...base import column_cross as cross
from ...base import column_dot as dot
from ..barrier import CONTACT
from ..clusters import ClusterTree, ranges
from ..edge_pairs import arctan2

_VALUE = [(-1.0) ** k / (2 * k + 1) for k in range(6)]  # of D g in powers of N²/D²
_SLOPE = [-((-1.0) ** k) * (k + 1) / (2 * k + 3) for k in range(6)]  # of D³ ∂g/∂N²


@dataclass(frozen=True, eq=False)
class Simplices:
    """Triangles or segments in space."""

    corners: FloatArray  # shape (3, 3, f) for triangles, (2, 3, f) for segments: corner, coordinate, simplex

    @property
    def are_triangles(self) -> bool:
        return len(self.corners) == 3

    @property
    def exponent(self) -> int:
        """p of the kernel 1/rᵖ: one more than the simplices' dimension."""
        return len(self.corners)

    @property
    def strength(self) -> float:
        """The kernel's factor, with which a plane and a line have the same potential 2π/h."""
        return 1.0 if self.are_triangles else 2.0

    @cached_property
    def sides(self) -> FloatArray:
        """Vectors from corner to corner, around triangles and along segments; shape (3, 3, f) or (1, 3, f)."""
        sides = np.roll(self.corners, -1, axis=0) - self.corners
        return frozen(sides if self.are_triangles else sides[:1])

    @cached_property
    def normals(self) -> FloatArray:
        """Normals of triangles, twice their areas long; shape (3, f)."""
        return frozen(cross(self.sides[0], self.sides[1]))

    @cached_property
    def sizes(self) -> FloatArray:
        """Areas or lengths; shape (f,)."""
        return frozen(0.5 * norm(self.normals) if self.are_triangles else norm(self.sides[0]))

    def potential(self, index: IntArray, at: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Φ and ∇Φ of the simplices ``index``, shape (k,), each at its own points, shape (3, k, points)."""
        seen = self.corners[:, :, index, None] - at
        # N², D and their gradients; at contact N and lengths are what they are 10⁻¹⁶ of the simplex's size away
        if self.are_triangles:  # N = ⟨a, b × c⟩ and D = |a||b||c| + ⟨a, b⟩|c| + ⟨b, c⟩|a| + ⟨c, a⟩|b|
            (a, b, c), normal = seen, self.normals[:, index, None]  # twice the area long
            n, width = dot(normal, a), np.sqrt(norm(normal))
            ra, rb, rc = (np.maximum(norm(corner), CONTACT * width) for corner in seen)
            bc, ca, ab = dot(b, c), dot(c, a), dot(a, b)
            slope_of_d = a * ((rb * rc + bc) / ra + rb + rc)
            slope_of_d += b * ((rc * ra + ca) / rb + rc + ra)
            slope_of_d += c * ((ra * rb + ab) / rc + ra + rb)
            square, d = np.maximum(n * n, (CONTACT * width**3) ** 2), ra * rb * rc + ab * rc + bc * ra + ca * rb
            slope_of_square, slope_of_d = -2.0 * n * normal, -slope_of_d
        else:  # N = |a × b| and D = ⟨a, b⟩
            a, b = seen
            side = b - a
            normal = cross(a, side)
            square, d = np.maximum(dot(normal, normal), (CONTACT * dot(side, side)) ** 2), dot(a, b)
            slope_of_square, slope_of_d = -2.0 * cross(side, normal), -(a + b)
        # g = atan2(N, D)/N, ∂g/∂N² = (D/(N² + D²) − g)/(2N²) and ∂g/∂D = −1/(N² + D²), from N² > 0 and D
        n, inverse = np.sqrt(square), 1.0 / (square + d * d)
        value = arctan2(n, d) / n
        by_square = (d * inverse - value) / (2.0 * square)
        # there series replace quotients by N², of which second derivatives lose six digits
        flat = (d.real > 0.0) & (square.real < 1e-3 * d.real**2)
        x, y = d[flat], square[flat] / d[flat] ** 2
        value[flat] = polyval(y, _VALUE) / x
        by_square[flat] = polyval(y, _SLOPE) / x**3
        factor = ((4.0 if self.are_triangles else 2.0) * self.sizes)[index, None]
        return factor * value, factor * (by_square * slope_of_square - inverse * slope_of_d)

    def reach(self, index: IntArray, x: FloatArray, tau: FloatArray) -> FloatArray:
        """Radii of discs |z| < reach in which z ↦ Φ(x + z τ) is analytic; x and unit vectors τ of shape (3, k).

        Ω and ψ have their singularities where the complex distance from a corner, or from the line of a side,
        vanishes; Φ has a pole where the line meets the plane.  Lines and planes count only if the foot of x is within
        the simplex: for others the corners and sides are nearer.
        """
        seen, sides = x - self.corners[:, :, index], self.sides[:, :, index]
        square = np.min([dot(a, a) for a in seen], axis=0)
        for a, side in zip(seen, sides, strict=False):
            along = dot(a, side)
            beside = (along > 0.0) & (along < dot(side, side))
            off, across = cross(a, side), cross(tau, side)
            square = np.where(beside, np.minimum(square, _quotient(dot(off, off), dot(across, across))), square)
        if self.are_triangles:
            normal = self.normals[:, index]
            pole = _quotient(dot(normal, seen[0]) ** 2, dot(normal, tau) ** 2)
            above = np.all([dot(normal, cross(side, a)) > 0.0 for side, a in zip(sides, seen, strict=True)], axis=0)
            square = np.where(above, np.minimum(square, pole), square)
        return np.asarray(np.sqrt(square))


def _quotient(numerator: FloatArray, denominator: FloatArray) -> FloatArray:
    """Their quotient, inf where the denominator is 0."""
    safe = np.where(denominator > 0.0, denominator, 1.0)
    return np.where(denominator > 0.0, numerator / safe, np.inf)


def norm(a: FloatArray) -> FloatArray:
    """√⟨a, a⟩; shapes (3, ...) -> (...)."""
    return np.asarray(np.sqrt(dot(a, a)))


@dataclass(frozen=True, eq=False)
class Clusters:
    """Clusters of simplices, halved by number across their longest extent down to single ones."""

    simplices: Simplices  # sorted: the clusters are ranges
    tree: ClusterTree  # its leaves are single simplices
    center: FloatArray  # centroids c; shape (3, clusters)
    radius: FloatArray  # of the smallest balls around the centroids that hold the clusters; shape (clusters,)
    size: FloatArray  # areas or lengths W = ∫ dA; shape (clusters,)
    spread: FloatArray  # second moments Q = ∫ (y − c)(y − c)ᵀ dA; shape (3, 3, clusters)

    @classmethod
    def of(cls, corners: FloatArray) -> "Clusters":
        """The clusters of simplices with given corners, shape (corner, coordinate, simplex)."""
        points = np.mean(corners, axis=0)
        order = np.arange(points.shape[1])

        def cut(start: IntArray, stop: IntArray) -> IntArray:
            if start.size:  # each range is sorted by the coordinate in which its points are spread the most
                count = stop - start
                places, first = ranges(start, count), np.cumsum(count) - count
                x = points[:, order[places]]
                widths = np.maximum.reduceat(x, first, axis=1) - np.minimum.reduceat(x, first, axis=1)
                owner = np.repeat(np.arange(start.size), count)
                along = x[np.argmax(widths, axis=0)[owner], np.arange(len(places))]
                order[places] = order[places][np.lexsort((along, owner))]
            return (start + stop) // 2

        tree = ClusterTree.halved(order, 1, cut)
        simplices = Simplices(frozen(np.ascontiguousarray(corners[:, :, order])))
        # sizes W, centroids c and second moments Q of all clusters, from the leaves up
        k = len(simplices.corners)
        size, center = simplices.sizes[tree.start], np.mean(simplices.corners, axis=0)[:, tree.start]
        from_center = simplices.corners[:, :, tree.start] - center
        spread = size / (k * (k + 1)) * np.einsum("aif,ajf->ijf", from_center, from_center)
        for inner, child in tree.upward():
            size[inner] = size[child] + size[child + 1]
            share = size[child + 1] / size[inner]
            between = center[:, child + 1] - center[:, child]
            center[:, inner] = center[:, child] + share * between
            apart = size[child] * share * (between[:, None] * between)
            spread[:, :, inner] = spread[:, :, child] + spread[:, :, child + 1] + apart
        radius = np.empty_like(size)
        for level in tree.levels:
            count = (tree.stop - tree.start)[level]
            members = simplices.corners[:, :, ranges(tree.start[level], count)]
            from_center = members - np.repeat(center[:, level], count, axis=1)
            square = np.max(np.einsum("cif,cif->cf", from_center, from_center), axis=0)
            radius[level] = np.sqrt(np.maximum.reduceat(square, np.cumsum(count) - count))
        return cls(simplices, tree, *map(frozen, (center, radius, size, spread)))

    def potential(self, index: IntArray, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Φ and ∇Φ of the clusters ``index``, shape (k,), each at its own points x, shape (3, k, points).

        With K = 1/rᵖ and d = x − c

            Φ ≈ W K + ½ ⟨Q, ∇²K⟩ = r⁻ᵖ (W − p/2 tr Q/r² + p (p + 2)/2 dᵀQd/r⁴).
        """
        p, d = self.simplices.exponent, x - self.center[:, index, None]
        q, half = self.spread[:, :, index, None], 0.5 * p * (p + 2)
        s = 1.0 / dot(d, d)
        kernel, q_d = self.simplices.strength * s ** (0.5 * p), q[:, 0] * d[0] + q[:, 1] * d[1] + q[:, 2] * d[2]
        size, trace, along = self.size[index, None], (q[0, 0] + q[1, 1] + q[2, 2]) * s, dot(d, q_d) * (s * s)
        radial = s * kernel * (half * trace - (p + 4) * half * along - p * size)
        return kernel * (size - 0.5 * p * trace + half * along), radial * d + (2.0 * half * s * s * kernel) * q_d
