"""Proved lower bounds on the least Möbius energies of knots and links (docs/bounds.md)."""

import math

from ...core.base.arguments import checked
from ...core.knots.braids import braid_diagram
from ...core.knots.knot_type import crossing_number
from ...core.knots.names import braid_word, table_name


@checked
def lower_bound(name: str) -> float:
    """A lower bound on the energies of all curves of a type in the table, rounded down.

    For knots with c crossings 4 + 2πc (M. Freedman, Z.-X. He and Z. Wang, *Möbius energy of knots and unknots*, Annals
    of Mathematics 139, 1994); for links 4 for each component, and 4π² for each two that are linked (I. Agol,
    F. C. Marques and A. Neves, *Min-max theory and the energy of links*, Journal of the AMS 29, 2016).  Raises
    UnknownKnotError.

    >>> lower_bound("0_1"), round(lower_bound("hopf link"), 6)
    (4.0, 47.478418)
    """
    entry, _ = table_name(name)
    diagram = braid_diagram(braid_word(entry))
    components, linking = len(diagram.passes), diagram.linking_numbers
    linked = 1 if components == 2 else sum(number != 0 for number in linking)  # no sphere separates two of the table
    more = 2.0 * math.pi * crossing_number(entry) if components == 1 else 4.0 * math.pi**2 * linked
    return 4.0 * components + (1.0 - 1e-15) * more  # rounded down
