"""Numbers at the vertices of a link that are worth showing as colours."""

from collections.abc import Callable

import numpy as np
from scipy.spatial.distance import cdist

from ...core import Curve
from ...core.curve.distances import STRAND_RATIO, TINY, arc_distance_of_vertices
from ...core.energies.moebius import moebius_by_length
from ...core.types import FloatArray, IntArray
from .colours import of_components, ramp

COMPONENT, DISTANCE, ENERGY = "component", "strand_distance", "energy_density"  # as attributes are called
_BLOCK = 2_000_000  # pairs looked at together

# by which number vertices are coloured, and how: bright is what is near, and what has much energy
COLOURINGS: dict[str, Callable[[FloatArray], FloatArray]] = {
    COMPONENT: of_components,
    DISTANCE: lambda distances: ramp(-distances),
    ENERGY: ramp,
}


def vertex_values(link: Curve) -> dict[str, FloatArray]:
    """All of them, by their names, (n,) each.

    The number of the component, counted from 0; the distance to the nearest other strand, in the link's units; and the
    Möbius energy per length, in 1/unit.
    """
    density = moebius_by_length(link)
    return {
        COMPONENT: link.mesh.component.astype(np.float64),
        DISTANCE: strand_distances(link),
        ENERGY: 0.5 * (density[link.mesh.outgoing] + density[link.mesh.incoming]),
    }


def strand_distances(curve: Curve) -> FloatArray:
    """Distance from each vertex to the nearest other strand, shape (n,); in the curve's units.

    A strand passes where the distance is least among the neighbours there, as in `core.curve.refine`; the curve round a
    mere bend is none.  Where nothing passes the distance is the curve's longest one, and where nothing passes anywhere
    its diameter.
    """
    rows = max(1, _BLOCK // len(curve))
    blocks = np.split(np.arange(len(curve)), np.arange(rows, len(curve), rows))
    distances = np.concatenate([_distances(curve, block) for block in blocks])
    passing = distances[np.isfinite(distances)]
    furthest = passing.max() if passing.size else np.linalg.norm(np.ptp(curve.vertices, axis=0))
    return np.asarray(np.minimum(distances, furthest))


def _distances(curve: Curve, rows: IntArray) -> FloatArray:
    """The same for some vertices, inf where nothing passes."""
    mesh = curve.mesh
    r = cdist(curve.vertices[rows], curve.vertices)
    passing = (r <= r[:, mesh.heads[mesh.outgoing]]) & (r <= r[:, mesh.tails[mesh.incoming]])
    passing &= arc_distance_of_vertices(curve, rows[:, None], np.arange(len(curve))) > STRAND_RATIO * r
    r[~passing] = np.inf
    nearest = r.argmin(axis=1)
    found = np.isfinite(r.min(axis=1))
    sides = [_to_edges(curve, rows, edges) for edges in (mesh.outgoing[nearest], mesh.incoming[nearest])]
    return np.where(found, np.minimum(*sides), np.inf)


def _to_edges(curve: Curve, vertices: IntArray, edges: IntArray) -> FloatArray:
    """Distances from vertices to edges, elementwise: those to vertices would show the mesh in the colours."""
    e, chord = curve.edge_vectors[edges], curve.vertices[vertices] - curve.vertices[curve.mesh.tails[edges]]
    t = (np.einsum("km,km->k", chord, e) / np.maximum(curve.edge_lengths[edges] ** 2, TINY)).clip(0.0, 1.0)
    return np.asarray(np.linalg.norm(chord - t[:, None] * e, axis=1))
