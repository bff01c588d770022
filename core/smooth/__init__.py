"""Smooth closed curves in space as Fourier series: their Möbius energy, minimisers and how polygons lead there."""

from .fourier import FourierCurve
from .rest import Rest, at_rest

__all__ = ["FourierCurve", "Rest", "at_rest"]
