"""Smooth closed curves in space as Fourier series: their Möbius energy, and its minimisers."""
