"""Where the energy went up, as it may where edge lengths are evened out or the mesh changes: told of in the end."""

from itertools import pairwise

from ..energies.components import energy_scale
from ..messages import Message, joined
from .outcome import Outcome
from .trajectory import Iterate

RISE = 1e-9  # increase of the energy, by its scale, that is told of; less is rounding
NAMED = 3  # changes of mesh whose energies are told one by one


class Rises:
    """All of one relaxation."""

    def __init__(self) -> None:
        self._steps: list[float] = []
        self._changes: list[list[Iterate]] = []

    def step(self, before: Iterate, after: Iterate) -> None:
        """Note a method's step."""
        if after.edge_length_error < before.edge_length_error:
            self._steps.append(_rise(before, after))

    def change(self, before: Iterate, after: Iterate) -> None:
        """Note a change of mesh, or a motion that goes with it; what follows right after it is part of the same.

        Longer curves have energies of their own.
        """
        if before.grown != after.grown:
            return
        if not (self._changes and self._changes[-1][-1].index == before.index):
            self._changes.append([before])
        self._changes[-1].append(after)

    def told(self, outcome: Outcome, steps: int) -> Outcome:
        """The outcome after so many steps, with a clause for each kind of rise."""
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
        return outcome.adding("changes of mesh or shape raised the energy: {rises}", rises=told)


def _rise(before: Iterate, after: Iterate) -> float:
    """By how much the energy went up; 0 if it did not."""
    rise = after.energy - before.energy
    return rise if rise > RISE * energy_scale(before.curve.mesh, before.energy) else 0.0


def _total(change: list[Iterate]) -> float:
    return sum(_rise(before, after) for before, after in pairwise(change))


def _energies(change: list[Iterate]) -> Message:
    """The energies before, between if that is the highest (or, where none is above the first, the lowest), and after.

    With as many digits as it takes to see that they are not equal.
    """
    energies = [iterate.energy for iterate in change]
    first, last, highest = energies[0], energies[-1], max(energies)
    between = highest if highest > first else min(energies)
    passed = [first, last] if between in (first, last) else [first, between, last]
    digits = 6 if f"{first:.6g}" != f"{between:.6g}" else 12
    shown = " → ".join(f"{energy:.{digits}g}" for energy in passed)
    return Message("{energies} at iteration {number}", energies=shown, number=change[-1].index)
