"""A curve that is a rope: a barrier that keeps strands two radii apart, and corners from bending tighter than one.

    E = w Σ (ℓ_I ℓ_J / r²) φ((d_IJ − 2r)/(c − 2r)) + w Σ (ℓ_I / 2r) φ((ϱ − r)/(b − r)),   φ(z) = −(1 − z)² log z,

where φ = 0 from z = 1 on. The first sum is over pairs of edges at distance d that are more than half a circle of the
radius apart along the curve, with arcs of the radius for corners; between ropes of two radii 2r is their sum. The
second is over both ends of every edge, with the bending radius ϱ = ℓ/(2 tan(θ/2)) at the corner of angle θ there
(Rawdon, Experimental Mathematics 12, 2003). The barrier begins at c = 4r, or nearly the way along the curve where that
is less, as else straight pieces would feel it, and b = 2r. φ is that of incremental potential contact (Li et al., ACM
Trans. Graphics 39, 2020).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import ClassVar, NamedTuple, cast

import numpy as np
from scipy.spatial import cKDTree

from ..base import FloatArray, IntArray, checked_fields, dot
from ..curve import Curve, bending_radii
from .edge_pairs import E, EdgePairs, F, Jet, PairTerm


class Walls(NamedTuple):
    """Terms weight · φ((x − wall)/(end − wall)) of quantities x of k pairs (i, j) of edges; all of shape (k,)."""

    i: IntArray
    j: IntArray
    wall: FloatArray
    end: FloatArray
    weight: FloatArray

    def __call__(self, x: Jet) -> Jet:
        """The terms; infinite at the walls and behind them."""
        width = self.end - self.wall
        value, slope, _ = phi((x.value - self.wall) / width)
        return x.compose(self.weight * value, self.weight * slope / width)


@checked_fields
@dataclass(frozen=True, eq=False)
class Rope(PairTerm):
    """The barrier of a rope with a radius for each component, shape (components,), in the units of curves.

    The curve ``seen`` tells distances along the curve and the weights of terms: by default that at hand, which
    `frozen_at` keeps.  With it kept the barrier is C¹ on ropes, and C² but where the closest points of two edges move
    from their insides to their ends.
    """

    radius: FloatArray
    seen: Curve | None = None
    tightest: FloatArray | None = None  # bending radius of each component, if its mesh does not allow the rope's
    weight: float = 0.05  # a tenth of it lets curves stick to the wall, ten times as much holds them off their minima
    reach: float = 2.0  # of strands' distance, over 2r: with 1.5 tangles take a tenth more steps
    share: float = 0.95  # of the way between two strands along the curve, which is the reach if it is less
    bend: float = 2.0  # of bending radii, over r

    scale_exponent: ClassVar[float] = 0.0  # of rope and curve together
    name: ClassVar[str] = "rope"
    description: ClassVar[str] = "barrier that keeps the curve a rope"

    def frozen_at(self, curve: Curve) -> "Rope":
        """The rope with the lengths of a curve, or its own if they are as good, and bends that the curve's mesh allows.

        Where edges have just been split, corners look sharper than before; they may bend as far as they do until the
        flow has made them smooth.
        """
        seen = cast(Curve, self._seeing(curve).seen)
        allowed = np.minimum(self.radius, 0.9 * np.minimum.reduceat(bending_radii(curve), curve.mesh.offsets[:-1]))
        if seen is self.seen and bool((np.abs(seen.edge_lengths / curve.edge_lengths - 1.0) <= 0.01).all()):
            allowed = np.maximum(allowed, self._tightest)
            if (allowed == self._tightest).all():
                return self
            return replace(self, tightest=allowed)
        return replace(self, seen=curve, tightest=allowed)

    @lru_cache(maxsize=2)  # noqa: B019 (two: a run asks again for what the step to a point has asked)
    def value_and_derivative(self, curve: Curve) -> tuple[float, FloatArray]:
        return super().value_and_derivative(curve)

    def meets(self, curve: Curve) -> bool:
        """Whether strands are no further apart than they must be, so that E is infinite; corners are left aside."""
        walls = self._seeing(curve)._strands(curve, 1.0)
        chord, _, _ = closest(EdgePairs.of(curve.mesh, curve.vertices, walls.i, walls.j))
        return bool((dot(chord, chord) <= walls.wall**2).any())

    def shares(self, curve: Curve) -> Iterator[tuple[IntArray, IntArray, Callable[[EdgePairs], Jet]]]:
        """Of both sums; infinite where the curve is no rope."""
        rope = self._seeing(curve)
        strands = rope._strands(curve, self.reach)
        yield strands.i, strands.j, lambda pairs: strands(distance(pairs))
        if len((corners := rope._corners(curve)).i):
            yield corners.i, corners.j, lambda pairs: corners(bends(pairs)[0])

    @lru_cache(maxsize=2)  # noqa: B019 (products with the second derivative are of one curve)
    def _strands(self, curve: Curve, reach: float) -> Walls:
        """Pairs of edges far enough along the curve, among them all whose distances are less than a reach, over 2r."""
        middle, ell, r = curve.midpoints, curve.edge_lengths, self.radius[curve.mesh.edge_component]
        cut = 2.0 * reach * float(self.radius.max()) + float(ell.max())
        i, j = cKDTree(middle).query_pairs(cut, output_type="ndarray").T
        way = self._way(i, j)
        far = way > np.pi * r[i]
        i, j, way = i[far], j[far], way[far]
        wall = r[i] + r[j]
        end = np.minimum(reach * wall, self.share * way)
        chord = middle.take(i, axis=0) - middle.take(j, axis=0)
        near = dot(chord, chord) < (end + 0.5 * (ell[i] + ell[j])) ** 2
        i, j, wall, end = i[near], j[near], wall[near], end[near]
        ell = cast(Curve, self.seen).edge_lengths
        return Walls(i, j, wall, end, self.weight * ell[i] * ell[j] / (0.5 * wall) ** 2)

    def _way(self, i: IntArray, j: IntArray) -> FloatArray:
        """How far pairs of edges are apart along the curve that is seen, shape (k,): infinite between components."""
        seen = cast(Curve, self.seen)
        position, component, ell = self._middles, seen.mesh.edge_component, seen.edge_lengths
        way = np.abs(position[0, i] - position[0, j])
        way = np.minimum(way, position[1, i] - way) - 0.5 * (ell[i] + ell[j])
        return np.where(component[i] == component[j], way, np.inf)

    @cached_property
    def _middles(self) -> FloatArray:
        """Distances along the curve that is seen: to each edge's middle, and once round; shape (2, edges).

        At an edge's tail an arc of the radius is shorter than the corner, of angle θ = 2 arctan t.
        """
        seen = cast(Curve, self.seen)
        mesh, ell, r = seen.mesh, seen.edge_lengths, self.radius[seen.mesh.edge_component]
        tangent = 0.5 * np.minimum(ell[mesh.incoming], ell[mesh.outgoing]) / np.maximum(bending_radii(seen), 1e-300)
        step = ell - 2.0 * r * (tangent - np.arctan(tangent))[mesh.tails]
        around = np.where(mesh.closed, np.add.reduceat(step, mesh.edge_offsets[:-1]), np.inf)
        return np.stack([np.cumsum(step) - 0.5 * ell, around[mesh.edge_component]])

    def _corners(self, curve: Curve) -> Walls:
        """The edges at each corner that bends within the barrier's reach, once for the bending radius by each."""
        mesh, radius = curve.mesh, self._tightest[curve.mesh.component]
        at = mesh.inner[(bending_radii(curve) < self.bend * radius)[mesh.inner]]
        before, after, r = mesh.incoming[at], mesh.outgoing[at], np.tile(radius[at], 2)
        i, j = np.concatenate([before, after]), np.concatenate([after, before])
        return Walls(i, j, r, self.bend * r, 0.5 * self.weight * cast(Curve, self.seen).edge_lengths[i] / r)

    def _seeing(self, curve: Curve) -> "Rope":
        """The rope with lengths of a curve on the mesh of this one: by default its own."""
        return self if self.seen is not None and self.seen.mesh == curve.mesh else replace(self, seen=curve)

    @property
    def _tightest(self) -> FloatArray:
        return self.radius if self.tightest is None else self.tightest


