"""The hard-curve bench: knots, links and unknots from the project's own generators, relaxed and identified."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType

import numpy as np

from .curve import Curve
from .driver import Iterate, RelaxOptions, Result, Status, minimize
from .knots import (
    HARD_UNKNOTS,
    braid_word,
    hard_unknot,
    knot,
    lattice_closure,
    rope,
    scramble,
    spiral,
    torus_knot,
    unknot_word,
)
from .knots import KNOTS as TABLE
from .knots.alexander import signature


@dataclass(frozen=True, eq=False)
class Row:
    """What became of one curve: its result, and whether its signature is the same before and after."""

    name: str
    vertices_given: int
    result: Result
    same_type: bool
    trivial: bool


def uneven(curve: Curve, ratio: float, seed: int) -> Curve:
    """The same polygon with vertices added on its edges so that edge lengths differ by ``ratio``."""
    rng = np.random.default_rng(seed)
    pieces = []
    for vertex, edge in zip(curve.vertices, curve.edge_vectors, strict=True):
        cuts = np.array([0.0]) if rng.random() > 0.1 else np.array([0.0, 1.0 / ratio])
        pieces.append(vertex + cuts[:, None] * edge)
    return Curve(np.concatenate(pieces))


def lattice(name: str) -> Curve:
    """A knot or link of the table as a coarse polygon on the cubic lattice."""
    return lattice_closure(braid_word(name))


def lattice_unknot(crossings: int) -> Curve:
    """A hard unknot as a coarse polygon on the cubic lattice."""
    return lattice_closure(unknot_word(crossings, seed=crossings))


Curves = Mapping[str, Callable[[], Curve]]

KNOTS: Curves = MappingProxyType(
    {
        **{f"unknot-{c}": partial(hard_unknot, c, seed=c) for c in (20, 60, 100, 141)},
        **{f"unknot-lattice-{c}": partial(lattice_unknot, c) for c in (20, 40, 60, 80, 100, 120, 141)},
        **{
            f"unknot-{name}": partial(knot, name) for name in HARD_UNKNOTS if name != "haken"
        },  # whose 141 crossings it takes more vertices to untangle
        "unknot-scrambled": lambda: scramble(knot("0_1"), seed=11),
        "unknot-spiral": lambda: spiral(6.0),
        "unknot-rope": lambda: rope(6.0, 0.02),
        "unknot-edges-1000": lambda: uneven(hard_unknot(20, seed=3), 1000.0, seed=5),
        **{name: partial(lattice, name) for name in ("3_1", "6_2", "7_7", "8_19", "9_35", "10_132")},
        "4_1-scrambled": lambda: scramble(knot("4_1"), seed=7),
        "torus-3-5": lambda: torus_knot(3, 5),
        **{name: partial(lattice, name) for name in ("L2a1", "L5a1", "L6a4")},
    }
)
"""Curves that are hard each in its own way."""

PRIMES: Curves = MappingProxyType({name: partial(lattice, name) for name in TABLE if name != "0_1"})
"""Every prime knot to ten crossings and the links of the table, as coarse lattice polygons."""

SETS: Mapping[str, Curves] = MappingProxyType({"knots": KNOTS, "primes": PRIMES})


def bench(curves: Curves, options: RelaxOptions, callback: Callable[[Iterate], None] | None = None) -> Iterator[Row]:
    """Relax curves one by one; a keyboard interrupt ends the bench, not only the curve at hand."""
    for name, make in curves.items():
        curve = make()
        before = signature(curve)
        result = minimize(curve, options, callback)
        if result.status is Status.INTERRUPTED:
            raise KeyboardInterrupt
        after = signature(result.curve)
        yield Row(name, len(curve), result, before == after, after.is_trivial)
