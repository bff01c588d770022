"""How thick a tube may be drawn around a curve without running into anything; for pictures, proves nothing."""

from collections.abc import Sequence

import numpy as np

from ...core import Curve, Obstacle
from ...core.collision.clearance import clears
from ...core.curve import Mesh
from ...core.curve.distances import nearest_strands
from ...core.types import FloatArray
from .placement import Frame

_THICKEST = 0.016  # of a component's length: a round circle's tube is then a tenth of its radius
_DISTINCT = 3.0  # two points lie on different strands if they are this many times further apart along the curve
_AIR = 0.94  # of half the gap, so that strands do not seem to touch
_THINNEST = 3e-3  # of a curve's size: a thinner tube is not seen in a film, nor is which strand is in front
_GROWTH = 0.04  # of the thickest radius, per frame


def thickest_radius(curve: Curve) -> float:
    """Radius that looks right where there is room enough."""
    return _THICKEST * curve.length / len(curve.mesh.component_sizes)


def free_radius(curve: Curve, thickest: float) -> float:
    """Half the gap between strands of a curve, at most ``thickest``."""
    return min(thickest, 0.5 * _AIR * strand_gap(curve, 2 * thickest / _AIR))


def radius_beside(curve: Curve, radius: float, obstacles: Sequence[Obstacle]) -> float:
    """A radius, or as much less, to 2 %, as obstacles leave room for; at least a thousandth of it."""
    if clears(curve, obstacles, radius / _AIR):
        return radius
    low, high = 1e-3 * radius, radius
    while high > 1.02 * low:
        middle = float(np.sqrt(low * high))
        low, high = (middle, high) if clears(curve, obstacles, middle / _AIR) else (low, middle)
    return low


def strand_gap(curve: Curve, widest: float) -> float:
    """Least distance between strands of a curve, inf if it is more than ``widest``."""
    spacing = float(curve.edge_lengths.max())
    nearest = nearest_strands(curve, _DISTINCT, widest + spacing)
    # Edges are nearer than their ends: by no more than this when the ends of the nearest two lie side by side.
    return float(np.sqrt(max(nearest**2 - 0.25 * spacing**2, 0.25 * nearest**2)))


def animated_radii(mesh: Mesh, points: Sequence[Frame], frames: FloatArray) -> FloatArray:
    """Radii of the tube at keyed curves, (keys,): free at each unless too thin to see, and changing gently."""
    curves = [Curve(p.astype(np.float64), mesh) for p in points]
    thickest = np.array(list(map(thickest_radius, curves)))
    radii = np.array(list(map(free_radius, curves, thickest)))
    for order in (slice(None), slice(None, None, -1)):
        view, steps = radii[order], np.abs(np.diff(frames[order])) * _GROWTH * thickest[order][1:]
        for k, step in enumerate(steps):
            view[k + 1] = min(view[k + 1], view[k] + step)
    return np.maximum(radii, [_THINNEST * np.ptp(p, axis=0).max() for p in points])
