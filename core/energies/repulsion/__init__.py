"""The repulsive potential between a curve and obstacles at rest."""

from .repulsion import Repulsion
