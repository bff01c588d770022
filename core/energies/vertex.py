"""The vertex energy of Kusner and Sullivan: one point per edge, at its tail (Section 6.1.1 of [RS21])."""

from ..quadrature import TAIL
from .arc_density import ArcDensity
from .kpoint import KPointEnergy

VERTEX_ENERGY = KPointEnergy(
    name="vertex",
    description="vertex energy of Kusner and Sullivan: 1/r² − 1/ϱ² at the edges' tails",
    density=ArcDensity(),
    rule=TAIL,
)
