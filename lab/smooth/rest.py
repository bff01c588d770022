"""Minimisers of the Möbius energy among smooth curves: where relaxed polygons lead as meshes become finer.

Newton's method for the coefficients of Fourier series, whose number grows until the energy no longer changes.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve, eigh, orth

from ...core.base import ENERGY_ROUNDING, CurveError, FloatArray, checked
from ...core.curve import Curve, check_closed
from ...core.energies import MoebiusEnergy
from ...core.knots.inscribed import equal_steps, is_isotopic
from ...core.knots.shapes import SmoothShape
from .energy import Basis, SampledPairs, parameters, sliding
from .fourier import FourierCurve

MODES = (24, 36, 54, 80, 120, 180, 270)  # of a component of average length
ACCURACY = 1e-6  # of the energy: how much half as many modes again may change it
MOST = 720  # modes of all components: some gigabytes and seconds a step
_PER_MODE = 4  # points of the trapezoidal rule
_RESOLVED = 1e-4  # of the energy: the error up to which more modes go on where fewer ended
# of energies, and of the Hessian's norm: how far they, and its eigenvalues, are known
_ROUNDING = 10.0 * ENERGY_ROUNDING

Placed = tuple[Curve, Sequence[FloatArray]]
"""A polygon and the parameters of its components' vertices."""

Trail = list[FourierCurve]
"""The curve that Newton's steps start from, and those they lead to."""


@dataclass(frozen=True, eq=False)
class RestingCurve:
    """A smooth curve at which the Möbius energy is stationary, about the origin, with radius about 1."""

    curve: FourierCurve
    energy: float
    error: float  # how far its energy may be off: the change by more modes and points, and the gain of a next step


