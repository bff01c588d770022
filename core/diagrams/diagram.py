"""Link diagrams as signed Gauss codes: what every strand passes, one after the other, and the signs of the crossings.

A signed Gauss code determines the diagram on the sphere, so nothing else is stored.  Pass i is the i-th of all passes,
component by component; edge i runs from it to the next pass of its component.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

Pass = tuple[int, bool]  # a crossing, and whether the strand passes over
PlanarCrossing = tuple[int, int, int, int]  # edges counterclockwise from the one that comes in below


@dataclass(frozen=True)
class Diagram:
    """A diagram of an oriented link.

    Attributes
    ----------
    passes
        For each component the crossings that it passes, in order; empty for a circle that crosses nothing.
    signs
        1 or −1 for each crossing; crossings are numbered from 0.
    """

    passes: tuple[tuple[Pass, ...], ...]
    signs: tuple[int, ...]

    @property
    def crossings(self) -> int:
        """Number of crossings."""
        return len(self.signs)

    @property
    def writhe(self) -> int:
        """Sum of the signs."""
        return sum(self.signs)

    @cached_property
    def sequence(self) -> list[Pass]:
        """All passes, component by component."""
        return [each for part in self.passes for each in part]

    @cached_property
    def component(self) -> list[int]:
        """The component of each pass."""
        return [k for k, part in enumerate(self.passes) for _ in part]

    @cached_property
    def next(self) -> list[int]:
        """The pass after each pass."""
        following: list[int] = []
        for part in self.passes:
            first = len(following)
            following += [*range(first + 1, first + len(part)), *([first] if part else [])]
        return following

    @cached_property
    def previous(self) -> list[int]:
        """The pass before each pass."""
        before = [0] * len(self.next)
        for i, after in enumerate(self.next):
            before[after] = i
        return before

    @cached_property
    def strands(self) -> list[tuple[int, int]]:
        """For each crossing its lower and its upper pass."""
        found = [[0, 0] for _ in self.signs]
        for i, (crossing, over) in enumerate(self.sequence):
            found[crossing][over] = i
        return [(lower, upper) for lower, upper in found]

    @property
    def planar_code(self) -> list[PlanarCrossing]:
        """For each crossing its four edges, counterclockwise from the one that comes in below."""
        return [tuple(edge for edge, _ in around) for around in self.rotations()]  # type: ignore[misc]

    def rotations(self) -> Iterator[tuple[tuple[int, bool], ...]]:
        """For each crossing its four edges as `planar_code` has them, and whether each goes out there."""
        for (lower, upper), sign in zip(self.strands, self.signs, strict=True):
            right, left = (upper, True), (self.previous[upper], False)
            if sign < 0:
                right, left = left, right
            yield (self.previous[lower], False), right, (lower, True), left

    def joins(self) -> Iterator[tuple[int, int]]:
        """The components that meet at each crossing, the lower one first."""
        for lower, upper in self.strands:
            yield self.component[lower], self.component[upper]

    @property
    def own_writhe(self) -> int:
        """Sum of the signs of crossings of components with themselves, whatever their orientations."""
        return sum(sign for sign, (a, b) in zip(self.signs, self.joins(), strict=True) if a == b)

    @property
    def linking_numbers(self) -> tuple[int, ...]:
        """Linking numbers of all pairs of components: of the first with the second, the third, …"""
        doubled: dict[tuple[int, int], int] = {}
        for sign, (a, b) in zip(self.signs, self.joins(), strict=True):
            pair = min(a, b), max(a, b)
            doubled[pair] = doubled.get(pair, 0) + sign
        count = len(self.passes)
        return tuple(doubled.get((a, b), 0) // 2 for a in range(count) for b in range(a + 1, count))

    def without(self, removed: set[int]) -> "Diagram":
        """The code without some crossings; whether that is a diagram of the same link is for the caller to know."""
        number = {c: k for k, c in enumerate(c for c in range(self.crossings) if c not in removed)}
        passes = tuple(tuple((number[c], over) for c, over in part if c in number) for part in self.passes)
        return Diagram(passes, tuple(self.signs[c] for c in number))

    def restricted(self, components: set[int]) -> "Diagram":
        """The sublink of some components."""
        foreign = {c for c, pair in enumerate(self.joins()) if not components.issuperset(pair)}
        rest = self.without(foreign)
        return Diagram(tuple(part for k, part in enumerate(rest.passes) if k in components), rest.signs)

    def pieces(self) -> list["Diagram"]:
        """The parts that no crossing joins, each a diagram of its own."""
        groups = [{k} for k in range(len(self.passes))]
        for a, b in set(self.joins()):
            if groups[a] is not groups[b]:
                groups[a] |= groups[b]
                for k in groups[b]:
                    groups[k] = groups[a]
        found = {id(group): group for group in groups}
        return [self.restricted(group) for group in found.values()]
