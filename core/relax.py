"""The one driver: `relax` yields the iterates of a relaxation, `minimize` runs it to its end."""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .collision import check_embedded
from .curve import Curve, check_is_curve
from .energies import MoebiusEnergy
from .errors import CurveError, OptionError
from .iterate import Iterate, Status
from .options import RelaxOptions
from .run import Run
from .setup import check_size, embedded_refinement, method_named, start_problem
from .units import centred, check_units

WIDTHS = 100.0  # the curve's width, in lengths of a component, from which that is the reason for a singular matrix
RISE = 1e-9  # relative increase of the energy in one step that is told of; less is rounding


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

    @cached_property
    def final_energy(self) -> float:
        """The Möbius energy of the last curve, without what the objective adds: what ``mobius-flow energy`` prints."""
        return MoebiusEnergy().value(centred(self.curve))

    def report(self) -> dict[str, object]:
        """The result as the plain values that ``--report`` writes."""
        return {
            "status": self.status.value,
            "message": self.message,
            "iterations": len(self.energies) - 1,
            "seconds": self.seconds,
            "energy": list(self.energies),
            "final_energy": self.final_energy,
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
    check_is_curve(curve)
    options = RelaxOptions() if options is None else options
    if not isinstance(options, RelaxOptions):
        raise OptionError(f"options is of type {type(options).__name__}; give RelaxOptions(method=…, …)")
    method_named(options.method)
    check_size(curve, options)
    check_units(curve)
    check_embedded(curve)
    refined = embedded_refinement(curve, options.vertices)
    try:
        run = Run(start_problem(refined, options), refined, options)
    except np.linalg.LinAlgError as error:
        raise CurveError(f"the curve is too degenerate to be relaxed: {error}; {_remedy(refined)}") from error
    penalised = not method_named(options.method).geometry.prescribes  # its energy contains the lengths
    return run.iterates() if penalised else _with_rises_told(run.iterates())


def _remedy(curve: Curve) -> str:
    """What to do about a singular matrix: parts too small for their distances, or else strands that are too near."""
    lengths = np.array([curve.edge_lengths[s].sum() for s in curve.mesh.slices])
    shortest, width = int(lengths.argmin()), float(np.ptp(curve.vertices, axis=0).max())
    if width < WIDTHS * lengths[shortest]:
        return "move near strands apart"
    return (
        f"component {shortest + 1} is only {lengths[shortest]:.3g} long in a link {width:.3g} wide, too small or too "
        "far away to be relaxed together with the rest: relax it by itself, or move or scale it"
    )


def _with_rises_told(iterates: Iterator[Iterate]) -> Iterator[Iterate]:
    """The same iterates; the last one's message tells how much energy it took to even edge lengths out, if any."""
    last: Iterate | None = None
    rises: list[float] = []
    for iterate in iterates:
        if last is not None and iterate.path and iterate.edge_length_error < last.edge_length_error:
            rises += [iterate.energy - last.energy] if iterate.energy > (1.0 + RISE) * last.energy else []
        last = iterate
        if rises and iterate.status is not Status.RUNNING:
            told = f"the energy rose in {len(rises)} of {iterate.index} steps, by {sum(rises):.3g} in all"
            iterate = replace(iterate, message=f"{iterate.message}; {told}, while edge lengths were evened out")
        yield iterate


def minimize(
    curve: Curve, options: RelaxOptions | None = None, callback: Callable[[Iterate], None] | None = None
) -> Result:
    """Relax a curve to the end and return the result.

    A keyboard interrupt, or a lack of memory, keeps the curve reached so far.  ``callback`` gets every iterate, unless
    an interrupt cuts it short.  Raises as `relax` does.
    """
    if callback is not None and not callable(callback):
        raise OptionError(f"callback is of type {type(callback).__name__}; give a function of one Iterate")
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
