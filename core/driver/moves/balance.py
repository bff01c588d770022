"""The Möbius image of a curve that bends least, while all have the same energy, and a proved way there.

Up to similarities, a Möbius map of R^m is given by the point that it sends to infinity, as a rotation of the sphere
above it: stereographic projection to the sphere S^m, a rotation in the plane of the north pole and a direction v/|v|,
and projection back.  With the cosine c and the sine |v| of half the angle this is

    y = ((c² + |v|²) x + (c (|x|² − 1) − 2 ⟨v, x⟩) v) / D,    D = c² + 2 c ⟨v, x⟩ + |v|² |x|²,

a map for each q = (c, v) ≠ 0, the same for all multiples of q.  The pole −c v/|v|² is where D = 0; at (1, 0) it is the
point at infinity, and the map the identity.  Every Möbius map that preserves orientation is one of these followed by
a similarity.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np

from ...base import FloatArray, dot
from ...collision import thickness, walk
from ...curve import Curve, arc_lengths, bending, bending_and_derivative, cubic_spline, sample_parameters
from ...descent import Leg, Point, Problem, Step, leg
from ..move import Change, Move
from ..outcome import Outcome, Status

CUT_OFF = "the Möbius image of least bending has not converged yet"
IS_BALANCED = "no other shape of the same energy that can be reached bends less"


class MoebiusImages:
    """The Möbius images of the smooth curve through a polygon's vertices, as polygons with as many vertices.

    Vertices slide along the curve, so that the edges of every component keep the ratios of their target lengths, shape
    (n,), however strongly a map stretches them; length and barycenter stay.
    """

    def __init__(self, curve: Curve, lengths: FloatArray) -> None:
        self._curve, self._center = curve, curve.barycenter
        # the unit sphere passes through the curve: poles far away and in its middle are about as far from (1, 0)
        self._radius = float(np.sqrt(np.square(curve.vertices - self._center).sum(axis=1).mean()))
        self._splines = [cubic_spline(self._unit(points)) for points in curve.components]
        self._fractions = [np.cumsum(lengths[s]) / lengths[s].sum() for s in curve.mesh.slices]

    def of_vertices(self, q: FloatArray) -> tuple[float, FloatArray]:
        """Logarithm of the bending of the image of the vertices, and its derivative by q, shape (m + 1,)."""
        points = self._unit(self._curve.vertices)
        value, derivative = bending_and_derivative(self.vertices(q))
        return float(np.log(value)), moebius_pullback(points, q, derivative / value)

    def vertices(self, q: FloatArray) -> Curve:
        """The polygon of the images of the vertices, in another unit of length."""
        return self._curve.with_vertices(moebius_image(self._unit(self._curve.vertices), q))

    def at(self, q: FloatArray) -> Curve:
        pieces = []
        for spline, fractions in zip(self._splines, self._fractions, strict=True):
            parameter = sample_parameters(spline)
            arc = arc_lengths(moebius_image(spline(parameter), q))
            wanted = arc[-1] * np.concatenate([[0.0], fractions[:-1]])
            pieces.append(moebius_image(spline(np.interp(wanted, arc, parameter)), q))
        image = self._curve.with_vertices(np.concatenate(pieces))
        scale = self._curve.length / image.length
        return image.with_vertices(self._center + scale * (image.vertices - image.barycenter))

    def _unit(self, vertices: FloatArray) -> FloatArray:
        return np.asarray((vertices - self._center) / self._radius)


@dataclass(eq=False)
class Balance(Move):
    """Go from a converged curve to its balanced image, once, and once more wherever a hand has pulled it."""

    gain: float = 0.01  # relative decrease of the bending that makes the way worthwhile
    # longest, shortest: steps, in radians of half the sphere's angle of rotation
    longest: float = 0.02
    shortest: float = 5e-6
    _before: float | None = field(default=None, init=False)  # bending of the curve before it was balanced

    def stepped(self, step: Step) -> None:
        if self.run.problem.objective.pull is not None:
            self._before = None

    def ended(self, outcome: Outcome) -> Outcome | Change | None:
        run = self.run
        if not run.options.balance or run.iterate.pins:  # which a hand may have left, and Möbius maps would move
            return None
        if outcome.status is Status.ITERATION_LIMIT and self._before is not None:
            return outcome.adding(CUT_OFF)
        if not outcome.converged:
            return None
        if self._before is not None:
            before, after = self._before, bending(run.iterate.curve)
            # on coarse and uneven meshes energies of images differ, and the flow may have gone all the way back
            if after > (1.0 - self.gain) * before:
                return outcome.adding(IS_BALANCED)
            told = "balanced: bending reduced from {before:.4g} to {after:.4g} (4π² for a round circle)"
            return outcome.adding(told, before=before, after=after)
        steps = self.way(run.point)
        if not steps:
            return outcome.adding(IS_BALANCED)
        if run.iterations_left <= 0:
            return run.at_limit().adding(CUT_OFF)
        self._before = bending(run.iterate.curve)
        # the method remembers nothing of the curve before
        return Change(steps[: run.iterations_left], method=run.method)

    def way(self, point: Point) -> tuple[Step, ...]:
        """Proved steps to the reachable Möbius image of least bending, in its own problem; empty if none pays."""
        images = MoebiusImages(point.curve, point.problem.constraints.lengths)
        keeps, radius = self.run.options.radius == "keep", point.problem.radius
        # also less than the identity's image: a decrease by smoothing alone is no gain, as the flow would undo it
        still = images.at(np.eye(point.curve.dimension + 1)[0])
        enough = (1.0 - self.gain) * min(bending(point.curve), bending(still))
        symmetry = point.problem.constraints.symmetry
        for q in least_bending(images, point.curve.dimension):
            image = images.at(q)
            if bending(image) > enough or not symmetry.fixes(q[1:]):
                continue
            # the same problem for the image: the target lengths of each component add up to its length there
            ropes = [radius]
            if keeps and radius is not None:
                # it gives way, as what bends less has strands that are nearer, or is over where strands move too near
                ropes = [np.minimum(radius, 0.9 * thickness(image) * point.problem.units.scale), None]
            constraints = point.problem.constraints
            lengths = constraints.lengths.copy()
            for part in image.mesh.slices:
                lengths[part] *= image.edge_lengths[part].sum() / lengths[part].sum()
            held = replace(constraints, lengths=lengths, barycenters=constraints.barycenters.on(image))
            let_go = point.problem.objective.rope is None  # and stays so
            for rope, end in product(ropes, (q, -q)):  # the same map, with the pole coming from either side
                problem = replace(point.problem, radius=rope) if let_go else point.problem.as_rope(rope)
                if way := self._way(point, images, end, replace(problem, constraints=held)):
                    return way
        return ()

    def _way(self, point: Point, images: MoebiusImages, q: FloatArray, problem: Problem) -> tuple[Step, ...]:
        """Proved steps to the image of q by smaller rotations; empty if strands interfere."""
        end, turned_by = turn(q)
        reached, legs = 0.0, list[Leg]()

        def rotated(angle: float, stride: float) -> Leg | None:
            image = images.at(turned_by(min(angle + stride, end)))
            found = leg(legs[-1].end if legs else point, problem.at(image.vertices))
            return found if found.open else None

        for place, found in walk(rotated, end, self.longest, self.shortest):
            legs.append(found)
            reached = place
        return tuple(Step((each,), 0.0, None) for each in legs) if reached >= end else ()


def balanced(curve: Curve) -> Curve:
    """The Möbius image that bends least, with the same energy; no way to it is proved, as pictures need none."""
    images = MoebiusImages(curve, curve.edge_lengths)
    return min((images.at(q) for q in least_bending(images, curve.dimension)), key=bending, default=curve)


def turn(q: FloatArray) -> tuple[float, Callable[[float], FloatArray]]:
    """Half the sphere's angle of rotation in the map of q, and a function from smaller half angles to their maps."""
    sine = float(np.linalg.norm(q[1:]))
    axis = q[1:] / sine
    return float(np.arctan2(sine, q[0])), lambda angle: np.concatenate([[np.cos(angle)], np.sin(angle) * axis])


