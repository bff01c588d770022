"""Clusters of edges: the tree of a curve, and balls around its clusters."""

import numpy as np

from ..clusters import ClusterTree
from ..curve import Curve, Mesh
from ..curve.ordering import component_order
from ..types import FloatArray, IntArray


def edge_clusters(curve: Curve, leaf: int) -> ClusterTree:
    """The tree of a curve's edges whose leaves have at most ``leaf`` of them; leaf ≥ 1.

    The order follows the curve, one component after the other; only their succession is changed where there are three
    or more, so that neighbours in space come next to each other.  A cluster is a part of one component, or several
    whole ones: however many small components there are, the tree of n edges has O(n) clusters and O(log n) levels.
    """
    order = component_order(curve.mesh, curve.vertices.T)
    ends = _component_ends(curve.mesh, order)
    return ClusterTree.halved(order, leaf, lambda start, stop: _middle(start, stop, ends))


def balls(tree: ClusterTree, curve: Curve) -> tuple[FloatArray, FloatArray]:
    """Centres, shape (clusters, m), and radii, shape (clusters,), of balls around the clusters' bounding boxes."""
    ends = curve.vertices[curve.mesh.tails[tree.order]], curve.vertices[curve.mesh.heads[tree.order]]
    low = tree.reduced(np.minimum, np.minimum(*ends))
    high = tree.reduced(np.maximum, np.maximum(*ends))
    diagonal = high - low
    return 0.5 * (low + high), 0.5 * np.sqrt(np.einsum("ij,ij->i", diagonal, diagonal))


def _component_ends(mesh: Mesh, order: IntArray) -> IntArray:
    """Positions at which components end."""
    return np.append(np.flatnonzero(np.diff(mesh.edge_component[order])) + 1, mesh.edges)


def _middle(start: IntArray, stop: IntArray, ends: IntArray) -> IntArray:
    """Where to cut ranges: between two components if they hold more than one, else in the middle."""
    middle = (start + stop) // 2
    after = np.searchsorted(ends, middle)
    before = ends[np.maximum(after - 1, 0)]
    nearer = (ends[after] >= stop) | (2 * middle < before + ends[after])
    cut = np.where((before > start) & nearer, before, ends[after])
    return np.where((cut > start) & (cut < stop), cut, middle)
