"""The one driver: `relax` yields the iterates of a relaxation, `minimize` runs it to its end."""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from .collision import check_embedded, minimal_gap
from .curve import Curve
from .energies import MoebiusEnergy
from .errors import CurveError
from .iterate import Iterate, Status
from .options import RelaxOptions
from .run import Run
from .setup import check_size, embedded_refinement, method_named, start_problem
from .units import check_units

NEAREST_STRANDS = 1e-11  # relative to the curve's length; at half of that, energies are wrong by percents


@dataclass(frozen=True, eq=False)
class Result:
    """How a relaxation ended.

    Attributes
    ----------
    curve
        The last curve, in the user's units.
    status, message
        Why it ended, and the same in a sentence.
    energies
        The objective at every iterate, the start first.
    seconds
        Wall-clock time.
    certified
        Whether every motion from the (refined) start to the result was proved free of contact.
    edge_length_error
        max |log ℓ/ℓ⁰| over the edges.
    method
        Name of the method.
    negative_eigenvalues
        Of the Lagrangian's Hessian, if asked for: 0 at a minimum.
    last
        The last iterate.
    """

    curve: Curve
    status: Status
    message: str
    energies: tuple[float, ...]
    seconds: float
    certified: bool
    edge_length_error: float
    method: str
    negative_eigenvalues: int | None
    last: Iterate

    def report(self) -> dict[str, object]:
        """The result as the plain values that ``--report`` writes."""
        return {
            "status": self.status.value,
            "message": self.message,
            "iterations": len(self.energies) - 1,
            "seconds": self.seconds,
            "energy": list(self.energies),
            "final_energy": MoebiusEnergy().value(self.curve),
            "vertices": len(self.curve),
            "components": len(self.curve.mesh.component_sizes),
            "max_edge_length_error": self.edge_length_error,
            "certified": self.certified,
            "method": self.method,
            "negative_eigenvalues": self.negative_eigenvalues,
        }


def relax(curve: Curve, options: RelaxOptions | None = None) -> Iterator[Iterate]:
    """Relax a curve: yield it refined, then every accepted step, the last with its final status.

    A run that cannot go on yields its last iterate once more, with status STALLED and an empty path.

    Parameters
    ----------
    curve
        An embedded polygon, in any units and place.
    options
        What is asked for.

    Raises
    ------
    CurveError
        If the curve touches itself or is degenerate; the message says where.
    OptionError
        If an option does not fit.
    """
    options = RelaxOptions() if options is None else options
    method_named(options.method)
    check_size(curve, options.vertices)
    check_units(curve)
    check_embedded(curve)
    refined = embedded_refinement(curve, options.vertices)
    _check_gap(refined)
    try:
        return Run(start_problem(refined, options), refined, options).iterates()
    except np.linalg.LinAlgError as error:
        raise CurveError(f"the curve is too degenerate to be relaxed: {error}; move near strands apart") from error


def _check_gap(curve: Curve) -> None:
    """Refuse strands so near that the energy of their edges is nothing but rounding errors."""
    if curve.dimension > 3:
        return
    gap, pair = minimal_gap(curve)
    if pair is None or gap >= NEAREST_STRANDS * curve.length:
        return
    i, j = pair
    if np.linalg.norm(curve.midpoints[i] - curve.midpoints[j]) > 1e-3 * max(
        curve.edge_lengths[i], curve.edge_lengths[j]
    ):
        return  # only their ends are near, with a short edge between them or a vertex that nearly lies on an edge
    place = ", ".join(f"{x:.6g}" for x in curve.vertices[i])
    raise CurveError(
        f"strands are only {gap:.2g} apart near ({place}), less than {NEAREST_STRANDS:g} of the curve's length, which "
        "is too near to compute their energy; move them apart"
    )


def minimize(
    curve: Curve, options: RelaxOptions | None = None, callback: Callable[[Iterate], None] | None = None
) -> Result:
    """Relax a curve to the end and return the result.

    A keyboard interrupt, or a lack of memory, keeps the curve reached so far.  ``callback`` gets every iterate, unless
    an interrupt cuts it short.  Raises as `relax` does.
    """
    options = RelaxOptions() if options is None else options
    started = time.perf_counter()
    energies: list[float] = []
    last: Iterate | None = None
    try:
        for iterate in relax(curve, options):
            if last is None or iterate.index > last.index:
                energies.append(iterate.energy)
            last = iterate
            if callback is not None:
                callback(iterate)
    except KeyboardInterrupt:
        if last is None:
            raise
        last = replace(last, status=Status.INTERRUPTED, message="interrupted: the curve reached so far is kept")
    except MemoryError:
        if last is None:
            raise
        last = replace(last, status=Status.STALLED, message="stalled: memory ran out; the curve reached so far is kept")
    assert last is not None, "relax yields at least its start"
    return Result(
        curve=last.curve,
        status=last.status,
        message=last.message,
        energies=tuple(energies),
        seconds=time.perf_counter() - started,
        certified=last.certified,
        edge_length_error=last.edge_length_error,
        method=options.method,
        negative_eigenvalues=last.negative_eigenvalues,
        last=last,
    )