def least_bending(images: MoebiusImages, dimension: int) -> list[FloatArray]:
    """Local minimisers of the bending, the lowest first, of length 1 with c ≥ 0; none is found twice."""
    from scipy.optimize import minimize  # which takes a while to import

    units = np.eye(dimension + 1)
    starts = [*units[:2]]  # the pole at infinity, in the middle of the curve, and on the unit sphere along the axes
    for unit in units[1:]:
        starts += [units[0] + unit, units[0] - unit]
    found = [minimize(images.of_vertices, start, jac=True, method="BFGS") for start in starts]
    distinct: list[FloatArray] = []
    for result in sorted(found, key=lambda each: float(each.fun)):
        q = np.asarray(result.x / np.linalg.norm(result.x))
        q *= np.copysign(1.0, q[0])
        if np.isfinite(result.fun) and all(abs(q @ other) < 1.0 - 1e-4 for other in distinct):
            distinct.append(q)
    return distinct


def moebius_image(points: FloatArray, q: FloatArray) -> FloatArray:
    """Images of points, shape (n, m), under the map of ``q``, shape (m + 1,)."""
    c, v = float(q[0]), q[1:]
    along, square = points @ v, dot(points, points)
    numerator = (q @ q) * points + np.multiply.outer(c * (square - 1.0) - 2.0 * along, v)
    return np.asarray(numerator / _denominator(q, along, square)[:, None])


def moebius_pullback(points: FloatArray, q: FloatArray, covector: FloatArray) -> FloatArray:
    """A function's derivative by ``q``, shape (m + 1,), from its derivative by the images of points, shape (n, m)."""
    c, v = float(q[0]), q[1:]
    along, square = points @ v, dot(points, points)
    g = covector / _denominator(q, along, square)[:, None]
    shrink = -dot(g, moebius_image(points, q))  # the weight of dD
    on_points, on_v = float(np.sum(points * g)), g @ v
    by_c = 2.0 * c * on_points + on_v @ (square - 1.0) + 2.0 * shrink @ (c + along)
    by_v = 2.0 * (on_points + shrink @ square) * v + 2.0 * (c * shrink - on_v) @ points
    return np.concatenate([[by_c], by_v + (c * (square - 1.0) - 2.0 * along) @ g])


def _denominator(q: FloatArray, along: FloatArray, square: FloatArray) -> FloatArray:
    c, v = q[0], q[1:]
    # not less: points on the pole go far away, not to infinity
    return np.asarray(np.maximum(c**2 + 2.0 * c * along + (v @ v) * square, 1e-24))
