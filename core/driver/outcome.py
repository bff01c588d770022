"""How a relaxation ends, and the sentences that say so."""

from dataclasses import dataclass, replace
from enum import Enum

from ..arguments import checked_fields
from ..errors import Place, counted
from ..hierarchy import SampledErrors

_NEXT = "; "  # between clauses


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

    Attributes
    ----------
    status
        Why it ended.
    message
        The same in one sentence.
    negative_eigenvalues
        Of the Lagrangian's Hessian at a converged curve, if asked for: 0 at a minimum, more at a saddle.
    sampled_errors
        Of the hierarchical solver, when they were last looked at: in the end, unless that came of a sudden; else None.
    place
        Where on the last curve the reason is, if it is somewhere.
    unbounded
        Whether strands pull tight without limit, so that there is no least energy to look for.
    """

    status: Status
    message: str
    negative_eigenvalues: int | None = None
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

    def adding(self, more: str) -> "Outcome":
        """The same, with more to say."""
        return replace(self, message=f"{self.message}{_NEXT}{more}")

    def stalling(self, reason: str) -> "Outcome":
        """Stalled instead, for a reason that is a clause; what else there was to say is said still."""
        _, *told = self.message.split(_NEXT)
        return replace(self, status=Status.STALLED, message=_NEXT.join([stalled(reason).message, *told]))


def converged(norm: float, bound: float) -> Outcome:
    """The projected gradient is small enough."""
    return Outcome(Status.CONVERGED, f"converged: projected gradient {norm:.3g} ≤ {bound:.3g}")


def out_of_iterations(count: int) -> Outcome:
    """The limit is reached."""
    return Outcome(Status.ITERATION_LIMIT, f"stopped after {counted(count, 'iteration')}, as asked for")


def out_of_time(seconds: float) -> Outcome:
    """The time is up."""
    return Outcome(Status.TIME_LIMIT, f"stopped at the time limit, {seconds:g} s, as asked for")


def stalled(reason: str, place: Place | None = None) -> Outcome:
    """There is no way on, for a reason that is a clause."""
    return Outcome(Status.STALLED, f"stalled: {reason}", place=place)


INTERRUPTED = Outcome(Status.INTERRUPTED, "interrupted: the curve reached so far is kept")
OUT_OF_MEMORY = stalled("memory ran out; the curve reached so far is kept")
FEWER = "it has {vertices} vertices, {given} at the start"
DEGENERATE = "the curve has become too degenerate: {error}"
HELD = (
    "parts that are not linked, which would drift apart without limit, are held in place; "
    "the sum of their own energies is {energy:.6g}"
)
FROZEN = "nothing can move: all vertices are pinned, or on straight arcs between pins"
SADDLE, MINIMUM = "a saddle with index {index}", "a minimum"
NO_WAY_DOWN = "no way down was found"
ILL_CONDITIONED = "the Hessian is too ill-conditioned to tell a minimum from a saddle"
COMPOSITE = (
    "strands pull tight, and would do so without limit: the curve is composite, knotted both inside and outside the "
    "ball of radius {radius:.3g} around ({center}), and has no shape of least energy"
)
UNTESTED = "whether it is composite was not tested, as its components could lie in too many ways"
UNRESOLVED = (
    "strands are nearer than this mesh resolves; with more vertices or a finer mesh there is less energy to reach"
)
ADVICE = "more vertices or an adaptive mesh may help"
CROWDED = "no motion that changes the lengths as asked for is free of contact and takes little enough energy"
GREW = "grew to {grown:.6g} of {wanted:.6g} times its length"
TIGHTENED = "distant clusters were expanded to order {order} for the accuracy asked for"
INACCURATE = (
    "the hierarchical solver is less accurate than asked for: dense sums over sampled edges put its relative errors at "
    "up to {energy:.1g} in the energy and {norm:.1g} in the gradient's norm; the dense solver has none of them"
)
ROSE = "the energy rose in {count} of {steps} steps, by {total:.3g} in all, while edge lengths were evened out"
UNEVEN = "edge lengths are still off their targets by up to {percent:.2g} %"
HOPS = "{taken} of {tried} led lower"
IS_UNKNOT = "the curve is an unknot, and a circle has less energy"
MAY_BE_UNKNOT = "the curve may be an unknot, for its Alexander polynomial is trivial, and a circle has less energy"
REMESHED = "changes of mesh or shape raised the energy: {rises}"
