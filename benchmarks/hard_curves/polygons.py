"""Polygons whose edges differ in length, and a long chain."""

import numpy as np
from mobius_flow.core import Curve
from mobius_flow.core.knots import torus_knot

_BEND = 0.3  # the knot is 3 wide and its edges still differ by less than EVEN_RATIO, so that they are to be made equal


def bent_trefoil(vertices: int) -> Curve:
    """A torus knot T(2, 3) after three shears of space, which preserve its type."""
    x, y, z = torus_knot(2, 3, vertices).vertices.T
    x = x + _BEND * np.sin(2.0 * z + 1.0)
    z = z + _BEND * np.sin(2.0 * y)
    y = y + _BEND * np.sin(2.0 * x)
    return Curve(np.stack([x, y, z], axis=1))


def uneven(curve: Curve, ratio: float, seed: int) -> Curve:
    """The same polygon with vertices added on its edges so that edge lengths differ by ``ratio``."""
    rng = np.random.default_rng(seed)
    pieces = []
    for vertex, edge in zip(curve.vertices, curve.edge_vectors, strict=True):
        cuts = np.array([0.0]) if rng.random() > 0.1 else np.array([0.0, 1.0 / ratio])
        pieces.append(vertex + cuts[:, None] * edge)
    return Curve(np.concatenate(pieces))


def graded_trefoil(n: int, ratio: float) -> Curve:
    """The trefoil with edges ``ratio`` times shorter at three places than halfway between them."""
    density = np.sqrt(ratio) ** np.cos(6 * np.pi * np.arange(n) / n)
    t = 2 * np.pi * np.cumsum(density) / density.sum()
    radius = 2 + np.cos(3 * t)
    return Curve(np.stack([radius * np.cos(2 * t), radius * np.sin(2 * t), np.sin(3 * t)], axis=1))


def chain_of_rings(count: int, sizes: tuple[int, ...]) -> Curve:
    """Round rings, each linked with the next, with the given numbers of vertices in turn."""
    rings = []
    for k in range(count):
        t = 2 * np.pi * np.arange(sizes[k % len(sizes)]) / sizes[k % len(sizes)]
        ring = np.stack([np.cos(t), np.sin(t), np.zeros(len(t))], axis=1)
        rings.append((ring if k % 2 else ring[:, [0, 2, 1]]) + np.array([1.3 * k, 0.0, 0.0]))
    return Curve.from_components(rings)
