"""All knots to ten crossings and links to seven, composite ones among them, by their polynomials."""

import re
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from itertools import product

from ..diagrams import Diagram, Laurent, normalized_bracket
from ..diagrams.polynomials import times
from .braids import braid_diagram
from .names import braid_word
from .table import AMPHICHEIRAL, KNOTS

Key = tuple[tuple[int, int], ...]  # a polynomial that can be looked up: exponents and coefficients

KNOTS_TO, LINKS_TO = 10, 7  # crossings up to which the table is complete
_NUMBER = re.compile(r"(?<![\d_an])\d+")  # of crossings, with which the name of a factor begins


def key(polynomial: Laurent) -> Key:
    """A polynomial as something to look up."""
    return tuple(sorted(polynomial.items()))


def bracket_key(diagram: Diagram) -> Key | None:
    """The bracket that is the same for all diagrams and orientations; None if the diagram is too wide."""
    found = normalized_bracket(diagram, diagram.own_writhe)
    return None if found is None else key(found)


def types_with(bracket: Key, crossings: int) -> list[str]:
    """Names of the types with a bracket and at most ``crossings`` crossings, those with few first."""
    return [name for name in _by_bracket().get(bracket, ()) if crossing_number(name) <= crossings]


@cache
def crossing_number(name: str) -> int:
    """Crossing number of a name; for connected sums, the sum over the factors."""
    return sum(int(number) for number in _NUMBER.findall(name))


@cache
def invariant_of(name: str, invariant: Callable[[Diagram], object]) -> object:
    """An invariant of the knot or link of a name."""
    return invariant(braid_diagram(braid_word(name)))


@cache
def _by_bracket() -> Mapping[Key, list[str]]:
    """Names of the types with each bracket, those with few crossings first."""
    found: defaultdict[Key, list[str]] = defaultdict(list)
    primes: list[tuple[str, Laurent]] = []
    for name, word in KNOTS.items():
        diagram = braid_diagram(word)
        bracket = normalized_bracket(diagram, diagram.own_writhe) or {}
        primes.append((name, bracket))
        if name not in AMPHICHEIRAL:
            primes.append((f"m{name}", {-power: c for power, c in bracket.items()}))
    every = [*primes, *_sums(primes)]
    for name, bracket in sorted(every, key=lambda each: (crossing_number(each[0]), "L" in each[0])):
        found[key(bracket)].append(name)
    return found


def _sums(primes: list[tuple[str, Laurent]]) -> Iterator[tuple[str, Laurent]]:
    """Brackets of all composite types: products of the factors' brackets."""
    primes = [each for each in primes if 0 < crossing_number(each[0]) <= KNOTS_TO - 2]
    shorter: list[tuple[str, Laurent, int]] = [(*each, k) for k, each in enumerate(primes)]
    while shorter:
        longer: list[tuple[str, Laurent, int]] = []
        for (name, bracket, last), (k, (factor, own)) in product(shorter, enumerate(primes)):
            joined = f"{name}#{factor}"
            if k >= last and crossing_number(joined) <= (LINKS_TO if "L" in joined else KNOTS_TO):
                longer.append((joined, times(bracket, own), k))
        yield from ((name, bracket) for name, bracket, _ in longer)
        shorter = longer
