"""The edge energy of Kusner and Sullivan: one point per edge, at its middle (Section 6.1.1 of [RS21])."""

from ..quadrature import MIDPOINT
from .arc_density import ArcDensity
from .kpoint import KPointEnergy

EDGE_ENERGY = KPointEnergy(
    name="edge",
    description="edge energy of Kusner and Sullivan: 1/r² − 1/ϱ² at the edges' midpoints",
    density=ArcDensity(),
    rule=MIDPOINT,
)
