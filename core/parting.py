"""Unlinked parts of a link would drift apart for ever: once they are far enough apart each is held in place."""

import numpy as np
from scipy.sparse.csgraph import connected_components

from .constraints import Parts
from .curve import Curve
from .types import BoolArray, FloatArray, IntArray

APART = 1.0  # gap between the balls around two parts, in radii of the larger one
MOST_PARTS = 50  # each has rows of its own in the linear systems


def separate_parts(curve: Curve) -> Parts:
    """For each component the number of its part, from 0; parts lie in balls that are far from each other.

    Disjoint balls prove that parts are not linked.  All is one part if there would be very many.
    """
    components = len(curve.mesh.component_sizes)
    part, count = np.arange(components), components
    while count > 1:
        fewer, merged = connected_components(_near(*_balls(curve, part)), directed=False)
        if fewer == count:
            break
        part, count = merged[part], fewer
    return tuple(part.tolist()) if count <= MOST_PARTS else (0,) * components


def split(curve: Curve, parts: Parts) -> list[Curve]:
    """The parts as curves of their own."""
    components = curve.components
    return [
        Curve.from_components([c for c, part in zip(components, parts, strict=True) if part == k])
        for k in range(max(parts) + 1)
    ]


def _balls(curve: Curve, part: IntArray) -> tuple[FloatArray, FloatArray]:
    """Centres, shape (p, m), and radii, shape (p,), of balls around the parts."""
    of_vertex = part[curve.mesh.component]
    centers, radii = [], []
    for k in range(part.max() + 1):
        own = curve.vertices[of_vertex == k]
        centers.append(0.5 * (own.min(axis=0) + own.max(axis=0)))
        radii.append(np.linalg.norm(own - centers[-1], axis=1).max())
    return np.array(centers), np.array(radii)


def _near(centers: FloatArray, radii: FloatArray) -> BoolArray:
    """Which balls are not far enough from each other to be parts; shape (p, p)."""
    distance = np.linalg.norm(centers[:, None] - centers[None, :], axis=2)
    return np.asarray(distance < radii[:, None] + radii[None, :] + APART * np.maximum(radii[:, None], radii[None, :]))
