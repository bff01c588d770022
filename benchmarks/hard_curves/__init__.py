"""Curves that are each hard in their own way, for benchmarks and tests."""

from .contacts import rope, spiral
from .lattices import lattice_closure
from .polygons import bent_trefoil, chain_of_rings, graded_trefoil, uneven
from .unknots import hard_unknot, lattice_knot, lattice_unknot, unknot_word

__all__ = [
    "bent_trefoil",
    "chain_of_rings",
    "graded_trefoil",
    "hard_unknot",
    "lattice_closure",
    "lattice_knot",
    "lattice_unknot",
    "rope",
    "spiral",
    "uneven",
    "unknot_word",
]
