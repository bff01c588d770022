"""What the complement of a knot proves, by other programs where they are installed (the extra "knots").

The fundamental group, by SnapPy, is infinite cyclic only for the unknot (Papakyriakopoulos 1957); the genus and
fiberedness are by knot Floer homology (Szabó's program; Ozsváth and Szabó 2004, Ni 2007).
"""

import re
from functools import cache
from typing import NamedTuple

from .diagrams import Diagram

CENSUS = "its complement, in SnapPy's census"
FLOER, GENUS, GROUP = "knot Floer homology", "its genus by knot Floer homology", "its group, which is infinite cyclic"


class KnotGroup(NamedTuple):
    """A presentation of the fundamental group: a capital letter is the inverse of a generator."""

    generators: tuple[str, ...]
    relators: tuple[str, ...]

    def __str__(self) -> str:
        return f"⟨{', '.join(self.generators)} | {', '.join(self.relators)}⟩"


class Floer(NamedTuple):
    """The results of knot Floer homology."""

    genus: int
    fibered: bool
    ranks: tuple[tuple[tuple[int, int], int], ...]  # by Alexander and Maslov gradings


@cache
def group(link: Diagram) -> KnotGroup | None:
    """The group of a link; None for large ones, for diagrams that fall apart, and where SnapPy is not installed."""
    if not 0 < link.crossings <= 150 or len(link.pieces()) > 1:
        return None
    try:
        from snappy import Link
        from snappy.SnapPy import set_rand_seed
    except ImportError:  # also where it is python-snappy that has the name
        return None
    set_rand_seed(0)  # which presentation is found depends on it
    exterior = Link(list(map(list, link.planar_code))).exterior(with_hyperbolic_structure=False)
    if exterior.num_tetrahedra() > 60:  # fewer take a second to simplify, many more hours
        return None
    found = exterior.fundamental_group()
    return KnotGroup(tuple(found.generators()), tuple(found.relators()))


@cache
def floer(knot: Diagram) -> Floer | None:
    """The homology of a knot; None for links, large diagrams, and where the library is not installed."""
    if not 0 < knot.crossings <= 60 or len(knot.passes) > 1:  # wide diagrams of more crossings take minutes
        return None
    try:
        from knot_floer_homology import pd_to_hfk
    except ImportError:
        return None
    found = pd_to_hfk(list(map(list, knot.planar_code)))
    return Floer(found["seifert_genus"], found["fibered"], tuple(sorted(found["ranks"].items())))


@cache
def names_by_census(knot: Diagram) -> tuple[str, ...]:
    """The knots of SnapPy's census, of up to 15 crossings, whose complement is this one's; empty without SnapPy.

    A complement belongs to one knot and its mirror image (Gordon and Luecke 1989).  Isometries tell them apart: they
    keep orientations or reverse them, and if there are both kinds, the two images are the same.
    """
    if not 0 < knot.crossings <= 150 or len(knot.passes) > 1:
        return ()
    try:
        from snappy import Link
    except ImportError:
        return ()
    exterior, names = Link(list(map(list, knot.planar_code))).exterior(), list[str]()
    if exterior.num_tetrahedra() > 60:
        return ()
    found = {name for each in exterior.identify() if re.fullmatch(r"K\d+[an]\d+", name := each.name())}
    for name in sorted(found):
        try:
            isometries = exterior.is_isometric_to(Link(name).exterior(), return_isometries=True)
            kept = {bool(m[0, 0] * m[1, 1] > m[0, 1] * m[1, 0]) for each in isometries for m in each.cusp_maps()}
            names.append(name if True in kept else f"m{name}")
        except RuntimeError:  # isometries are not found
            names += [name, f"m{name}"]
    return tuple(names)


def names_by_exterior(knot: Diagram) -> tuple[tuple[str, ...], str]:
    """The names of all knots that can have this complement, where theorems say so, and the evidence; empty otherwise.

    Only the unknot has an infinite cyclic group, and genus 0; only the trefoils and the figure-eight are fibered of
    genus 1.
    """
    if len(knot.passes) == 1 and group(knot) == KnotGroup(("a",), ()):
        return ("0_1",), GROUP
    found = floer(knot)
    if found is None or found.genus > 1 or (found.genus == 1 and not found.fibered):
        return (), ""
    return (("3_1", "m3_1", "4_1") if found.genus else ("0_1",)), GENUS
