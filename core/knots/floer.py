"""Knot Floer homology, by knot_floer_homology (Szabó), where it is installed: the extra "knots"."""

from functools import cache
from typing import NamedTuple

from ..diagrams import Diagram

_CROSSINGS = 150  # of diagrams; wide ones of more take long


class Floer(NamedTuple):
    """What it says: the genus and fiberedness are the knot's own (Ozsváth and Szabó 2004, Ni 2007)."""

    genus: int
    fibered: bool
    ranks: tuple[tuple[tuple[int, int], int], ...]  # by Alexander and Maslov gradings


def floer(knot: Diagram) -> Floer | None:
    """The homology of a knot; None for links, large diagrams, and where the library is not installed."""
    if len(knot.passes) != 1 or not 0 < knot.crossings <= _CROSSINGS:
        return None
    return _computed(tuple(tuple(edges) for edges in knot.planar_code))


@cache
def _computed(code: tuple[tuple[int, ...], ...]) -> Floer | None:
    try:
        from knot_floer_homology import pd_to_hfk
    except ImportError:
        return None
    found = pd_to_hfk([list(edges) for edges in code])
    return Floer(found["seifert_genus"], found["fibered"], tuple(sorted(found["ranks"].items())))


def of_least_genus(found: Floer) -> tuple[str, ...]:
    """The names of all knots with this homology, where theorems say so; empty otherwise.

    Only the unknot has genus 0, and only the trefoils and the figure-eight are fibered of genus 1.
    """
    if found.genus == 0:
        return ("0_1",)
    return ("3_1", "m3_1", "4_1") if found.genus == 1 and found.fibered else ()
