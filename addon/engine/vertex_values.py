"""Numbers at the vertices of a link that are worth showing as colours."""

from collections.abc import Callable

import numpy as np

from ...core import Curve
from ...core.energies.moebius import moebius_by_length
from ...core.types import FloatArray
from .colours import of_components, ramp
from .strands import strand_distances

COMPONENT, DISTANCE, ENERGY = "component", "strand_distance", "energy_density"  # as attributes are called

# by which number vertices are coloured, and how: bright is what is near, and what has much energy
COLOURINGS: dict[str, Callable[[FloatArray], FloatArray]] = {
    COMPONENT: of_components,
    DISTANCE: lambda distances: ramp(-distances),
    ENERGY: ramp,
}


def vertex_values(link: Curve) -> dict[str, FloatArray]:
    """All of them, by their names, (n,) each.

    The number of the component, counted from 0; the distance to the nearest other strand, in the link's units; and the
    Möbius energy per length, in 1/unit.
    """
    density = moebius_by_length(link)
    return {
        COMPONENT: link.mesh.component.astype(np.float64),
        DISTANCE: strand_distances(link),
        ENERGY: 0.5 * (density[link.mesh.outgoing] + density[link.mesh.incoming]),
    }
