"""Facts about a curve as it stands: what ``mobius-flow energy`` and ``mobius-flow info`` print."""

import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from ..base import BLAS, CurveError, MobiusFlowError, Table, check_known, checked
from ..collision import check_embedded, check_gap, minimal_gap, thickness
from ..curve import Curve, writhe_and_crossings
from ..curve.symmetry import SymmetryGroup, symmetries
from ..descent.task import centred, check_units
from ..energies import ENERGIES, MoebiusEnergy
from ..energies.hierarchy import moebius_energy
from ..knots import KnotType, knot_type
from ..knots.names import table_name
from ..knots.shapes import least_energies
from .moves.rest import stability
from .options import RelaxOptions
from .prepare import start_problem
from .run import gradient_bound

PAIRS_UP_TO = 50_000  # vertices where all pairs of edges are summed: a minute or so, growing with the square
REST_UP_TO = 12_000  # vertices: some minutes where curves are at rest
AT_REST: Mapping[str, Callable[[Curve], Any]] = Table("mobius_flow.smooth", callable, {})
"""What finds the smooth curve, with its ``energy`` and ``error``, or None, that a polygon at rest stands for."""


@BLAS.bounded()
@checked
def measure(curve: Curve, energy: str = "moebius") -> float:
    """The energy of a curve, in the user's units.

    Raises CurveError if the curve has too many vertices, touches itself, or has strands too near, or units too large or
    small, to compute with, and OptionError if the energy is unknown.
    """
    check_known("energy", energy, ENERGIES)
    wanted = ENERGIES[energy]
    check_units(curve)
    check_embedded(curve)
    check_gap(curve)
    if isinstance(wanted, MoebiusEnergy):
        return moebius_energy(centred(curve))[0]
    if len(curve) > PAIRS_UP_TO:
        raise CurveError(f"the curve has {len(curve)} vertices; {wanted.name} is for at most {PAIRS_UP_TO}")
    return wanted.value(centred(curve))


@dataclass(frozen=True)
class Rest:
    """Whether a curve is at rest."""

    objective: float  #: the Möbius energy with its barrier
    gradient_norm: float  #: of the projected gradient in the metric J_C, edge lengths being prescribed
    bound: float  #: largest norm at rest, as `relax` has it by default
    index: int | None  #: of the Hessian, 0 at a minimum; None away from rest, or if it is not resolved

    @property
    def at_rest(self) -> bool:
        return self.gradient_norm <= self.bound

    @property
    def sentence(self) -> str:
        if not self.at_rest:
            return "not at rest"
        if self.index is None:
            return "at rest; the Hessian is too ill-conditioned to tell a minimum from a saddle"
        return f"at rest at {f'a saddle of index {self.index}' if self.index else 'a minimum'}"


@dataclass(frozen=True)
class Smooth:
    """The smooth curve at rest that a polygon at rest stands for."""

    energy: float
    error: float  #: how far the energy may be off
    name: str | None  #: of the knot or link of the table that it is
    least: tuple[float, float] | None  #: the least energy known of that type, and its error

    @property
    def sentence(self) -> str:
        told = max(self.error, 1e-15 * self.energy)  # no less than rounding
        energy = f"{self.energy:.{max(1 - math.floor(math.log10(told)), 1)}f} ± {told:.1g}"
        if self.least is None:
            return energy
        least, error = self.least
        excess, known = self.energy - least, f"the least known of {self.name}"
        if abs(excess) <= self.error + error + 1e-6 * least:  # as far as ends at one curve differ
            return f"{energy}, {known}"
        side = "above" if excess > 0.0 else "below"
        return f"{energy}, {abs(100.0 * excess / least):.2g} % {side} {known}, {least:.9g}"


@dataclass(frozen=True)
class Info:
    """Measures of a curve, in its own units; None where the number of vertices or the dimension forbids it."""

    components: tuple[int, ...]
    open: bool  #: whether a component is
    dimension: int
    type: KnotType
    energies: Mapping[str, float | None]  #: by their names: Möbius, edge and vertex
    rest: Rest | None
    smooth: Smooth | None  #: None away from rest, for arcs, and if it is not found
    length: float
    thickness: float | None  #: radius of the thickest tube around it
    writhe: float | None
    average_crossing_number: float | None
    shortest_edge: float
    longest_edge: float
    symmetry: SymmetryGroup | None
    gap: float  #: least distance between edges that are not neighbours; infinite for a triangle

    def __repr__(self) -> str:
        return f"<Info: {self.type}, {sum(self.components)} vertices, length {self.length:.6g}>"

    @property
    def ropelength(self) -> float | None:
        return None if self.thickness is None else self.length / self.thickness


@BLAS.bounded()
@checked
def info(curve: Curve) -> Info:
    """Measure a curve and identify its type; a CurveError if it touches itself or cannot be computed with."""
    check_units(curve)
    check_embedded(curve)
    check_gap(curve)
    in_space, few, names = curve.dimension == 3, len(curve) <= PAIRS_UP_TO, ("moebius", "edge", "vertex")
    writhe, crossings = writhe_and_crossings(curve) if in_space and few else (None, None)
    kind, rest, smooth, symmetry = knot_type(curve), None, None, None
    parts = zip(curve.mesh.component_sizes, curve.mesh.closed, strict=True)
    if len(curve) <= REST_UP_TO and all(size > 4 or not closed for size, closed in parts):  # a square has no metric
        point = start_problem(curve, RelaxOptions(edge_lengths="keep", radius="none")).at_curve(curve)
        bound = gradient_bound(RelaxOptions(), curve.mesh, point.energy)
        index = stability(point).index if point.gradient_norm <= bound else None
        rest = Rest(point.energy, point.gradient_norm, bound, index)
    if in_space and rest is not None and rest.at_rest and curve.mesh.all_closed:
        found = next((each for at_rest in AT_REST.values() if (each := at_rest(curve)) is not None), None)
        name = None
        with suppress(MobiusFlowError):
            name = table_name("0_1" if str(kind) == "unknot" else str(kind))[0]
        smooth = found and Smooth(found.energy, found.error, name, least_energies().get(name or ""))
    with suppress(CurveError):
        symmetry = symmetries(curve)
    return Info(
        components=curve.mesh.component_sizes,
        open=not curve.mesh.all_closed,
        dimension=curve.dimension,
        type=kind,
        energies={name: measure(curve, name) if few or name == "moebius" else None for name in names},
        rest=rest,
        smooth=smooth,
        length=curve.length,
        thickness=thickness(curve) if few else None,
        writhe=writhe,
        average_crossing_number=crossings,
        shortest_edge=float(curve.edge_lengths.min()),
        longest_edge=float(curve.edge_lengths.max()),
        symmetry=symmetry,
        gap=minimal_gap(curve)[0],
    )
