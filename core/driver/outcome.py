"""How a relaxation ends, what increased its energy on the way, and the sentences that say so."""

from dataclasses import asdict, dataclass, replace
from enum import Enum
from functools import cached_property
from itertools import pairwise
from typing import Any

from ..base import Message, Place, checked_fields, counted, joined
from ..curve import Curve, halved
from ..descent import Task
from ..descent.task import centred
from ..energies.components import energy_scale
from ..energies.hierarchy import SampledErrors, moebius_energy
from ..io.trajectory import Iterate

RAISED = "changes of mesh or shape raised the energy: {rises}"


class Status(Enum):
    """Why a relaxation ended."""

    CONVERGED = "converged"
    ITERATION_LIMIT = "iteration_limit"
    TIME_LIMIT = "time_limit"
    STALLED = "stalled"
    INTERRUPTED = "interrupted"


@checked_fields
@dataclass(frozen=True)
class Outcome:
    """How a relaxation ended."""

    status: Status  #: why it ended
    clauses: tuple[str, ...]  #: the reason in words, and any further remarks
    negative_eigenvalues: int | None = None  #: of the Lagrangian's Hessian at a converged curve; 0 at a minimum
    symmetric_negative_eigenvalues: int | None = None  #: those among displacements that keep a symmetry that is kept
    sampled_errors: SampledErrors | None = None  #: of the hierarchical solver, at the end unless that came suddenly
    place: Place | None = None  #: where on the last curve the reason lies, if it has a place
    unbounded: bool = False  #: whether strands pull tight without limit, so that there is no least energy to look for

    def __repr__(self) -> str:
        return f"<Outcome: {self.message:.100}>"

    @property
    def may_be_left(self) -> bool:
        """Whether there may be less energy elsewhere: the curve has come to rest, or is stuck."""
        return self.status in (Status.CONVERGED, Status.STALLED) and not self.unbounded

    @property
    def converged(self) -> bool:
        """Whether the projected gradient is as small as asked for."""
        return self.status is Status.CONVERGED

    @property
    def facts(self) -> dict[str, object]:
        """What only outcomes of its kind tell, as plain values for reports."""
        return {name: value for name, value in asdict(self).items() if name not in Outcome.__dataclass_fields__}

    @property
    def message(self) -> Message:
        """All clauses in one sentence."""
        return joined(self.clauses, "; ")

    def adding(self, template: str, **facts: object) -> "Outcome":
        """The same, with another clause."""
        return replace(self, clauses=(*self.clauses, Message(template, **facts)))

    def noting(self, error: BaseException) -> "Outcome":
        """The same, with the notes on the exception that ended it."""
        return replace(self, clauses=(*self.clauses, *getattr(error, "__notes__", ())))

    def stalling(self, reason: str, **facts: object) -> "Outcome":
        """Stalled instead, for another reason; the other clauses stay."""
        return replace(
            self, status=Status.STALLED, clauses=(*stalled(Message(reason, **facts)).clauses, *self.clauses[1:])
        )


AT_REST = "converged: projected gradient {norm:.3g} ≤ {bound:.3g}"


def converged(norm: float, bound: float) -> Outcome:
    return Outcome(Status.CONVERGED, (Message(AT_REST, norm=norm, bound=bound),))


def stalled(reason: str, place: Place | None = None) -> Outcome:
    """The outcome where no way on is left, for a reason given as a clause, and its place if it has one."""
    return Outcome(Status.STALLED, (Message("stalled: {reason}", reason=reason),), place=place)


def degenerate(error: Exception) -> Message:
    return Message("the curve has become too degenerate: {error}", error=str(error).rstrip("."))


_KEPT = Message("the curve reached so far is kept")
INTERRUPTED = Outcome(Status.INTERRUPTED, (Message("interrupted: {kept}", kept=_KEPT),))
OUT_OF_MEMORY = stalled(Message("memory ran out")).adding(_KEPT)


@checked_fields
@dataclass(frozen=True)
class Phase:
    """The cost of a relaxation on one mesh, including the change to the next one; wall-clock seconds."""

    vertices: int
    iterations: int
    seconds: float


