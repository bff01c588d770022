"""Tighten: knots and links as the shortest ropes of their thickness."""

from .tighten import Strut, Tightened, TightenOptions, tighten, tightening

__all__ = ["Strut", "TightenOptions", "Tightened", "tighten", "tightening"]
