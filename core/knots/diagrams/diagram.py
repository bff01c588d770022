"""Link diagrams on the sphere, stored as signed Gauss codes: what each component passes, and signs of crossings.

A signed Gauss code determines the diagram, and everything else is derived from it.  *Pass* i is the i-th of all passes,
component by component; *edge* i runs from it to the next pass of its component; *dart* 2i runs along edge i and dart
2i + 1 back, so that ``dart ^ 1`` is the reverse of a dart.  A *strand* is a run of passes that are all over, or all
under.

Among the passes there may be places where the curve is held: `PIN`, and `ENDS` where an open component begins and ends.
They divide edges, and no strand goes on there; at ends a face meets itself.
"""

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from ...base import CurveError

Pass = tuple[int, bool]  # a crossing, and whether the curve passes over
PIN: Pass = (-1, True)
ENDS: Pass = (-1, False)
PlanarCrossing = tuple[int, int, int, int]  # edges counterclockwise from the one that comes in below


@dataclass(frozen=True)
class Diagram:
    """A diagram of an oriented link."""

    passes: tuple[tuple[Pass, ...], ...]  # of each component, in order; none of a circle that crosses nothing
    signs: tuple[int, ...]  # 1 or −1 for each crossing, numbered from 0

    @property
    def crossings(self) -> int:
        return len(self.signs)

    @property
    def writhe(self) -> int:
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
        """The pass before each pass, which is also the edge that leads to it."""
        before = [0] * len(self.next)
        for i, after in enumerate(self.next):
            before[after] = i
        return before

    @cached_property
    def levels(self) -> list[tuple[int, int]]:
        """For each crossing its lower and its upper pass."""
        found = [[0, 0] for _ in self.signs]
        for i, (crossing, over) in enumerate(self.sequence):
            if crossing >= 0:
                found[crossing][over] = i
        return [(lower, upper) for lower, upper in found]

    @cached_property
    def darts(self) -> list[tuple[int, int, int, int]]:
        """The four darts that leave each crossing, counterclockwise from the edge that comes in below."""
        found = []
        for (lower, upper), sign in zip(self.levels, self.signs, strict=True):
            right, left = 2 * upper, 2 * self.previous[upper] + 1
            if sign < 0:
                right, left = left, right
            found.append((2 * self.previous[lower] + 1, right, 2 * lower, left))
        return found

    @property
    def planar_code(self) -> list[PlanarCrossing]:
        """For each crossing its four edges, counterclockwise from the one that comes in below."""
        return [(a // 2, b // 2, c // 2, d // 2) for a, b, c, d in self.darts]

    @cached_property
    def faces(self) -> list[list[int]]:
        """The darts round each region of the sphere, which lies on their left, one after the other."""
        nodes: list[tuple[int, ...]] = [*self.darts]
        for i, each in enumerate(self.sequence):
            if each[0] < 0:  # the darts that leave places where the curve is held: both from pins, one by one from ends
                ends = 2 * self.previous[i] + 1, 2 * i
                nodes += [ends] if each == PIN else [ends[:1], ends[1:]]
        after = {around[k] ^ 1: around[k - 1] for around in nodes for k in range(len(around))}
        found: list[list[int]] = []
        for start in (each for around in nodes for dart in around for each in (dart, dart ^ 1)):
            face, dart = [], start
            while dart in after:
                face.append(dart)
                dart = after.pop(dart)
            found += [face] if face else []
        return found

    @cached_property
    def face_of(self) -> list[int]:
        """The face on the left of each dart."""
        number = [0] * (2 * len(self.sequence))
        for k, face in enumerate(self.faces):
            for dart in face:
                number[dart] = k
        return number

    @property
    def is_planar(self) -> bool:
        """Whether the code is of a diagram on the sphere: Euler's formula holds for each piece."""
        pieces = sum(any(piece.passes) for piece in self.pieces())
        return len(self.faces) == self.crossings + 2 * pieces - self.sequence.count(ENDS)

    def joins(self) -> Iterator[tuple[int, int]]:
        """The components that meet at each crossing, the lower one first."""
        for lower, upper in self.levels:
            yield self.component[lower], self.component[upper]

    @property
    def own_writhe(self) -> int:
        """Sum of the signs of crossings of components with themselves, whatever their orientations."""
        return sum(sign for sign, (a, b) in zip(self.signs, self.joins(), strict=True) if a == b)

    @property
    def linking_numbers(self) -> tuple[int, ...]:
        """Linking numbers of all pairs of components: of the first with the second, the third, …"""
        count = len(self.passes)
        doubled = {(a, b): 0 for a in range(count) for b in range(a + 1, count)}
        for sign, (a, b) in zip(self.signs, self.joins(), strict=True):
            if a != b:
                doubled[min(a, b), max(a, b)] += sign
        return tuple(twice // 2 for twice in doubled.values())

    def without(self, removed: set[int]) -> "Diagram":
        """The code without some crossings; whether that is a diagram of the same link is for the caller to know."""
        number = {c: k for k, c in enumerate(c for c in range(self.crossings) if c not in removed)}
        signs = tuple(self.signs[c] for c in number)
        number[PIN[0]] = PIN[0]
        return Diagram(
            tuple(tuple((number[c], over) for c, over in part if c in number) for part in self.passes), signs
        )

    @property
    def without_pins(self) -> "Diagram":
        """The code without the places where the curve is held but goes on, which no circle needs to go through."""
        return replace(self, passes=tuple(tuple(each for each in part if each != PIN) for part in self.passes))

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


def diagram_of(code: Sequence[Sequence[Hashable]]) -> Diagram:
    """The diagram of a planar diagram code; components run as the code has their first lower pass.

    ``code`` has for each crossing the labels of its edges, as in `PlanarCrossing`.  Raises CurveError if a crossing has
    not four edges, an edge not two ends, or the code cannot be drawn in the plane.
    """
    ends: dict[Hashable, list[tuple[int, int]]] = {}  # of each edge: a crossing, and a place there from 0 to 3
    for c, edges in enumerate(code):
        if len(edges) != 4:
            raise CurveError(f"crossing {c + 1} of the planar diagram code has {len(edges)} edges; it must have 4")
        for place, label in enumerate(edges):
            ends.setdefault(label, []).append((c, place))
    for label, pair in ends.items():
        if len(pair) != 2:
            times = "once" if len(pair) == 1 else f"{len(pair)} times"
            raise CurveError(f"edge {label} is in the planar diagram code {times}; every edge must be there twice")
    other_end = {end: other for pair in ends.values() for end, other in (pair, pair[::-1])}
    entries: dict[tuple[int, int], Pass] = {}  # where components come in
    components = []
    for start in [(c, place) for place in (0, 1) for c in range(len(code))]:
        if start not in entries and (start[0], start[1] + 2) not in entries:
            first = len(entries)
            end = start
            while end not in entries:
                entries[end] = end[0], end[1] % 2 == 1
                end = other_end[end[0], (end[1] + 2) % 4]
            components.append(tuple(list(entries.values())[first:]))
    # A positive crossing's upper strand comes in on the left, the fourth edge from where the lower one comes in.
    signs = (1 if ((c, 0) in entries) == ((c, 3) in entries) else -1 for c in range(len(code)))
    diagram = Diagram(tuple(components), tuple(signs))
    if not diagram.is_planar:
        raise CurveError("the planar diagram code cannot be drawn in the plane")
    return diagram
