"""A hand that grabs a curve while it relaxes, and drags it."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from ..arguments import checked
from ..constraints import Barycenters
from ..curve.pins import Pins
from ..descent import NoStep, Point, Step
from ..descent.searches.armijo import on_target
from ..descent.step import leg
from ..energies.components import energy_scale
from ..energies.pull import Pull
from ..errors import MobiusFlowError, shown
from ..obstacle import MAX_COORDINATE
from ..types import FloatArray
from .outcome import Outcome
from .run import Change, Event, Intervention
from .trajectory import Iterate

STRENGTH = 5.0  # of the spring, in units of the curve's energy scale over the program's unit of length squared
FARTHEST = 100.0  # target from the held point, in the program's units; beyond this only its direction counts


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
        self._said: list[Callable[[Hold], None]] = []

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

    def _say(self, what: "Callable[[Hold], None]") -> None:
        self.rests = False
        self._said.append(what)


@dataclass(eq=False)
class Hold(Intervention):
    """Carries out the hand's instructions; asked before all interventions, and after them for its ``ending``."""

    hand: Hand
    _before: list[tuple[Point, Iterate]] = field(default_factory=list, init=False)  # each grab that may be undone

    def __call__(self, event: Event) -> Event | Change:
        said, self.hand._said, mesh = self.hand._said, [], self.run.problem.mesh
        for each in said:
            each(self)
        if self._pull is not None:
            self.run.renew()
        if self.run.problem.mesh is not mesh:
            return Change()  # the event was about another mesh
        if isinstance(event, NoStep | Outcome):
            if said:
                return Change()  # the event came before the instructions
            return self.ending(event) if self._pull is not None else event
        return event

    def ending(self, event: Event) -> Event | Change:
        """Let the run rest once where it would end, if the curve is held or the hand stays."""
        waits = self._pull is not None or self.hand.stays
        if not (isinstance(event, NoStep | Outcome) and waits):
            return event
        if self.hand.rests:
            return event.adding("a hand holds it") if self._pull and isinstance(event, Outcome) else event
        self.hand.rests = True
        self.run.charged -= 1
        return Change((Step((leg(self.run.point, self.run.point),), 0.0, None),))

    @property
    def _pull(self) -> Pull | None:
        return self.run.problem.objective.pull

    def grab(self, component: int, share: float) -> None:
        run, curve = self.run, self.run.point.curve
        if not 0 <= component < len(curve.mesh.component_sizes):
            count = len(curve.mesh.component_sizes)
            raise MobiusFlowError(f"component is {component}; the curve has {count}, counted from 0")
        self.release(pin=False)
        self._before.append((Point(run.problem, run.point.vertices, run.point.placed), run.iterate))
        run.pull(Pull.at(curve, component, share, STRENGTH * energy_scale(curve.mesh, run.point.energy)))

    def move(self, target: FloatArray) -> None:
        pull, units = self._pull, self.run.problem.units
        if pull is None:
            return
        if len(target) != len(pull.target):
            raise MobiusFlowError(f"target has {len(target)} coordinates; give {len(pull.target)}, as the curve has")
        held = pull.weights @ self.run.point.vertices
        way = units.from_user(target) - held
        size = float(np.abs(way).max())
        self.run.pull(replace(pull, target=held + way * min(1.0, FARTHEST / max(size, FARTHEST))))

    def release(self, pin: bool) -> None:
        pull = self._pull
        if pull is None:
            return
        self.run.pull(None)
        self.run.renew()
        if pin:
            self._pin(pull.vertex)

    def _pin(self, vertex: int) -> None:
        """Pin a vertex in place; targets not reached yet, which might be too short, give way to present lengths."""
        run, constraints = self.run, self.run.problem.constraints
        pins = Pins.of(run.iterate.curve, np.union1d(constraints.pins.vertices, [vertex]))
        parts = constraints.block(Barycenters).parts
        held = constraints.replacing(Barycenters.of(run.point.curve, pins, parts))
        lengths = constraints.lengths if on_target(run.point) else run.point.curve.edge_lengths
        run.start_from(run.point.changing(constraints=replace(held, pins=pins, lengths=lengths)))

    def undo(self) -> None:
        if self._before:
            self.run.go_back(*self._before.pop())
            self.run.renew()
