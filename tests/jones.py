"""Jones polynomials of small diagrams, by Kauffman's bracket (Topology 26, 1987) contracted crossing by crossing."""

from spherogram import Link
from sympy import ZZ, ring

Laurent = dict[int, int]

_RING, _A, _B = ring("A,B", ZZ)  # B stands for 1/A
_LOOP = -(_A**2) - _B**2


def jones(link: Link) -> Laurent:
    """Jones polynomial as {twice the exponent of t: coefficient}; t + t³ − t⁴ for the right-handed trefoil."""
    rest = [list(crossing) for crossing in link.PD_code(min_strand_index=1)]
    if rest:
        rest[0][0] = 0  # cut open there: the arc that is left counts 1, and every loop −A² − A⁻²
    states = {frozenset(): _RING.one * _LOOP ** max(link.unlinked_unknot_components - (not rest), 0)}
    done: set[int] = set()
    while rest:
        rest.sort(key=lambda crossing: len(done & set(crossing)))
        crossing = rest.pop()
        done |= set(crossing)
        states = _smoothed(states, crossing)
    (bracket,) = states.values()
    writhe = link.writhe()
    found: Laurent = {}
    for (up, down), coefficient in bracket.terms():
        power = (3 * writhe + down - up) // 2  # of √t = A⁻²
        found[power] = found.get(power, 0) + (-1) ** (writhe % 2) * int(coefficient)
    return {power: coefficient for power, coefficient in sorted(found.items()) if coefficient}


def _smoothed(states: dict[frozenset, object], crossing: list[int]) -> dict[frozenset, object]:
    """Both smoothings of a crossing; a state pairs the open ends of arcs, and its value is a polynomial."""
    a, b, c, d = crossing
    new: dict[frozenset, object] = {}
    for weight, arcs in ((_A, ((a, b), (c, d))), (_B, ((a, d), (b, c)))):
        for state, polynomial in states.items():
            ends = dict(state)
            loops = sum(_closes_a_loop(ends, *arc) for arc in arcs)
            joined = frozenset(ends.items())
            new[joined] = new.get(joined, _RING.zero) + weight * polynomial * _LOOP**loops
    return new


def _closes_a_loop(ends: dict[int, int], a: int, b: int) -> bool:
    """Add an arc to open arcs, each listed by both of its ends; labels that are met twice are glued."""
    x = ends.pop(a, a)
    y = ends.pop(b, b)
    if x == b:
        return True
    ends[x], ends[y] = y, x
    return False