@checked
def at_rest(polygon: Curve) -> RestingCurve | None:
    """The smooth curve that a relaxed polygon stands for; None if none with an inscribed polygon of its type is found.

    Steps lead downhill, and so to saddles only from polygons that have their symmetry, or are there already.
    Raises CurveError for arcs and for curves that are not in space.
    """
    check_closed(polygon, "smooth curves at rest")
    if polygon.dimension != 3:
        raise CurveError(f"the curve has dimension {polygon.dimension}; smooth curves at rest are found in space")
    centred = polygon.vertices - polygon.vertices.mean(axis=0)
    given = polygon.with_vertices(centred / np.linalg.norm(centred, axis=1).max())
    energy, lengths = MoebiusEnergy().value(polygon), polygon.component_lengths
    at, last, way = parameters(given), None, Trail()
    for most in MODES:
        if sum(modes := [max(MODES[0] // 2, round(most * each / lengths.mean())) for each in lengths]) > MOST:
            break
        start = last.curve.with_modes(modes) if last else FourierCurve.of(given, at, modes)
        # 1e-8, 20: gain of the next step, relative to the energy, and steps, after which more modes do better
        found, trail = _stationary(start, last.energy if last else energy, (1e-8, 20))
        if found is None or found.error > _RESOLVED * energy:
            continue
        way += trail
        if last and (error := found.error + abs(found.energy - last.energy)) <= ACCURACY * found.energy:
            polished, trail = _stationary(found.curve, found.energy, (1e-11, 20))  # the same in the end
            polygons = [curve.polygon(curve.sizes) for curve in way + trail]
            proved = polished and _is_isotopic([(given, at), *((each, equal_steps(each)) for each in polygons)])
            return replace(polished, error=error + polished.error) if polished and proved else None
        last = found
    return None


@checked
def energy_of(curve: SmoothShape, per_mode: int = 2 * _PER_MODE) -> float:
    """The Möbius energy, by a trapezoidal rule with ``per_mode`` points for each mode."""
    basis = Basis.of(curve.modes, per_mode)
    return SampledPairs.of(basis, basis.unknowns(curve)).energy


@checked
def is_at_rest(rest: RestingCurve) -> bool:
    """Whether the energy is the curve's, to what half as many modes again may change, and a next step gains no more."""
    basis = Basis.of(rest.curve.modes, _PER_MODE)
    most = ACCURACY * rest.energy
    return (
        abs(energy_of(rest.curve) - rest.energy) <= most
        and QuadraticModel.of(basis, basis.unknowns(rest.curve)).gain <= most
    )


@checked
def index_of(curve: FourierCurve) -> int:
    """The number of independent directions in which the energy of a curve at rest falls, 0 at a minimum.

    It has to fall where strands' distances change by some per cent: the finest wiggles may gain less than is resolved.
    """
    basis = Basis.of(curve.modes, _PER_MODE)
    z = basis.unknowns(curve)
    energy, _, hessian = _derivatives(basis, z)
    _, directions = eigh(hessian, subset_by_value=(-np.inf, 0.0))
    falling = 0
    for step in (each.reshape(z.shape) for each in directions.T):
        # by 0.03 of strands' distances forwards and backwards: slopes cancel
        little = 0.03 / _strain(basis.values @ z, basis.values @ step) * step
        mean = 0.5 * (SampledPairs.of(basis, z + little).energy + SampledPairs.of(basis, z - little).energy)
        falling += mean < (1.0 - _ROUNDING) * energy
    return falling


def _is_isotopic(way: Sequence[Placed]) -> bool:
    """Whether straight motions from the first polygon to the last, or by way of others, are proved free of contact."""
    if is_isotopic(*way[0], *way[-1]):
        return True
    half = len(way) // 2
    return len(way) > 2 and _is_isotopic(way[: half + 1]) and _is_isotopic(way[half:])


def _stationary(start: FourierCurve, energy: float, enough: tuple[float, int]) -> tuple[RestingCurve | None, Trail]:
    """Where Newton's method leads from a curve, and its trail; None if its energy is not about the one given."""
    basis, finer = (Basis.of(start.modes, points) for points in (_PER_MODE, 2 * _PER_MODE))
    z = basis.unknowns(start)
    # 0.03 of the energy: how far that of a first fit may be from the polygon's
    if abs(SampledPairs.of(basis, z).energy - energy) > 0.03 * energy:
        return None, []
    model, trail, (gain, steps) = QuadraticModel.of(basis, z), [start], enough
    while model.gain >= gain * model.energy and len(trail) <= steps:
        # towards lower energy along the step, by up to 0.3 of strands' distances
        share = min(1.0, 0.3 / _strain(basis.values @ z, basis.values @ model.step))
        while share > 1e-6 and not model.is_near:
            trial = SampledPairs.of(basis, z + share * model.step)
            if trial.energy <= model.energy - 1e-4 * share * model.gain:
                break
            share *= 0.5
        better = z + share * model.step
        if share <= 1e-6 or ((there := QuadraticModel.of(basis, better)).gain >= model.gain and model.is_near):
            break
        z, model = better, there
        trail.append(basis.curve(z))
    found = SampledPairs.of(finer, z).energy
    return RestingCurve(trail[-1], found, model.gain + abs(found - model.energy)), trail


@dataclass(frozen=True, eq=False)
class QuadraticModel:
    """The quadratic model of the energy at unknowns, without the directions in which it does not change."""

    energy: float
    step: FloatArray  # Newton's, but downhill where the energy is concave; shape (N, 3)
    gain: float  # the decrease that the model predicts for the step

    @classmethod
    def of(cls, basis: Basis, z: FloatArray) -> "QuadraticModel":
        """The model at unknowns z."""
        energy, slope, hessian = _derivatives(basis, z)
        least = _ROUNDING * float(np.linalg.norm(hessian, np.inf))
        shift = least * np.eye(len(hessian))
        try:  # most models are convex, which this finds out faster than eigenvalues do
            cho_factor(hessian + shift)
            step = -cho_solve(cho_factor(hessian + 2.0 * shift), slope)
        except LinAlgError:
            values, vectors = eigh(hessian)
            step = -vectors @ ((vectors.T @ slope) / np.maximum(np.abs(values), least))
        gain = -0.5 * float(slope @ step)
        return cls(energy, step.reshape(-1, 3), gain)

    @property
    def is_near(self) -> bool:
        """Whether so little is left to gain that rounding may hide it."""
        # 1e-10 of the energy: gain of a step that is not measured, but must make the next gain less
        return self.gain < 1e-10 * self.energy


def _derivatives(basis: Basis, z: FloatArray) -> tuple[float, FloatArray, FloatArray]:
    """The energy, its gradient and Hessian by the flattened unknowns, stiff where it does not change."""
    pairs, stiff = SampledPairs.of(basis, z), 2.0 * sliding(basis, z)  # against sliding
    return pairs.energy, *_free(pairs.gradient.ravel(), pairs.hessian + stiff, invariant(basis, z))


def _free(slope: FloatArray, hessian: FloatArray, fields: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Slope and Hessian without some directions, in which the Hessian gets its average stiffness instead."""
    fixed = orth(fields.T)
    across = hessian @ fixed
    shifts = 0.5 * fixed @ (fixed.T @ across + np.trace(hessian) / len(hessian) * np.eye(fixed.shape[1])) - across
    return slope - fixed @ (fixed.T @ slope), hessian + shifts @ fixed.T + fixed @ shifts.T


def _strain(points: FloatArray, shifts: FloatArray) -> float:
    """The largest change of a vector between two points, in units of its length."""
    changes, vectors = (np.sum((each[:, None] - each) ** 2, axis=2) for each in (shifts, points))
    np.fill_diagonal(vectors, 1.0)
    return float(np.sqrt(np.max(changes / vectors)))


def invariant(basis: Basis, z: FloatArray) -> FloatArray:
    """Directions in which the energy does not change: similarities, Möbius maps, a shift of t; shape (k, 3N)."""
    x, v = basis.values @ z, basis.slopes @ z
    fields: list[FloatArray] = [x]
    for axis in np.eye(3):
        inversion = 2.0 * (x @ axis)[:, None] * x - np.sum(x**2, axis=1)[:, None] * axis
        fields += [np.broadcast_to(axis, x.shape), np.cross(axis, x), inversion]
    fields += [np.where((basis.component == k)[:, None], v, 0.0) for k in range(len(basis.modes))]
    return np.stack([basis.unknowns_of(field).ravel() for field in fields])
