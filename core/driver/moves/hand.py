"""A hand that grabs a curve while it relaxes and drags it, and what it asks for."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from ...base import FloatArray, MobiusFlowError, checked, shown
from ...curve import MAX_COORDINATE, Pins
from ...descent import NoStep, Point, SearchState, Step, leg, on_target
from ...energies.components import energy_scale
from ...energies.pull import Pull
from ...io.trajectory import Iterate
from ...solve.constraints import Barycenters
from ..move import Change, Event, Move
from ..outcome import Outcome


class Hand:
    """A hand that drags a curve while `relax` runs; it takes instructions between two iterates.

    The curve follows as far as other strands and obstacles leave room, by motions proved like all others, and relaxes
    around the hand; once released it goes on relaxing.  While it is held, iterations do not count, energies exclude the
    hand, and the run does not end: where the curve comes to rest, the run sets ``rests`` and yields its iterate again,
    and it ends only if no instruction follows.

    Parameters
    ----------
    stays
        Whether the run waits in this way wherever it would end, even if the curve is not held.

    Examples
    --------
    >>> from mobius_flow.core import Hand, RelaxOptions, relax
    >>> from mobius_flow.core.knots import knot
    >>> hand = Hand()
    >>> for iterate in relax(knot("3_1"), RelaxOptions(vertices=60), hand=hand):
    ...     if iterate.index == 5:
    ...         hand.grab(0, 0.25)
    ...     if 5 <= iterate.index < 15:
    ...         hand.move([0.1 * (iterate.index - 5), 0, 0])
    ...     if iterate.index == 15:
    ...         hand.release(pin=True)
    >>> iterate.certified, len(iterate.pins)
    (True, 1)
    """

    @checked
    def __init__(self, stays: bool = False) -> None:
        self.stays, self.rests = stays, False
        self.said: list[Callable[[Hold], None]] = []  # what `Hold` has not carried out yet

    @checked
    def grab(self, component: int, share: float) -> None:
        """Grab a component, counted from 0, at a share of its length from its first vertex on.

        Raises MobiusFlowError if the share is not in [0, 1]; the run raises it if there is no such component.
        """
        if not 0.0 <= share <= 1.0:
            raise MobiusFlowError(f"share is {share}; give a share of the component's length, from 0 to 1")
        self._say(lambda hold: hold.grab(component, share))

    def move(self, target: npt.ArrayLike) -> None:
        """Pull the held part towards a point, shape (m,), in the curve's units; the latest target counts.

        Raises MobiusFlowError if it is no such point; the run raises it if the curve has another dimension.
        """
        try:
            point = np.array(target, dtype=np.float64)
        except (TypeError, ValueError, OverflowError):
            point = np.empty(0)
        if point.ndim != 1 or len(point) < 2 or not np.abs(point).max() <= MAX_COORDINATE:  # NaN is not
            raise MobiusFlowError(f"target is {shown(target)}; give the finite coordinates of a point")
        self._say(lambda hold: hold.move(point))

    @checked
    def release(self, pin: bool = False) -> None:
        """Let go; with a pin, the vertex in the middle of the held part stays where it is from then on."""
        self._say(lambda hold: hold.release(pin))

    def undo(self) -> None:
        """Go back to the iterate before the last grab, as if nothing after it had happened.

        The next iterate takes the number after that one; a `Trajectory` that has the undone ones refuses it.
        """
        self._say(lambda hold: hold.undo())

    def _say(self, what: Callable[["Hold"], None]) -> None:
        self.rests = False
        self.said.append(what)


@dataclass(eq=False)
class AwaitHand(Move):
    """Let the run rest once where it would end, if a hand holds the curve or stays, and wait for what it does next."""

    def __call__(self, event: Event) -> Event | Change:
        run, hand, held = self.run, self.run.hand, self.run.problem.objective.pull is not None
        if hand is None or not (isinstance(event, NoStep | Outcome) and (held or hand.stays)):
            return event
        if hand.rests:
            return event.adding("a hand holds it") if held and isinstance(event, Outcome) else event
        hand.rests = True
        run.charged -= 1
        return Change((Step((leg(run.point, run.point),), 0.0, None),))


@dataclass(eq=False)
class Hold(AwaitHand):
    """Carry out the instructions of a hand, if there is one."""

    lasts = True  # what was grabbed before can still be undone
    _before: list[tuple[Point, Iterate]] = field(default_factory=list, init=False)  # each grab that may be undone

    def __call__(self, event: Event) -> Event | Change:
        hand, mesh = self.run.hand, self.run.problem.mesh
        if hand is None:
            return event
        said, hand.said = hand.said, []
        for each in said:
            each(self)
        if self._pull is not None:
            self._recount()
        if self.run.problem.mesh is not mesh:
            return Change()  # the event was about another mesh
        if isinstance(event, NoStep | Outcome):
            if said:
                return Change()  # the event came before the instructions
            return super().__call__(event) if self._pull is not None else event
        return event

    def grab(self, component: int, share: float) -> None:
        run, curve = self.run, self.run.point.curve
        if not 0 <= component < len(curve.mesh.component_sizes):
            count = len(curve.mesh.component_sizes)
            raise MobiusFlowError(f"component is {component}; the curve has {count}, counted from 0")
        self.release(pin=False)
        self._before.append((Point(run.problem, run.point.vertices, run.point.placed), run.iterate))
        # of the spring, in units of the energy scale over the program's unit of length squared
        self._take_hold(Pull.at(curve, component, share, 5.0 * energy_scale(curve.mesh, run.point.energy)))

    def move(self, target: FloatArray) -> None:
        pull, units = self._pull, self.run.problem.units
        if pull is None:
            return
        if len(target) != len(pull.target):
            raise MobiusFlowError(f"target has {len(target)} coordinates; give {len(pull.target)}, as the curve has")
        held = pull.weights @ self.run.point.vertices
        way = units.from_user(target) - held
        size = float(np.abs(way).max())
        # beyond a hundred of the program's units only the target's direction counts
        self._take_hold(replace(pull, target=held + way * min(1.0, 100.0 / max(size, 100.0))))

    def release(self, pin: bool) -> None:
        pull, run = self._pull, self.run
        if pull is None:
            return
        self._take_hold(None)
        self._recount()
        if pin:
            constraints = run.problem.constraints
            pins = Pins.of(run.iterate.curve, np.union1d(constraints.pins.vertices, [pull.vertex]))
            held = Barycenters.of(run.point.curve, pins, constraints.barycenters.parts)
            # targets that are not reached yet might be too short: they give way to present lengths
            lengths = constraints.lengths if on_target(run.point) else run.point.curve.edge_lengths
            run.view(run.point.changing(constraints=replace(constraints, barycenters=held, pins=pins, lengths=lengths)))

    def undo(self) -> None:
        run = self.run
        if self._before:
            point, run.iterate = self._before.pop()
            run.certified = run.iterate.certified
            run.view(point)
            self._recount()

    @property
    def _pull(self) -> Pull | None:
        return self.run.problem.objective.pull

    def _take_hold(self, pull: Pull | None) -> None:
        """Go on from the same curve with another pull, or none."""
        run, held = self.run, self._pull is not None
        run.view(run.point.pulled(pull))
        run.energies.clear()
        if held != (pull is not None):
            run.memory = SearchState()

    def _recount(self) -> None:
        """Count iterations from here on."""
        self.run.charged = -self.run.iterate.index
