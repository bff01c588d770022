"""The energy that a relaxed polygon would have as a smooth curve: Richardson's extrapolation over three meshes."""

from dataclasses import dataclass, replace

import numpy as np

from ..core.base.arguments import checked, checked_fields
from ..core.curve import Curve, subdivide
from ..core.descent.task import Task
from ..core.driver import RelaxOptions, minimize

ORDER = 2  # of the midpoint rule's error in the edge length
TOLERANCE = 1e-4  # of the runs at most: what they leave open must be small against the differences of their energies


@checked_fields
@dataclass(frozen=True)
class Extrapolation:
    """The Möbius energy's limit for shorter and shorter edges, from ``energies`` E(h), E(h/2), E(h/4) at lengths h."""

    energies: tuple[float, float, float]

    @property
    def ratio(self) -> float:
        """(E(h) − E(h/2)) / (E(h/2) − E(h/4)): 2^p where the error is of order p, 4 for the midpoint rule."""
        coarse, middle, fine = self.energies
        return (coarse - middle) / (middle - fine) if middle != fine else float("nan")

    @property
    def order(self) -> float:
        """The observed order p = log₂ of the ratio; NaN where the energies do not go one way."""
        return float(np.log2(self.ratio)) if self.ratio > 0.0 else float("nan")

    @property
    def energy(self) -> float:
        """E(h/4) + (E(h/4) − E(h/2)) / (2^p − 1), with p the observed order if that is believable and 2 if not."""
        _, middle, fine = self.energies
        return fine + (fine - middle) / ((self.ratio if self._is_regular else 2.0**ORDER) - 1.0)

    @property
    def error(self) -> float:
        """How far the value may be off.

        In the asymptotic range it is how much extrapolations of order 2 from the first and from the last two energies
        differ, sixteen times the latter's error where that is of fourth order, and a share of the last correction;
        outside of it the sum of both differences of energies.
        """
        coarse, middle, fine = self.energies
        if not self._is_regular:
            return abs(coarse - middle) + abs(middle - fine)
        gain = 2.0**ORDER - 1.0
        first, last = middle + (middle - coarse) / gain, fine + (fine - middle) / gain
        # 0.02 of the last correction that is never trusted: ratios may be right by luck
        return abs(last - first) + 0.02 * abs(self.energy - fine)

    @property
    def _is_regular(self) -> bool:
        low, high = 1.0, 3.0  # observed orders that still are the rule's, disturbed by terms of higher order
        return low <= self.order <= high


@checked
def extrapolated(curve: Curve | Task, options: RelaxOptions) -> Extrapolation | None:
    """Go on relaxing a curve, in the user's units, with every edge halved, and halved again; None if a run stalls.

    There are twice and four times as many vertices, and few iterations. The options are those it was relaxed with;
    tolerances above `TOLERANCE` are lowered to it.
    """
    task, energies = Task.of(curve), []
    for pieces in (1, 2, 2):
        finer = subdivide(task.curve, np.full(task.curve.mesh.edges, pieces))
        task = replace(task, curve=finer, pins=tuple(task.held.on(finer).vertices.tolist()))
        own = replace(  # on that mesh, with none that make it leave a minimum, and exact enough
            options,
            mesh="fixed",
            vertices=len(finer),
            edge_lengths="keep",
            grow=1.0,
            stability=False,
            escape_saddles=False,
            balance=False,
            untangle="never",
            hops=0,
            radius="none",
            tolerance=min(options.tolerance, TOLERANCE),
        )
        result = minimize(task, own)
        if not result.outcome.converged:
            return None
        task = replace(task, curve=result.curve)
        energies.append(result.final_energy)
    coarse, middle, fine = energies
    return Extrapolation((coarse, middle, fine))
