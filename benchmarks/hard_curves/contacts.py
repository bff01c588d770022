"""Unknots with long strands side by side: rolled up into a spiral, or twisted into a rope."""

import math

import numpy as np
from mobius_flow.core import Curve
from mobius_flow.core.base.types import FloatArray


def spiral(turns: float, vertices: int | None = None, *, rise: float = 0.0) -> Curve:
    """Make an unknot rolled up into a double spiral: two strands side by side, joined in the middle and outside.

    Parameters
    ----------
    turns
        How often each strand goes round; the radius is 1, so strands are 1 / (2 ``turns`` + 1) apart.
    vertices
        Number of vertices; by default so many that edges are shorter than strands are apart.
    rise
        Height of the rim over the middle: 0 keeps the curve in the plane z = 0, else it lies on a paraboloid.

    Raises
    ------
    ValueError
        If the vertices are too few for strands to stay apart.
    """
    smooth = _lifted(_double_spiral(turns), rise)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(smooth, axis=0), axis=1))])
    gap = 1 / (2 * turns + 1)
    # An edge of length h leaves a curve of curvature κ by at most κh²/8; here κ is at most 2π/gap, in the
    # middle, and strands can't meet while that is below gap/2.
    fewest = math.ceil(along[-1] / (0.75 * gap))
    vertices = max(60, math.ceil(along[-1] / (0.6 * gap))) if vertices is None else vertices
    if vertices < fewest:
        raise ValueError(f"vertices is {vertices}; a spiral of {turns} turns takes {fewest}")
    marks = np.linspace(0.0, along[-1], vertices + 1)[:-1]
    flat = np.stack([np.interp(marks, along, coordinate) for coordinate in smooth[:, :2].T], axis=1)
    return Curve(_lifted(flat, rise))


def _lifted(points: FloatArray, rise: float) -> FloatArray:
    """Put points of the plane, shape (k, 2), on the paraboloid; shape (k, 3)."""
    return np.column_stack([points, rise * (points * points).sum(axis=1)])


def _double_spiral(turns: float) -> FloatArray:
    """Points, dense and closed, of two Archimedean spirals r = aθ opposite each other and the cap that joins them."""
    end = 2 * math.pi * turns
    a = 1 / (end + math.pi)
    # Equal steps of θ² are about equal steps of length.
    theta = np.sqrt(np.linspace(0.0, (end + math.pi) ** 2, math.ceil(64 * (turns + 1)) * 8))
    outwards = a * theta * np.exp(1j * theta)
    inner = np.append(theta[theta < end], end)[::-1]
    inwards = -a * inner * np.exp(1j * inner)
    middle, radius = (outwards[-1] + inwards[0]) / 2, (outwards[-1] - inwards[0]) / 2
    cap = middle + radius * np.exp(1j * np.linspace(0.0, math.pi, 64))
    points = np.concatenate([outwards, cap[1:-1], inwards])
    return np.stack([points.real, points.imag], axis=1)


def rope(twists: float, gap: float, vertices: int = 200) -> Curve:
    """Make an unknot twisted into a rope of length 2: two strands at a distance that may be far below an edge.

    Parameters
    ----------
    twists
        How often the strands turn around each other, negative for the left-handed rope.
    gap
        Distance of the two strands, above 0.
    vertices
        Number of vertices, even.

    Raises
    ------
    ValueError
        If the vertices are odd, or fewer than 8 per twist.
    """
    steps = (vertices - 4) // 2
    # Cross-sections of the two strands are opposite each other, so they can't meet while an edge turns
    # by less than half a turn; a quarter leaves them a good part of the gap.
    if vertices % 2 or abs(twists) > steps / 4:
        raise ValueError(f"vertices is {vertices}; a rope of {twists} twists takes an even number, 8 per twist")
    x = np.linspace(-1.0, 1.0, steps + 1)
    angle = math.pi * twists * x
    strand = np.stack([x, gap / 2 * np.cos(angle), gap / 2 * np.sin(angle)], axis=1)
    tip = 1.0 + 2.0 / steps
    back = (strand * [1, -1, -1])[::-1]
    return Curve(np.concatenate([strand, [[tip, 0, 0]], back, [[-tip, 0, 0]]]))
