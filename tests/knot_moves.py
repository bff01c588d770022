"""Simplify knot diagrams: loops are undone, and strands that pass over (or under) others take shorter ways.

A strand that only passes over what it meets can be lifted off and laid down along any other way between its
ends; the shortest one is found among the faces of the diagram. With ways of equal length taken by lot, this
brings most hard diagrams down (pass moves, as SnapPy's link simplification uses them).
"""

from collections import deque
from collections.abc import Iterator

import numpy as np
from knot_diagrams import Diagram

Slot = tuple[int, int]  # crossing, and which of its four ends: 0 and 2 lower, 1 and 3 upper, counterclockwise
Links = dict[Slot, Slot]  # what each end is joined to

_START, _END = (-1, 0), (-2, 0)  # loose ends of a strand taken out


def simplified(found: Diagram, enough: int, rounds: int = 400, seed: int = 1) -> Diagram:
    """Give a simpler diagram of the same knot; stops at ``enough`` crossings or after some rounds without gain."""
    rng = np.random.default_rng(seed)
    links = _links(found)
    best, idle = links, 0
    while len(best) > 4 * enough and idle < rounds:
        links = _improved(_without_loops(links), rng)
        idle = idle + 1 if len(links) >= len(best) else 0
        best = min(best, links, key=len)
    return _diagram(_without_loops(best))


def _links(found: Diagram) -> Links:
    ends: dict[int, list[Slot]] = {}
    for c, labels in enumerate(found.pd_code()):
        for i, label in enumerate(labels):
            ends.setdefault(label, []).append((c, i))
    return {a: b for first, second in ends.values() for a, b in ((first, second), (second, first))}


def _diagram(links: Links) -> Diagram:
    """Follow the knot once round."""
    if not links:
        return Diagram(((),), {})
    start = at = min(links)
    passes: list[tuple[int, bool]] = []
    entered: dict[tuple[int, bool], int] = {}
    while not passes or at != start:
        crossing, i = links[at]
        over = i % 2 == 1
        passes.append((crossing, over))
        entered[crossing, over] = i
        at = (crossing, (i + 2) % 4)
    # Seen along the lower strand, the upper one of a positive crossing comes from the left.
    signs = {c: 1 if (entered[c, True] - entered[c, False]) % 4 == 3 else -1 for c, over in passes if over}
    return Diagram((tuple(passes),), signs)


def _join(links: Links, a: Slot, b: Slot) -> None:
    links[a], links[b] = b, a


def _delete(links: Links, crossing: int) -> None:
    """Take a crossing away and let both its strands run through."""
    for i in (0, 1):
        _join(links, links[crossing, i], links[crossing, i + 2])
    for i in range(4):
        del links[crossing, i]


def _without_loops(links: Links) -> Links:
    links = dict(links)
    while True:
        loops = [c for (c, i), (d, j) in links.items() if c == d and (j - i) % 4 == 1]
        if not loops:
            return links
        _delete(links, loops[0])


def _improved(links: Links, rng: np.random.Generator) -> Links:
    """Lay one strand along a shorter way, or one as long if there is none."""
    choices = list(_strands(links))
    for saving in (1, 0):
        for k in rng.permutation(len(choices)).tolist():
            changed = _laid_anew(links, *choices[k], saving, rng)
            if changed is not None:
                return changed
    return links


def _strands(links: Links) -> Iterator[tuple[Slot, Slot, list[int]]]:
    """Longest strands that pass only over or only under: the ends before and after, and the crossings between."""
    for slot, (crossing, i) in links.items():
        if slot[1] % 2 != i % 2:  # the strand leaves the last crossing of the other kind
            between, at = [], (crossing, i)
            while at[1] % 2 == i % 2 and at[0] not in between:
                between.append(at[0])
                at = links[at[0], (at[1] + 2) % 4]
            if at[1] % 2 != i % 2:
                yield slot, at, between


def _laid_anew(
    links: Links, before: Slot, after: Slot, between: list[int], saving: int, rng: np.random.Generator
) -> Links | None:
    upper = links[before][1] % 2
    loose = dict(links)
    # The strand's own ends are joined into a ring, which vanishes with its crossings.
    _join(loose, loose[before], loose[after])
    _join(loose, before, _START)
    _join(loose, after, _END)
    for crossing in between:
        _delete(loose, crossing)
    if loose[_START] == _END:  # the rest of the knot met nothing but this strand
        return {}
    way = _shortest_way(loose, rng)
    if len(way) > len(between) - saving:
        return None
    end = loose.pop(_START)
    new = max(c for c, _ in links) + 1
    for slot in way:
        end = _crossed(loose, new, slot, end, upper)
        new += 1
    _join(loose, end, loose.pop(_END))
    return loose


def _crossed(links: Links, new: int, slot: Slot, end: Slot, upper: int) -> Slot:
    """Lead a strand across the edge at a slot, from its left to its right; give the strand's new end."""
    # Counterclockwise: the near end of the edge, right, its far end, left; the upper strand has odd numbers.
    near, right, far, left = ((new, (i + 1 - upper) % 4) for i in range(4))
    beyond = links[slot]
    _join(links, near, slot)
    _join(links, far, beyond)
    _join(links, left, end)
    return right


def _shortest_way(links: Links, rng: np.random.Generator) -> list[Slot]:
    """Edges to cross on a shortest way from the face of one loose end to that of the other, by breadth first."""
    face = _faces(links)
    borders: dict[int, list[Slot]] = {}
    for slot in links:
        borders.setdefault(face[slot], []).append(slot)
    came: dict[int, Slot | None] = {face[_START]: None}
    queue = deque(came)
    while face[_END] not in came:
        here = queue.popleft()
        slots = borders[here]
        for k in rng.permutation(len(slots)).tolist():
            beyond = face[links[slots[k]]]
            if beyond not in came:
                came[beyond] = slots[k]
                queue.append(beyond)
    way = []
    slot = came[face[_END]]
    while slot is not None:
        way.append(slot)
        slot = came[face[slot]]
    return way[::-1]


def _faces(links: Links) -> dict[Slot, int]:
    """The face to the left of every edge, seen from each of its ends."""
    face: dict[Slot, int] = {}
    for start in links:
        at = start
        while at not in face:
            face[at] = len(face) if at == start else face[start]
            crossing, i = links[at]
            at = (crossing, (i - 1) % 4) if crossing >= 0 else (crossing, i)
    return face
