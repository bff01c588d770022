"""The first embedded curve: centre lines that meet are led apart, and who went over whom is told."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import spsolve
from scipy.spatial import cKDTree

from ..base import COMPONENT, BoolArray, CurveError, FloatArray, Message
from ..collision.gap import near_edges, scaled_points, written
from ..curve import Curve, Obstacle, arc_distance_of_pairs, at_vertices
from ..energies.edge_pairs import CORNERS, EdgePairs
from ..energies.rope import closest
from .clearances import clearances

MEETS = 1e-3  # centre lines meet that are nearer to each other than that part of the smallest radius
AXES = {f"{sign}{name}": float(f"{sign}1") * np.eye(3)[k] for sign in ("", "-") for k, name in enumerate("xyz")}


@dataclass(frozen=True)
class Crossing:
    """Centre lines that met: the components, from 0, that went over and under, and where."""

    over: int
    under: int
    place: tuple[float, float, float]

    @property
    def sentence(self) -> Message:
        over, under = (Message(COMPONENT, number=each + 1) for each in (self.over, self.under))
        place = written(np.array(self.place))
        if over == under:
            return Message("{over} went over itself near {place}", over=over, place=place)
        return Message("{over} went over {under} near {place}", over=over, under=under, place=place)


def lead_apart(
    curve: Curve,
    radius: FloatArray,
    stiffness: sp.csr_array,
    held: BoolArray,
    taut: BoolArray,
    over: str | None = None,
    obstacles: Sequence[Obstacle] = (),
) -> tuple[FloatArray, list[Crossing]]:
    """Vertices, shape (n, 3), at which no centre lines meet, and the crossings that had no side to stay on.

    Two that meet part along their common normal, or where they are parallel along the direction ``over``.  Those that
    are apart, however little, stay on their sides; of others the later one goes over, as seen from that direction: an
    axis such as z or -x, by default the one in which the curve extends least where it meets itself.  The displacement
    is the smoothest one by the quadratic form of ``stiffness``, (n, n), times a factor so small that nothing else is
    met.  A CurveError names strands that are ``held``, (n,), where they meet, perhaps because they are ``taut``, (n,).
    """
    mesh, p = curve.mesh, curve.vertices
    scale = min(float(radius.min()), float(curve.edge_lengths.max()))
    meets = MEETS * scale
    pinned = np.flatnonzero(held)
    for k, other in pinned[cKDTree(p[pinned]).query_pairs(meets, output_type="ndarray")][:1]:
        parts = [Message(COMPONENT, number=int(mesh.component[each]) + 1) for each in (k, other)]
        both = "{one} and {other} are both held at {place}; move one of them, or let go of it"
        if taut[[k, other]].any():
            both = "{one} and {other} are both held at {place} by the lengths that are kept; leave these free"
        message = Message(both, one=parts[0], other=parts[1], place=written(p[k]))
        raise CurveError(message, at_vertices(curve, int(k), int(other)))
    none = np.zeros(0, dtype=np.intp)
    points, unit = scaled_points(curve)
    found = [(i, j) for i, j, _ in near_edges(curve, points, lambda: float(np.ldexp(meets, -unit)) ** 2)]
    i, j = np.sort([np.concatenate(each) for each in zip((none, none), *found, strict=True)], axis=0)
    far = arc_distance_of_pairs(curve, i, j, 0.5) - 0.5 * (curve.edge_lengths[i] + curve.edge_lengths[j]) > meets
    i, j = i[far], j[far]
    if not len(i) or held.all():
        return p, []
    # edges in a row that meet others are one pass; later ones are higher, so that three through a point agree
    edges = np.unique([i, j])
    on = edges[np.isin(mesh.next[edges], edges)]
    row = sp.coo_array((np.ones(len(on)), (on, mesh.next[on])), shape=(mesh.edges, mesh.edges))
    passes = connected_components(row, directed=False)[1]  # numbered in the order of their first edges
    height = np.searchsorted(np.unique(passes[edges]), passes).astype(float)
    i, j = np.where(height[i] <= height[j], (i, j), (j, i))
    chord, s, t = closest(EdgePairs.of(mesh, p, i, j))
    distance, tau = np.linalg.norm(chord, axis=1)[:, None], curve.edge_vectors / curve.edge_lengths[:, None]
    rounding = 1e-12 * np.abs(p).max()
    met = distance[:, 0] <= rounding
    tangents = tau[np.concatenate([i, j])]
    least = np.linalg.eigh(tangents.T @ tangents)[1][:, 0]
    up = AXES[over] if over else least * np.sign(least[np.abs(least).argmax()])
    normal = np.cross(tau[i], tau[j])
    sine = np.linalg.norm(normal, axis=1)[:, None]
    normal = np.where(sine < 1e-3, up, normal / np.maximum(sine, 1e-3))
    normal *= np.where(normal @ up < 0.0, -1.0, 1.0)[:, None]
    normal = np.where(met[:, None], normal, chord / np.where(met[:, None], 1.0, distance))
    goal = np.where(met, height[i] - height[j], 1.0)
    shares = np.stack([np.ones_like(s), s, -t], axis=1) @ CORNERS.T
    ends = np.stack([mesh.tails[i], mesh.heads[i], mesh.tails[j], mesh.heads[j]], axis=1)
    k = len(i)
    rows, columns = np.broadcast_arrays(np.arange(k)[:, None, None], 3 * ends[:, :, None] + np.arange(3))
    values = shares[:, :, None] * normal[:, None]
    A = sp.csr_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=(k, p.size))[:, np.repeat(~held, 3)]
    K = sp.kron(stiffness[~held][:, ~held], sp.eye_array(3))
    firm = 1e6 * float(stiffness.diagonal().max())
    u = np.zeros_like(p)
    u[~held] = spsolve((K + firm * A.T @ A).tocsc(), firm * A.T @ goal).reshape(-1, 3)
    others = clearances(curve, radius, curve.edge_lengths, 0.1, obstacles)
    apart = others.value * np.where(others.edges[:, 1] < 0, 1.0, 2.0) * float(radius.min())
    room = float(apart[apart > meets].min(initial=0.1 * scale))
    places = np.einsum("kc,kcm->km", shares[:, :2], p[ends[:, :2]])[met]
    _, first, number = np.unique(passes[i][met] * mesh.edges + passes[j][met], return_index=True, return_inverse=True)
    lower, upper = (mesh.edge_component[each[met][first]].tolist() for each in (i, j))
    middles = np.array([places[number == k].mean(axis=0) for k in range(len(first))]).reshape(-1, 3)
    middles = np.where(np.abs(middles) <= rounding, 0.0, middles)
    crossings = [Crossing(*each) for each in zip(upper, lower, map(tuple, middles.tolist()), strict=True)]
    furthest = max(float(np.linalg.norm(u, axis=1).max()), 1e-300)
    return p + 0.4 * room / furthest * u, crossings
