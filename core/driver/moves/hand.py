"""What a hand asks for is carried out, and runs wait for it."""

from dataclasses import dataclass, field, replace

import numpy as np

from ...base import FloatArray, MobiusFlowError
from ...curve import Pins
from ...descent import NoStep, Point, SearchState, Step, leg, on_target
from ...energies.components import energy_scale
from ...energies.pull import Pull
from ...io.trajectory import Iterate
from ...solve.constraints import Barycenters
from ..move import Change, Event, Move
from ..outcome import Outcome


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