def bends(pairs: EdgePairs) -> tuple[Jet, Jet]:
    """The bending radii ℓ/(2 tan(θ/2)) at corners between edges e and f, by the length of either."""
    a, b, c = pairs.inner(E, E).sqrt(), pairs.inner(F, F).sqrt(), pairs.inner(E, F)
    cotangent = ((a * b + c) * (a * b - c).reciprocal()).sqrt()  # of half the angle
    return (a * cotangent).scaled(0.5), (b * cotangent).scaled(0.5)


def distance(pairs: EdgePairs) -> Jet:
    """The distances of k pairs of edges, which change as if closest points stayed in their places on the edges."""
    chord, s, t = closest(pairs)
    d = np.sqrt(dot(chord, chord))
    unit = chord / np.where(d == 0, 1.0, d)[:, None]
    return Jet(d, np.concatenate([unit, s[:, None] * unit, -t[:, None] * unit], axis=1))


def closest(pairs: EdgePairs) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Δ + s e − t f between closest points of k pairs of edges, shape (k, m), and s, t ∈ [−½, ½], shape (k,)."""
    delta, e, f = pairs
    ee, ff, ef, de, df = (dot(*each) for each in ((e, e), (f, f), (e, f), (delta, e), (delta, f)))
    sine = ee * ff - ef * ef
    oblique = sine.real > 1e-12 * (ee * ff).real  # where edges are parallel any s will do
    s = np.where(oblique, _clip((ef * df - de * ff) / np.where(oblique, sine, 1.0)), 0.0)
    t = _clip((ef * s + df) / ff)
    s = _clip((ef * t - de) / ee)
    return delta + s[:, None] * e - t[:, None] * f, s, t


def _clip(x: FloatArray) -> FloatArray:
    """Numbers, real or after a complex step, in [−½, ½]."""
    return np.where(np.abs(x.real) < 0.5, x, np.clip(x.real, -0.5, 0.5))


def phi(z: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """φ(z) = −(1 − z)² log z, infinite up to z = 0 and 0 from z = 1 on, and its two derivatives.

    Numbers are real or after a complex step.
    """
    behind, beyond = z.real <= 0.0, z.real >= 1.0
    z = np.where(behind | beyond, 1.0, z)
    k, log = 1.0 - z, np.log(z)
    return np.where(behind, np.inf, -k * k * log), 2.0 * k * log - k * k / z, 4.0 * k / z + (k / z) ** 2 - 2.0 * log
