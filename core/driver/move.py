"""What may act on a run between its steps: the events that moves are told of, and the changes they answer with."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from ..curve.refine import Resolution
from ..descent import Method, NoStep, Point, Step
from ..io.trajectory import Iterate
from .outcome import Outcome

if TYPE_CHECKING:
    from .run import Run


class Start:
    """Nothing has happened yet on this mesh."""


Event = Start | Step | NoStep | Outcome


@dataclass(frozen=True, eq=False)
class Change:
    """What a move proposes: proved steps, if any, and then another view of the curve they lead to."""

    steps: tuple[Step, ...] = ()  # motions that come first; that they end on the constraints is up to the move
    point: Point | None = None  # the curve reached, in another problem: with other constraints, or on another mesh
    method: Method | None = None  # the method that takes over
    resolution: Resolution | None = None  # new bounds of edge lengths
    iterates: Iterable[Iterate] = ()  # motions that change the run themselves as they go on
    anew: bool = False  # whether the run goes on from there as from a start


@dataclass(eq=False)
class Move:
    """What may act on a run between steps: made for one run, it is called after every event.

    A subclass overrides the methods for the events that concern it, or ``__call__`` for all at once.  Each returns the
    event as later moves are to see it, or a change, after which these are not asked, or None, which leaves the
    event as it is.  Settings are fields.  Where the run goes on as from a start moves are made again, unless they last.
    """

    run: "Run"
    lasts: ClassVar[bool] = False

    def __call__(self, event: Event) -> Event | Change:
        answer: Event | Change | None
        match event:
            case Start():
                answer = self.started()
            case Step():
                answer = self.stepped(event)
            case NoStep():
                answer = self.stuck(event)
            case Outcome():
                answer = self.ended(event)
        return event if answer is None else answer

    def started(self) -> Event | Change | None:
        """At the start, and after every change of mesh."""
        return None

    def stepped(self, step: Step) -> Event | Change | None:
        """After a step of the method."""
        return None

    def stuck(self, found: NoStep) -> Event | Change | None:
        """Where the method finds no step."""
        return None

    def ended(self, outcome: Outcome) -> Event | Change | None:
        """Where the run would end."""
        return self.converged(outcome) if outcome.converged else None

    def converged(self, outcome: Outcome) -> Event | Change | None:
        """Where it would end at rest."""
        return None

    def summarised(self, outcome: Outcome) -> Outcome:
        """The outcome of the whole run with clauses about what the move did."""
        return outcome
