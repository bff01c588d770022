"""Unlinked parts of a link would drift apart for ever: once they are far enough apart each is held in place."""

import numpy as np

from .constraints import Parts
from .curve import Curve
from .types import FloatArray, IntArray

APART = 1.0  # gap between the balls around two parts, in radii of the larger one
MOST_PARTS = 50  # each has rows of its own in the linear systems


def separate_parts(curve: Curve) -> Parts:
    """For each component the number of its part, from 0; parts lie in balls that are far from each other.

    Disjoint balls prove that parts are not linked.  All is one part if there would be very many.
    """
    components = len(curve.mesh.component_sizes)
    part = np.arange(components)
    while True:
        centers, radii = _balls(curve, part)
        near = _near(centers, radii)
        if near is None:
            break
        first, second = near
        part[part == second] = first
        part = np.unique(part, return_inverse=True)[1]
    if part.max() >= MOST_PARTS:
        return (0,) * components
    return tuple(part.tolist())


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


def _near(centers: FloatArray, radii: FloatArray) -> tuple[int, int] | None:
    """Two parts whose balls are not far enough apart, the first the lower number."""
    distance = np.linalg.norm(centers[:, None] - centers[None, :], axis=2)
    wanted = radii[:, None] + radii[None, :] + APART * np.maximum(radii[:, None], radii[None, :])
    pairs = np.argwhere(np.triu(distance < wanted, 1))
    return None if not len(pairs) else (int(pairs[0, 0]), int(pairs[0, 1]))
