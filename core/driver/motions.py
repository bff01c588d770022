"""Random motions out of a minimum, or from where a curve is stuck; they are proved like all others."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ..arguments import checked_fields, number
from ..descent import Leg, Point, Step
from ..descent.hessian import soft_modes
from ..descent.step import attempt
from ..energies.components import energy_scale
from ..errors import OptionError
from ..types import FloatArray

RIGID = 1e-12  # tangent part of a field that counts as rounding: pins may leave nothing to move

Field = Callable[[FloatArray], FloatArray]
"""Velocities at vertices; shapes (n, m) -> (n, m)."""


@checked_fields
@dataclass(frozen=True)
class Motion(ABC):
    """Move along random fields up to a random energy, within constraints; lengths are RMS in radii of gyration."""

    fields: int = number()
    distance: float = number()  # that the curve moves along each field
    stride: float = number()  # of a step at most, halved where a step is not accepted
    shortest: float = number()  # step at which a field is given up
    # least and greatest ceiling for the energy of the curve, as multiples of the energy scale
    ceilings: tuple[float, float] = (2.0, 16.0)

    def __post_init__(self) -> None:
        if not 1.0 <= self.ceilings[0] <= self.ceilings[1] < math.inf:
            raise OptionError(f"ceilings are {self.ceilings}; they must ascend from 1 or more")

    def fits(self, point: Point) -> bool:
        return point.problem.geometry.prescribes

    @abstractmethod
    def field(self, point: Point, rng: np.random.Generator) -> Field:
        """The next field."""

    def __call__(self, point: Point, rng: np.random.Generator) -> Iterator[Step]:
        """Yield proved steps, each of which ends on the constraints."""
        multiple = math.exp(rng.uniform(*np.log(self.ceilings)))
        ceiling = energy_scale(point.problem.mesh, point.energy) * multiple
        for _ in range(self.fields):
            for step in self.along(point, self.field(point, rng), ceiling):
                yield step
                point = step.point.anchored

    def along(self, point: Point, field: Field, ceiling: float) -> Iterator[Step]:
        """Yield steps along a field, each of which ends on the constraints and below a level of energy."""
        left, stride = self.distance, self.stride
        while left > 0.0 and stride > self.shortest:
            velocity = field(point.vertices)
            u = point.tangent_space.project(velocity)
            if root_mean_square(u) <= RIGID * root_mean_square(velocity):
                return
            u *= stride * radius(point.vertices) / root_mean_square(u)
            leg = attempt(point, point.vertices + u, 0.0 * point.residual, lambda end: end.energy < ceiling)
            if not isinstance(leg, Leg):
                stride *= 0.5
                continue
            yield Step((leg,), 0.0, None)
            point, left, stride = leg.end.anchored, left - stride, min(2.0 * stride, self.stride)


@checked_fields
@dataclass(frozen=True)
class Push(Motion):
    """Push along random soft modes, which slide touching strands along each other; flows would press them together."""

    fields: int = number(3)
    distance: float = number(1.0)
    stride: float = number(0.05)  # where strands touch, only short steps are free
    shortest: float = number(1e-3)
    modes: int = number(6)  # number of modes in a combination
    # with the Hessian, to find the modes: soft enough by then, they need not converge any further. From a single
    # start, only one of all rotations and other flat directions can be among them
    products: int = number(30)

    def fits(self, point: Point) -> bool:
        """Whether, in addition, the energy has a second derivative."""
        return super().fits(point) and point.problem.objective.has_hessian

    def field(self, point: Point, rng: np.random.Generator) -> Field:
        start = point.tangent_space.project(rng.normal(size=point.vertices.shape))
        modes = soft_modes(point, start[None], 0.0, -math.inf, self.products).vectors[: self.modes]
        u = np.tensordot(rng.normal(size=len(modes)), modes, 1)
        return lambda _: u


@checked_fields
@dataclass(frozen=True)
class Stir(Motion):
    """Stir space by random flows, which fold the curve and turn it over.

    A single flow is an isotopy that keeps neighbouring strands together; a sequence of flows mixes them, and a higher
    ceiling lets the curve forget more of the minimum.
    """

    fields: int = number(10)
    distance: float = number(1.0)
    stride: float = number(0.1)
    shortest: float = number(5e-3)
    waves: int = number(4)  # number of plane waves that a flow is the sum of
    # standard deviation of each component of their wave vectors, in radians per radius of gyration
    frequency: float = number(2.0)

    def field(self, point: Point, rng: np.random.Generator) -> Field:
        """A sum of plane waves, each without divergence, most of them shorter than the curve is wide."""
        center = point.vertices.mean(axis=0)
        waves, amplitudes = rng.normal(size=(2, self.waves, point.curve.dimension))
        along = np.sum(waves * amplitudes, axis=1) / np.square(waves).sum(axis=1)
        amplitudes -= along[:, None] * waves
        waves *= self.frequency / radius(point.vertices)
        phases = rng.uniform(0.0, 2.0 * np.pi, self.waves)
        return lambda x: np.asarray(np.sin((x - center) @ waves.T + phases) @ amplitudes)


def radius(vertices: FloatArray) -> float:
    """Radius of gyration."""
    return root_mean_square(vertices - vertices.mean(axis=0))


def root_mean_square(u: FloatArray) -> float:
    """The root mean square of the lengths of vectors, shape (n, m)."""
    return float(np.sqrt(np.square(u).sum(axis=1).mean()))


MOTIONS: tuple[Motion, ...] = (Push(), Stir())
"""In the order of their turns."""
