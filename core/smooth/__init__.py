"""Smooth closed curves in space as Fourier series: their Möbius energy, its minimisers, and what is proved of them."""
