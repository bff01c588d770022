"""Increases of the energy, which evening out edge lengths or changing the mesh may cause; reported at the end."""

from itertools import pairwise

from ..energies.components import energy_scale
from ..messages import Message, joined
from .outcome import Outcome
from .trajectory import Iterate

RISE = 1e-9  # relative to the energy's scale, the least increase reported; less is rounding
RAISED = "changes of mesh or shape raised the energy: {rises}"
NAMED = 3  # changes of mesh whose energies are listed individually


class Rises:
    """All of one relaxation."""

    def __init__(self) -> None:
        self._steps: list[float] = []
        self._changes: list[list[Iterate]] = []

    def step(self, before: Iterate, after: Iterate) -> None:
        if after.edge_length_error < before.edge_length_error:
            self._steps.append(_rise(before, after))

    def change(self, before: Iterate, after: Iterate) -> None:
        """Note a change of mesh or shape; what follows at once is part of it, and longer curves have other energies."""
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
        told, rest = joined([_energies(change) for change in changes[:NAMED]], ", "), changes[NAMED:]
        if rest:
            more = "{rises}, and in {count} further changes by {total:.3g} in total"
            if len(rest) == 1:
                more = "{rises}, and in another change by {total:.3g}"
            told = Message(more, rises=told, count=len(rest), total=sum(map(_total, rest)))
        return outcome.adding(RAISED, rises=told)


def _rise(before: Iterate, after: Iterate) -> float:
    rise = after.energy - before.energy
    return rise if rise > RISE * energy_scale(before.curve.mesh, before.energy) else 0.0


def _total(change: list[Iterate]) -> float:
    return sum(_rise(before, after) for before, after in pairwise(change))


def _energies(change: list[Iterate]) -> Message:
    """The energies before and after, and the extreme one between, with digits enough to tell them apart."""
    energies = [iterate.energy for iterate in change]
    first, last, highest = energies[0], energies[-1], max(energies)
    between = highest if highest > first else min(energies)
    passed = [first, last] if between in (first, last) else [first, between, last]
    digits = 6 if f"{first:.6g}" != f"{between:.6g}" else 12
    shown = " → ".join(f"{energy:.{digits}g}" for energy in passed)
    return Message("{energies} at iteration {number}", energies=shown, number=change[-1].index)
