"""Knot type of a closed polygon, for tests: Alexander polynomial, genus, fibredness and τ by knot Floer homology.

Genus 0 means the unknot; τ tells mirror images apart. Diagrams are simplified first, so hundreds of crossings are fine
as long as the knot is small.
"""

from dataclasses import dataclass

import numpy.typing as npt
from knot_diagrams import simplified


@dataclass(frozen=True)
class KnotInvariants:
    """Invariants of a knot.

    ``alexander`` is symmetric with value 1 at t = 1, from its lowest coefficient to its highest; ``tau`` is 1
    for the right-handed trefoil; ``rank`` is the total rank of knot Floer homology.
    """

    genus: int
    alexander: tuple[int, ...]
    tau: int
    fibered: bool
    rank: int


UNKNOT = KnotInvariants(0, (1,), 0, True, 1)


def knot_invariants(points: npt.ArrayLike) -> KnotInvariants:
    """Compute the invariants of a closed polygon, shape (n, 3), that doesn't touch itself."""
    link = simplified([points])
    if not link.crossings:
        return UNKNOT
    homology = link.knot_floer_homology()
    euler: dict[int, int] = {}
    for (alexander, maslov), rank in homology["ranks"].items():
        euler[alexander] = euler.get(alexander, 0) + (-1) ** (maslov % 2) * rank
    top = max(a for a, c in euler.items() if c)
    return KnotInvariants(
        genus=homology["seifert_genus"],
        alexander=tuple(euler.get(a, 0) for a in range(-top, top + 1)),
        tau=homology["tau"],
        fibered=homology["fibered"],
        rank=homology["total_rank"],
    )
