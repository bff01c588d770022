"""Checks of polygons by brute force, for tests."""

from fractions import Fraction

import numpy as np
from mobius_flow.core.curve import Curve

Vector = tuple[Fraction, Fraction, Fraction]


def strand_distance(curve: Curve, apart: int = 4) -> float:
    """Least distance of points more than ``apart`` edges from each other, from 5 points on each edge."""
    steps = 5
    tails, edges = curve.vertices, curve.edge_vectors
    points = np.concatenate([tails + k / steps * edges for k in range(steps)])
    index = np.tile(np.arange(len(curve)), steps)
    distances = np.linalg.norm(points[:, None] - points[None], axis=2)
    along = curve.mesh.index_distance(index[:, None], index[None])
    return float(distances[along > apart].min())


def exact(point: np.ndarray) -> Vector:
    """The rational point that three doubles stand for."""
    x, y, z = (Fraction(float(c)) for c in point)
    return x, y, z


def exactly_pierced(triangle: tuple[Vector, Vector, Vector], p: Vector, q: Vector) -> bool:
    """Whether the segment pq meets a triangle, in rational arithmetic; False if all lie in one plane."""
    a, b, c = triangle
    below, above = _volume(a, b, c, p), _volume(a, b, c, q)
    if below * above > 0 or below == above == 0:
        return False
    sides = [_volume(p, q, a, b), _volume(p, q, b, c), _volume(p, q, c, a)]
    return min(sides) >= 0 or max(sides) <= 0


def _volume(a: Vector, b: Vector, c: Vector, d: Vector) -> Fraction:
    """Six times the signed volume of a tetrahedron."""
    (x1, y1, z1), (x2, y2, z2), (x3, y3, z3) = (tuple(p - q for p, q in zip(e, a, strict=True)) for e in (b, c, d))
    return x1 * (y2 * z3 - y3 * z2) - y1 * (x2 * z3 - x3 * z2) + z1 * (x2 * y3 - x3 * y2)
