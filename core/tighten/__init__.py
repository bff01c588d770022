"""Knots pulled tight: the shortest rope of a given thickness."""

from .tighten import tighten

__all__ = ["tighten"]
