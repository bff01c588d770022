"""Knot type of a closed polygon, for tests: Alexander polynomial, genus, fibredness and τ by knot Floer homology.

Genus 0 means the unknot; τ tells mirror images apart. Messy polygons are simplified first, so hundreds of
vertices and crossings are fine as long as the knot is small.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from knot_diagrams import Diagram, Points, diagram, jones, linking_number
from knot_moves import simplified

__all__ = [
    "UNKNOT",
    "KnotInvariants",
    "jones",
    "knot_invariants",
    "linking_number",
    "pairwise_linking",
    "shortened",
    "small_diagram",
]

_FEW = 20  # crossings that need no simplification
_MANY = 150  # crossings from which on it pays to shorten the polygon first


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
    from knot_floer_homology import pd_to_hfk  # a compiled package that only this function needs

    found = small_diagram([points])
    if len(found.signs) < 3:
        return UNKNOT
    homology = pd_to_hfk([list(crossing) for crossing in found.pd_code()])
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


def small_diagram(components: Sequence[npt.ArrayLike]) -> Diagram:
    """Give a diagram with few crossings: of the polygons as they are if they are simple, else of simpler ones."""
    found = diagram(components, projections=2)
    if len(found.signs) > _MANY or (len(found.signs) > _FEW and len(components) > 1):
        found = diagram(shortened(components))
    return simplified(found, _FEW) if len(components) == 1 else found


def pairwise_linking(components: Sequence[npt.ArrayLike]) -> dict[tuple[int, int], int]:
    """Linking numbers of all pairs of components of a link."""
    pairs = [(i, j) for j in range(len(components)) for i in range(j)]
    return {(i, j): linking_number(components[i], components[j]) for i, j in pairs}


def shortened(components: Sequence[npt.ArrayLike]) -> list[Points]:
    """Remove vertices as long as the triangle with the two neighbours is free of other edges, with a margin.

    This keeps the type (Koniaris & Muthukumar, Phys. Rev. Lett. 66, 1991; Taylor, Nature 406, 2000).
    """
    polygons = [np.asarray(c, dtype=np.float64) for c in components]
    changed = True
    while changed:
        changed = False
        for k, polygon in enumerate(polygons):
            i = 0
            while i < len(polygon) and len(polygon) > 3:
                if _free(polygons, k, i):
                    polygon = polygons[k] = np.delete(polygon, i, axis=0)
                    changed = True
                else:
                    i += 1
    return polygons


def _free(polygons: Sequence[Points], k: int, i: int) -> bool:
    """Whether vertex i of polygon k can be pulled straight: no other edge meets its triangle."""
    n = len(polygons[k])
    before, after = (i - 1) % n, (i + 1) % n
    triangle = polygons[k][[before, i, after]]
    low, high = triangle.min(axis=0), triangle.max(axis=0)
    slack = 1e-9 * (high - low).max()
    for m, polygon in enumerate(polygons):
        tails, heads = polygon, np.concatenate([polygon[1:], polygon[:1]])
        keep = ((np.minimum(tails, heads) <= high + slack) & (np.maximum(tails, heads) >= low - slack)).all(axis=1)
        if m == k:
            keep[[before, i]] = False
            # The edges that start at the triangle's corners touch it only there, unless they lie in its plane.
            keep[[(before - 1) % n, after]] = False
            if not (
                _leaves_plane(triangle, polygon[(before - 1) % n]) and _leaves_plane(triangle, polygon[(after + 1) % n])
            ):
                return False
        if keep.any() and _meets(triangle, tails[keep], heads[keep]).any():
            return False
    return True


def _leaves_plane(triangle: Points, point: Points) -> bool:
    a, b, c = triangle
    size = np.abs(triangle - a).max() + np.abs(point - a).max()
    volume = np.dot(np.cross(b - a, c - a), point - a)
    return bool(abs(volume) > 1e-13 * size**3) or bool(np.linalg.norm(np.cross(b - a, c - a)) < 1e-12 * size**2)


def _meets(triangle: Points, tails: Points, heads: Points) -> npt.NDArray[np.bool_]:
    """Which segments (k, 3) meet the triangle, or come so near that rounding might decide."""
    a, b, c = triangle
    size = np.ptp(np.concatenate([triangle, tails, heads]), axis=0).max()
    slack = 1e-13 * size**3
    normal = np.cross(b - a, c - a)
    below, above = (tails - a) @ normal, (heads - a) @ normal
    apart = ((below > slack) & (above > slack)) | ((below < -slack) & (above < -slack))
    d = heads - tails
    sides = [np.einsum("ij,ij->i", d, np.cross(p - tails, q - tails)) for p, q in ((a, b), (b, c), (c, a))]
    outside = np.logical_or.reduce([s > slack for s in sides]) & np.logical_or.reduce([s < -slack for s in sides])
    return ~(apart | outside)
