"""How a relaxation ends, and the sentences that say so."""

from dataclasses import dataclass, replace
from enum import Enum

from ..arguments import checked_fields
from ..errors import Place
from ..hierarchy import SampledErrors
from ..messages import Message, joined


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
    """How a relaxation ended.

    - ``status``: why it ended.
    - ``clauses``: the same in words, and what else there is to say.
    - ``negative_eigenvalues``: of the Lagrangian's Hessian at a converged curve, if known: 0 at a minimum.
    - ``symmetric_negative_eigenvalues``: those among displacements that keep the symmetry, if one is kept.
    - ``sampled_errors``: those of the hierarchical solver when last looked at: in the end, unless that came suddenly.
    - ``place``: where on the last curve the reason is, if it is somewhere.
    - ``unbounded``: whether strands pull tight without limit, so that there is no least energy to look for.
    """

    status: Status
    clauses: tuple[str, ...]
    negative_eigenvalues: int | None = None
    symmetric_negative_eigenvalues: int | None = None
    sampled_errors: SampledErrors | None = None
    place: Place | None = None
    unbounded: bool = False

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
    def message(self) -> Message:
        """All clauses in one sentence."""
        return joined(self.clauses, "; ")

    def adding(self, template: str, **facts: object) -> "Outcome":
        """The same, with another clause."""
        return replace(self, clauses=(*self.clauses, Message(template, **facts)))

    def noting(self, error: BaseException) -> "Outcome":
        """The same, with the notes of what ended it."""
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
    """There is no way on, for a reason that is a clause, at some place if it is somewhere."""
    return Outcome(Status.STALLED, (Message("stalled: {reason}", reason=reason),), place=place)


def degenerate(error: Exception) -> Message:
    return Message("the curve has become too degenerate: {error}", error=str(error).rstrip("."))


_KEPT = Message("the curve reached so far is kept")
INTERRUPTED = Outcome(Status.INTERRUPTED, (Message("interrupted: {kept}", kept=_KEPT),))
OUT_OF_MEMORY = stalled(Message("memory ran out")).adding(_KEPT)