@checked_fields
@dataclass(frozen=True, eq=False)
class Result:
    """How a relaxation ended, and where."""

    outcome: Outcome  #: why it ended
    last: Iterate  #: the last iterate
    energies: tuple[float, ...]  #: the objective at every iterate, the start first
    fallback_steps: tuple[int, ...]  #: iterates reached by the fallback method
    seconds: float  #: wall-clock time
    method: str  #: name of the requested method
    task: Task  #: what was to be relaxed
    phases: tuple[Phase, ...] = ()  #: the relaxation on each mesh, in order
    least_thickness: float | None = None  #: of all iterates, if the curve is to be a rope

    def __repr__(self) -> str:
        after = counted(self.iterations, "iteration")
        proved = "certified" if self.certified else "not certified"
        return f"<Result: {self.status.value} after {after}, objective {self.energies[-1]:.9g}, {proved}, {self.curve}>"

    @property
    def curve(self) -> Curve:
        """The last curve, in the user's units."""
        return self.last.curve

    @property
    def status(self) -> Status:
        """Why it ended."""
        return self.outcome.status

    @property
    def message(self) -> str:
        """The same in a sentence."""
        return self.outcome.message

    @property
    def certified(self) -> bool:
        """Whether every motion from the (refined) start to the result was proved free of contact."""
        return self.last.certified

    @property
    def iterations(self) -> int:
        """The number of iterates after the start, without those of strand moves."""
        moves = self.last.strand_moves
        return len(self.energies) - 1 - (moves.iterates if moves else 0)

    @property
    def final_energy(self) -> float:
        """The Möbius energy of the last curve, without the objective's other terms: as in ``mobius-flow energy``."""
        return self._final_energy[0]

    @property
    def final_energy_error(self) -> float:
        """A bound on its relative error, from a sample: 0 up to 30,000 vertices, where the energy is exact."""
        return self._final_energy[1]

    @cached_property
    def _final_energy(self) -> tuple[float, float]:
        return moebius_energy(centred(self.curve))

    @cached_property
    def mesh_error(self) -> float | None:
        """About how much the final energy differs from that of the smooth curve through the vertices, in its units.

        Halving all edges along splines removes three quarters of it.  None for open and for large curves.
        """
        # more vertices take more than a second
        if not self.curve.mesh.all_closed or len(self.curve) > 3000:
            return None
        return abs(self.final_energy - moebius_energy(centred(halved(self.curve)))[0]) / 0.75

    def show(self) -> Any:
        """The result as a figure that can be turned, with the objective beside it; notebooks display it.

        Raises MobiusFlowError if Plotly is not installed, CurveError if the curve is not in the plane or in space.
        """
        from ..keys.view import figure, still  # pictures are made of results, not the other way round

        return figure(still(self.curve, self.energies), title=f"Möbius energy {self.final_energy:.6g}")

    def report(self) -> dict[str, object]:
        """The result as the plain values that ``--report`` writes."""
        errors = self.outcome.sampled_errors
        return {
            "status": self.status.value,
            "message": self.message,
            "iterations": self.iterations,
            "seconds": self.seconds,
            "phases": [asdict(phase) for phase in self.phases],
            "energy": list(self.energies),
            "final_energy": self.final_energy,
            "final_energy_error": self.final_energy_error,
            "vertices": len(self.curve),
            "components": len(self.curve.mesh.component_sizes),
            "pins": list(self.last.pins),
            "symmetry": self.last.symmetry or None,
            "obstacles": len(self.task.obstacles),
            "grown": self.last.grown,
            "radius": None if self.last.radius is None else list(self.last.radius),
            "least_thickness": self.least_thickness,
            "max_edge_length_error": self.last.edge_length_error,
            "certified": self.certified,
            "method": self.method,
            "fallback_steps": list(self.fallback_steps),
            "negative_eigenvalues": self.outcome.negative_eigenvalues,
            "symmetric_negative_eigenvalues": self.outcome.symmetric_negative_eigenvalues,
            "sampled_errors": None if errors is None else asdict(errors),
            "strand_moves": self.last.strand_moves and self.last.strand_moves.report(),
        }


class Rises:
    """The increases of the energy in one relaxation."""

    def __init__(self) -> None:
        self._steps: list[float] = []
        self._changes: list[list[Iterate]] = []

    def step(self, before: Iterate, after: Iterate) -> None:
        if after.edge_length_error < before.edge_length_error:
            self._steps.append(_rise(before, after))

    def change(self, before: Iterate, after: Iterate) -> None:
        """Note a change of mesh or shape, as part of one just before it; not where lengths grew, as energies differ."""
        if before.grown != after.grown:
            return
        if not (self._changes and self._changes[-1][-1].index == before.index):
            self._changes.append([before])
        self._changes[-1].append(after)

    def summarised(self, outcome: Outcome, steps: int) -> Outcome:
        """The outcome with a clause for each kind of increase, out of a number of steps."""
        rises = [rise for rise in self._steps if rise]
        if rises:
            rose = "the energy rose in {count} of {steps} steps, by {total:.3g} in total, while lengths were equalized"
            outcome = outcome.adding(rose, count=len(rises), steps=steps, total=sum(rises))
        changes = [change for change in self._changes if _total(change)]
        if not changes:
            return outcome
        # the first changes are listed one by one
        named, rest = [], changes[3:]
        for change in changes[:3]:  # before, after, the extreme one in between
            energies = [iterate.energy for iterate in change]
            first, last, highest = energies[0], energies[-1], max(energies)
            between = highest if highest > first else min(energies)
            passed = [first, last] if between in (first, last) else [first, between, last]
            digits = 6 if f"{first:.6g}" != f"{between:.6g}" else 12
            shown = " → ".join(f"{energy:.{digits}g}" for energy in passed)
            named.append(Message("{energies} at iteration {number}", energies=shown, number=change[-1].index))
        told = joined(named, ", ")
        if rest:
            more = "{rises}, and in {count} further changes by {total:.3g} in total"
            if len(rest) == 1:
                more = "{rises}, and in another change by {total:.3g}"
            told = Message(more, rises=told, count=len(rest), total=sum(map(_total, rest)))
        return outcome.adding(RAISED, rises=told)


def _rise(before: Iterate, after: Iterate) -> float:
    rise = after.energy - before.energy
    # less is rounding
    return rise if rise > 1e-9 * energy_scale(before.curve.mesh, before.energy) else 0.0


def _total(change: list[Iterate]) -> float:
    return sum(_rise(before, after) for before, after in pairwise(change))
