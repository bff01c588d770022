"""Curves that several tests need."""

import numpy as np
from hard_curves import chain_of_rings as chain_of_rings
from hard_curves import graded_trefoil as graded_trefoil
from hard_curves import lattice_knot as lattice_knot
from mobius_flow.core import Curve, Mesh


def regular_polygon(n: int, dimension: int = 3) -> Curve:
    t = 2 * np.pi * np.arange(n) / n
    vertices = np.zeros((n, dimension))
    vertices[:, 0], vertices[:, 1] = np.cos(t), np.sin(t)
    return Curve(vertices)


def opened(curve: Curve, *components: int) -> Curve:
    """The same vertices without the last edge of some components."""
    closed = [k not in components for k in range(len(curve.mesh.component_sizes))]
    return Curve(curve.vertices, Mesh(curve.mesh.component_sizes, tuple(closed)))


def half_circle(edges: int, dimension: int = 3) -> Curve:
    vertices = np.zeros((edges + 1, dimension))
    t = np.pi * np.arange(edges + 1) / edges
    vertices[:, 0], vertices[:, 1] = np.cos(t), np.sin(t)
    return Curve(vertices, Mesh((edges + 1,), (False,)))


def straight_arc(edges: int) -> Curve:
    vertices = np.linspace(0.0, 1.0, edges + 1)[:, None] * np.array([1.0, 2.0, -2.0])
    return Curve(vertices, Mesh((edges + 1,), (False,)))


def torus_trefoil(n: int) -> Curve:
    t = 2 * np.pi * np.arange(n) / n
    radius = 2 + np.cos(3 * t)
    return Curve(np.stack([radius * np.cos(2 * t), radius * np.sin(2 * t), np.sin(3 * t)], axis=1))


def hopf_link(n: int) -> Curve:
    t = 2 * np.pi * np.arange(n) / n
    zero = np.zeros(n)
    first = np.stack([np.cos(t), np.sin(t), zero], axis=1)
    second = np.stack([1 + np.cos(t), zero, np.sin(t)], axis=1)
    return Curve.from_components([first, second])


def scattered_rings(count: int, size: int, spread: float = 10.0, dimension: int = 3) -> Curve:
    """Small polygons anywhere in a cube, in no spatial order."""
    centres = np.random.default_rng(17).uniform(0, spread, (count, 1, dimension))
    return Curve.from_components(list(centres + regular_polygon(size, dimension).vertices))


def crossing(gap: float, n: int = 20) -> Curve:
    """Two crossing strands of one curve, nearer to each other than their edges are long."""
    t = 2 * np.pi * (np.arange(n) + 0.3) / n
    return Curve(np.stack([np.sin(t), np.sin(2 * t), 0.5 * gap * np.cos(t)], axis=1))
