"""Smooth closed curves in space as Fourier series: their Möbius energy, its minimisers, and proofs about them."""
