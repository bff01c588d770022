"""Among the Möbius images of a curve, which have the same energy, the one that bends least, and a proved way there."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize

from ..constraints import Constraints, weighted_barycenter
from ..curve import Curve
from ..curve.bending import bending, bending_and_derivative
from ..curve.moebius_map import moebius_image, moebius_pullback
from ..curve.smooth import arc_lengths, periodic_spline, sample_parameters
from ..descent import Leg, Point, Problem, Step
from ..types import FloatArray

GAIN = 0.01  # relative decrease of the bending that is worth the way
LONGEST, SHORTEST = 0.02, 1e-5  # step, in radians of half the sphere's angle of rotation


class MoebiusImages:
    """The Möbius images of the smooth curve through a polygon's vertices, as polygons of as many.

    Vertices slide along the curve, so that the edges of every component keep the ratios of their lengths however
    strongly a map stretches them; length and barycenter stay.

    Parameters
    ----------
    curve
        The polygon.
    lengths
        Target lengths of its edges, shape (n,): of those of one component only the ratios count.
    """

    def __init__(self, curve: Curve, lengths: FloatArray) -> None:
        self._curve, self._center = curve, _barycenter(curve)
        # the unit sphere passes amidst the curve: poles far away and near the middle are about as far from (1, 0)
        self._radius = float(np.sqrt(np.square(curve.vertices - self._center).sum(axis=1).mean()))
        self._splines = [periodic_spline(self._unit(points)) for points in curve.components]
        self._fractions = [np.cumsum(lengths[s]) / lengths[s].sum() for s in curve.mesh.slices]

    def of_vertices(self, q: FloatArray) -> tuple[float, FloatArray]:
        """Logarithm of the bending of the image of the vertices, and its derivative by q, shape (m + 1,)."""
        points = self._unit(self._curve.vertices)
        value, derivative = bending_and_derivative(self._curve.with_vertices(moebius_image(points, q)))
        return float(np.log(value)), moebius_pullback(points, q, derivative / value)

    def at(self, q: FloatArray) -> Curve:
        """The image under the map of q, shape (m + 1,)."""
        pieces = [_image(*each, q) for each in zip(self._splines, self._fractions, strict=True)]
        image = self._curve.with_vertices(np.concatenate(pieces))
        scale = self._curve.length / image.length
        return image.with_vertices(self._center + scale * (image.vertices - _barycenter(image)))

    def _unit(self, vertices: FloatArray) -> FloatArray:
        return np.asarray((vertices - self._center) / self._radius)


def _image(spline: CubicSpline, fractions: FloatArray, q: FloatArray) -> FloatArray:
    """Points at fractions of the length of a spline's image, the first one its beginning; shape (n, m)."""
    parameter = sample_parameters(spline)
    arc = arc_lengths(moebius_image(spline(parameter), q))
    wanted = arc[-1] * np.concatenate([[0.0], fractions[:-1]])
    return moebius_image(spline(np.interp(wanted, arc, parameter)), q)


def _barycenter(curve: Curve) -> FloatArray:
    return weighted_barycenter(curve) / curve.length


def way_to_balance(point: Point) -> tuple[Step, ...]:
    """Proved steps to the Möbius image with the least bending of those that there is a way to.

    Empty if none is worth it.  The steps end in the problem that is the point's own for the image.
    """
    images = MoebiusImages(point.curve, point.problem.constraints.lengths)
    # against the identity's image too: what smoothing alone takes off is no gain, the flow would put it back
    enough = (1.0 - GAIN) * min(bending(point.curve), bending(images.at(np.eye(point.curve.dimension + 1)[0])))
    for q in _least(images, point.curve.dimension):
        image = images.at(q)
        if bending(image) > enough:
            continue
        problem = _problem_of(point.problem, image)
        for end in (q, -q):  # the same map, the pole having come from the one side or from the other
            if way := _way(point, images, end, problem):
                return way
    return ()


def balanced(curve: Curve) -> Curve:
    """The Möbius image that bends least, of the same energy; no way to it is proved, as pictures need none."""
    images = MoebiusImages(curve, curve.edge_lengths)
    return min((images.at(q) for q in _least(images, curve.dimension)), key=bending, default=curve)


def _least(images: MoebiusImages, dimension: int) -> list[FloatArray]:
    """Local minimisers of the bending, the lowest first, of length 1 with c ≥ 0; none is found twice."""
    found = [minimize(images.of_vertices, start, jac=True, method="BFGS") for start in _starts(dimension)]
    distinct: list[FloatArray] = []
    for result in sorted(found, key=lambda each: float(each.fun)):
        q = np.asarray(result.x / np.linalg.norm(result.x))
        q *= np.copysign(1.0, q[0])
        if np.isfinite(result.fun) and all(abs(q @ other) < 1.0 - 1e-4 for other in distinct):
            distinct.append(q)
    return distinct


def _starts(dimension: int) -> Iterator[FloatArray]:
    """The pole at infinity, amidst the curve, and on the unit sphere along the axes on both sides."""
    units = np.eye(dimension + 1)
    yield from units[:2]
    for unit in units[1:]:
        yield from (units[0] + unit, units[0] - unit)


def _problem_of(problem: Problem, image: Curve) -> Problem:
    """The same problem for an image: the target lengths of each component add up to what it has there."""
    lengths, parts = problem.constraints.lengths.copy(), problem.constraints.parts
    for part in image.mesh.slices:
        lengths[part] *= image.edge_lengths[part].sum() / lengths[part].sum()
    return replace(problem, constraints=Constraints(lengths, weighted_barycenter(image, parts), parts))


def _way(point: Point, images: MoebiusImages, q: FloatArray, problem: Problem) -> tuple[Step, ...]:
    """Proved steps to the image of q, through those of rotations by smaller angles; empty if strands are in the way.

    Where a step is not proved, a shorter one is tried.
    """
    sine = float(np.linalg.norm(q[1:]))
    end, axis = np.arctan2(sine, q[0]), q[1:] / sine
    steps: list[Step] = []
    here, angle, stride = point.placed, 0.0, LONGEST
    while angle < end:
        further = min(angle + stride, end)
        there = problem.at(images.at(np.concatenate([[np.cos(further)], np.sin(further) * axis])).vertices)
        proof = problem.free_motion(here, there.placed)
        if proof.time == 1.0:
            steps.append(Step((Leg(there, proof),), 0.0, None))
            here, angle, stride = there.placed, further, min(2.0 * stride, LONGEST)
        elif stride < SHORTEST:
            return ()
        else:
            stride *= 0.5
    return tuple(steps)
