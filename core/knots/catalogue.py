"""All knots to ten crossings and links to seven, composite ones among them, by their polynomials."""

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from functools import cache
from itertools import product

import numpy as np

from ..diagrams import Diagram, Laurent, alexander, doubled_bracket, knot_signature, normalized_bracket
from .braid_diagrams import braid_diagram
from .names import braid_word
from .table import AMPHICHEIRAL, KNOTS

Key = tuple[tuple[int, int], ...]  # a polynomial that can be looked up: exponents and coefficients

KNOTS_TO, LINKS_TO = 10, 7  # crossings up to which no type is missing
_NUMBER = re.compile(r"(?<![\d_an])\d+")  # of crossings, with which the name of a factor begins
_SEVERAL = 2  # least number of factors of a sum


def key(polynomial: Laurent) -> Key:
    """A polynomial as something to look up."""
    return tuple(sorted(polynomial.items()))


def bracket_key(diagram: Diagram) -> Key | None:
    """The bracket that is the same for all diagrams and orientations; None if the diagram is too wide."""
    found = normalized_bracket(diagram, diagram.own_writhe)
    return None if found is None else key(found)


def types_with(bracket: Key, crossings: int) -> list[str]:
    """Names of the types with a bracket, of no more crossings; those of few crossings first."""
    return [name for name in _by_bracket().get(bracket, ()) if crossing_number(name) <= crossings]


@cache
def crossing_number(name: str) -> int:
    """Crossing number of a name, for sums the sum of those of the factors."""
    return sum(int(number) for number in _NUMBER.findall(name))


@cache
def alexander_of(name: str) -> tuple[int, ...] | None:
    """Alexander polynomial of a knot's name; that of a sum is the product."""
    found = np.ones(1, dtype=np.int64)
    for factor in name.split("#"):
        found = np.convolve(found, alexander(braid_diagram(braid_word(factor))) or ())
    return tuple(found.tolist())


@cache
def signature_of(name: str) -> int:
    """Signature of a knot's name."""
    return knot_signature(braid_diagram(braid_word(name)))


@cache
def linking_of(name: str) -> list[int]:
    """Linking numbers of a link's name without their signs, which orientations decide; sorted."""
    return sorted(map(abs, braid_diagram(braid_word(name)).linking_numbers))


@cache
def doubled_of(name: str) -> Key:
    """The bracket of the doubled knot of a name."""
    found = doubled_bracket(braid_diagram(braid_word(name)))
    return () if found is None else key(found)


@cache
def _by_bracket() -> Mapping[Key, list[str]]:
    """Names of the types with each bracket, those of few crossings first."""
    found: defaultdict[Key, list[str]] = defaultdict(list)
    every = [*_primes(), *_sums()]
    for name, bracket in sorted(every, key=lambda each: (crossing_number(each[0]), _is_link(each[0]))):
        found[key(bracket)].append(name)
    return found


@cache
def _primes() -> list[tuple[str, Laurent]]:
    """Brackets of all prime types, mirror images among them."""
    found = []
    for name, word in KNOTS.items():
        diagram = braid_diagram(word)
        bracket = normalized_bracket(diagram, diagram.own_writhe) or {}
        found.append((name, bracket))
        if name not in AMPHICHEIRAL:
            found.append((f"m{name}", {-power: c for power, c in bracket.items()}))
    return found


def _sums() -> Iterator[tuple[str, Laurent]]:
    """Brackets of all composite types: those of the factors multiplied."""
    primes = [each for each in _primes() if 0 < crossing_number(each[0]) <= KNOTS_TO - 2]
    shorter: list[tuple[str, Laurent, int, int]] = [("", {0: 1}, 0, -1)]
    for count in range(1, KNOTS_TO // 2 + 1):
        longer = []
        for (name, bracket, total, last), (k, (factor, own)) in product(shorter, enumerate(primes)):
            joined = f"{name}#{factor}" if name else factor
            if k >= last and total + crossing_number(factor) <= (LINKS_TO if _is_link(joined) else KNOTS_TO):
                longer.append((joined, _times(bracket, own), total + crossing_number(factor), k))
        if count >= _SEVERAL:
            yield from ((name, bracket) for name, bracket, _, _ in longer)
        shorter = longer


def _is_link(name: str) -> bool:
    return "L" in name


def _times(a: Laurent, b: Laurent) -> Laurent:
    found: dict[int, int] = {}
    for (i, x), (j, y) in product(a.items(), b.items()):
        found[i + j] = found.get(i + j, 0) + x * y
    return {power: c for power, c in found.items() if c}
