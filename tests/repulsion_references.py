"""Slow, independent references for the repulsion of obstacles, and shapes to try it on."""

from itertools import pairwise

import mpmath as mp
import numpy as np
from energy_references import minus
from mobius_flow.core import Curve
from mobius_flow.core.curve.obstacle import Obstacle
from mobius_flow.core.energies.repulsion import Repulsion
from scipy.integrate import dblquad, quad

Vector = list[mp.mpf]


def potential_by_quadrature(corners: np.ndarray, x: np.ndarray) -> float:
    """∫ dA/|x − y|³ over a triangle, 2 ∫ ds/|x − y|² over a segment, by adaptive quadrature; x must not be near."""
    a, sides = corners[0], corners[1:] - corners[0]
    if len(sides) == 1:
        length = np.linalg.norm(sides)
        return 2 * length * quad(lambda t: 1 / np.sum((a + t * sides[0] - x) ** 2), 0, 1, epsabs=0, epsrel=1e-12)[0]
    density = np.linalg.norm(np.cross(*sides))
    integral = dblquad(
        lambda v, u: np.linalg.norm(a + u * sides[0] + v * sides[1] - x) ** -3.0, 0, 1, 0, lambda u: 1 - u, epsrel=1e-11
    )
    return float(density * integral[0])


def solid_angle_potential(corners: np.ndarray, x: Vector) -> mp.mpf:
    """Ω/h by the angles between the planes through x and the triangle's sides (Girard), with as many digits as set."""
    seen = [[mp.mpf(float(c)) - xi for c, xi in zip(corner, x, strict=True)] for corner in corners]
    normals = [_unit(_cross(seen[i], seen[(i + 1) % 3])) for i in range(3)]
    excess = mp.fsum(mp.acos(-mp.fdot(normals[i], normals[i - 1])) for i in range(3)) - mp.pi
    a, b, c = ([mp.mpf(float(component)) for component in corner] for corner in corners)
    normal = _unit(_cross(minus(b, a), minus(c, a)))
    return excess / abs(mp.fdot(normal, seen[0]))


def edge_integral(corners: np.ndarray, start: np.ndarray, end: np.ndarray, breaks: list[float]) -> float:
    """∫ Ω/h ds along an edge, refined geometrically towards parameters where it is nearly singular."""
    with mp.workdps(50):
        x0 = [mp.mpf(float(c)) for c in start]
        e = [mp.mpf(float(c)) - x for c, x in zip(end, x0, strict=True)]
        cuts = {mp.mpf(0), mp.mpf(1), *(mp.mpf(b) for b in breaks)}
        cuts |= {mp.mpf(b) + sign * mp.mpf(5) ** -k for b in breaks for k in range(14) for sign in (-1, 1)}
        points, weights = np.polynomial.legendre.leggauss(20)
        total = mp.mpf(0)
        for low, high in pairwise(sorted(cut for cut in cuts if 0 <= cut <= 1)):
            for u, weight in zip(points.tolist(), weights.tolist(), strict=True):
                t = (low + high) / 2 + (high - low) / 2 * u
                x = [a + t * b for a, b in zip(x0, e, strict=True)]
                total += (high - low) / 2 * weight * solid_angle_potential(corners, x)
        return float(total * mp.sqrt(mp.fdot(e, e)))


def repulsion(obstacle: Obstacle, theta: float = 0.0) -> Repulsion:
    """Of one obstacle; by default simplex by simplex."""
    (only,) = Repulsion.of([obstacle])
    return Repulsion(only.clusters, theta)


def sphere(subdivisions: int, radius: float = 1.0) -> Obstacle:
    """An octahedron, subdivided and blown up."""
    corners = np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=float)
    faces = [[i, (i + 1) % 4, 4] for i in range(4)] + [[(i + 1) % 4, i, 5] for i in range(4)]
    triangles = corners[np.array(faces)]
    for _ in range(subdivisions):
        triangles = quartered(triangles)
        triangles /= np.linalg.norm(triangles, axis=2, keepdims=True)
    return soup(radius * triangles)


def quartered(triangles: np.ndarray) -> np.ndarray:
    """Each triangle cut into four by its sides' midpoints; shape (f, 3, 3)."""
    middles = 0.5 * (triangles + np.roll(triangles, -1, axis=1))
    corners = [np.stack([triangles[:, i], middles[:, i], middles[:, i - 1]], axis=1) for i in range(3)]
    return np.concatenate([*corners, middles])


def soup(corners: np.ndarray) -> Obstacle:
    """An obstacle of simplices that share no vertices, from their corners, shape (f, 3, 3) or (f, 2, 3)."""
    return Obstacle(corners.reshape(-1, 3), np.arange(corners.shape[0] * corners.shape[1]).reshape(corners.shape[:2]))


def wavy(n: int, radius: float = 0.7) -> Curve:
    """A closed curve of n vertices within a ball of the radius."""
    t = 2 * np.pi * np.arange(n) / n
    points = np.stack([np.cos(2 * t) * (2 + np.cos(3 * t)), np.sin(2 * t) * (2 + np.cos(3 * t)), np.sin(3 * t)], axis=1)
    return Curve(radius / 3.2 * points)


def _cross(a: Vector, b: Vector) -> Vector:
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def _unit(a: Vector) -> Vector:
    length = mp.sqrt(mp.fdot(a, a))
    return [p / length for p in a]
