"""The repulsive potential between a curve and still obstacles."""

from .repulsion import Repulsion
