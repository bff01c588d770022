"""An elastic rope that lies on a table: what it does by itself, and where springs lead it.

Its energy is that of its tension, of its bending, of its weight, z², a barrier at its diameter, and a repulsion *in the
plane* between strands that do not cross near there, which keeps its diagram and opens the faces of that.  A step goes
to the minimum of a convex quadratic model and, as far as that is proved, there.  The width of a face is the unit of
length, the tension that of forces.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

from ..base.deadline import check_time
from ..base.types import BoolArray, FloatArray, IntArray
from ..collision import free_motion, rope_motion
from ..curve import Curve, Mesh
from ..curve.obstacle import Obstacle
from ..energies.edge_pairs import EdgePairs
from ..energies.rope import closest
from ..knots.diagrams.projection import plane_crossings


class ViewCount(NamedTuple):
    """How many crossings there are in the view, after how many strand moves."""

    crossings: int
    moves: int


@dataclass(frozen=True, eq=False)
class Stage:
    """Motions on one mesh; they start where the previous stage ends, except for vertices on straight edges."""

    start: Curve  # where they begin, in the user's units
    path: tuple[FloatArray, ...] = ()  # the vertices at the end of each leg, (n, 3); empty where only the mesh changes
    seen: ViewCount | None = None  # at the end

    @property
    def end(self) -> Curve:
        """The curve reached."""
        return self.start.with_vertices(self.path[-1]) if self.path else self.start


@dataclass(frozen=True, eq=False)
class Springs:
    """From some vertices, shape (k,), to places, shape (k, 3), with stiffness by direction, shape (k, 3, 3)."""

    vertices: IntArray
    places: FloatArray
    stiffness: FloatArray
    landed: bool  # whether these vertices lie on the table, like all others


class ElasticRope:
    """A curve's vertices in the user's doubles, bit for bit those that are proved, and as seen in a frame.

    ``radius`` are those of its components that are proved, if it is a rope; ``thick`` is the one that it has by itself,
    as thick as there is room for.  Vertices ``held`` stay where they are.
    """

    def __init__(
        self, curve: Curve, frame: FloatArray, held: BoolArray, obstacles: Sequence[Obstacle], radius: FloatArray | None
    ) -> None:
        self.mesh, self.frame, self.held, self.obstacles, self.radius = curve.mesh, frame, held, obstacles, radius
        self.length, self.free = curve.length, not held.any() and not obstacles
        self.vertices, self._start = curve.vertices, curve
        self.path: list[FloatArray] = []  # the vertices after each step so far
        places = curve.vertices[held] if held.any() else curve.vertices
        self.origin = places.mean(axis=0)
        self.seen = (self.vertices - self.origin) @ frame
        self.thick, self.face, self.speed, self.pull = 0.0, 1.0, 0.0, 0.0
        inner = self.mesh.inner
        rows = np.tile(np.arange(len(inner)), 3)
        columns = np.concatenate([inner, self.mesh.anticycle[inner], self.mesh.cycle[inner]])
        entries = np.repeat([-2.0, 1.0, 1.0], len(inner))
        second = sp.coo_array((entries, (rows, columns)), shape=(len(inner), self.mesh.size)).tocsr()
        self._bends = (second.T @ second).tocsr()
        self._bends_by_coordinate = sp.kron(self._bends, sp.eye_array(3), format="csc")

    @property
    def curve(self) -> Curve:
        return Curve(self.vertices, self.mesh)

    def take(self, crossings: int, moves: int) -> Stage:
        """The motions that have not been taken yet; what is seen at their end comes with them."""
        stage = Stage(self._start, tuple(self.path), ViewCount(crossings, moves))
        self.path, self._start = [], self.curve
        return stage

    def mark(self) -> tuple[FloatArray, FloatArray, FloatArray, float, int]:
        return self.vertices, self.seen, self.frame, self.thick, len(self.path)

    def rewind(self, mark: tuple[FloatArray, FloatArray, FloatArray, float, int]) -> None:
        self.vertices, self.seen, self.frame, self.thick, count = mark
        del self.path[count:]

    def arc(self, position: FloatArray, around: FloatArray, i: IntArray, j: IntArray, component: IntArray) -> FloatArray:
        """Distances along the curve; infinite between components."""
        ahead = np.abs(position[i] - position[j])
        distance = np.minimum(ahead, around[component[i]] - ahead)
        return np.where(component[i] == component[j], distance, np.inf)

    def step(self, springs: Springs | None = None, cap: float = 0.35) -> bool:
        """Go one step, in which no vertex moves by more than a part ``cap`` of a face; return whether any is free."""
        check_time()
        mesh, x, face, n, r = self.mesh, self.seen, self.face, self.mesh.size, self.thick
        tails, heads, eye = mesh.tails, mesh.heads, np.eye(3)
        edge = mesh.changes(x)
        ell = np.linalg.norm(edge, axis=1)
        along = edge / ell[:, None]
        around = np.add.reduceat(ell, mesh.edge_offsets[:-1])
        mean = (around / mesh.edge_counts)[mesh.edge_component]
        ring = np.where(mesh.closed, around, np.inf)
        unit = float(ell.mean()) / face**2
        force, form = np.zeros_like(x), np.zeros((n, 3, 3))  # the derivative, and blocks of its model's on the diagonal
        blocks: list[tuple[IntArray, IntArray, FloatArray]] = []

        # tension towards the length that so many crossings need, and edges of equal lengths
        crossings = plane_crossings(mesh, x).edges
        if springs is None:  # what is not led is to stay where ways have been planned
            need = face * max(8.0, 1.8 * crossings.shape[1])
            self.pull = 0.06 * float(np.clip((ell.sum() / need - 1.0) / 0.15, -0.2, 1.0))
        goal = (1.0 - self.pull) * mean
        pulls = ((ell - goal) / (0.06 * mean))[:, None] * along
        force += mesh.scatter(-pulls, pulls)
        both = along[:, :, None] * along[:, None, :]
        stiff = (both + np.maximum(0.0, 1.0 - goal / ell)[:, None, None] * (eye - both)) / (0.06 * mean)[:, None, None]
        blocks += [(tails, tails, stiff), (heads, heads, stiff), (tails, heads, -stiff), (heads, tails, -stiff)]
        bending = (0.35 * face) ** 2 / float(ell.mean()) ** 3
        force += bending * (self._bends @ x)

        # weight, and drag
        lying = np.ones(n, dtype=bool)
        if springs is not None and not springs.landed:
            lying[springs.vertices] = False
        force[:, 2] += 1.5 * unit * lying * x[:, 2]
        form[:, 2, 2] += 1.5 * unit * lying
        drag = unit * np.where(lying, 1.0 if springs is None else 3.0 if springs.landed else 20.0, 1.0)
        tangent = both[mesh.outgoing]
        form += drag[:, None, None] * (eye - tangent) + 0.1 * unit * tangent

        # repulsion in the plane
        i, j = cKDTree(x[:, :2]).query_pairs(face, output_type="ndarray").T
        position = np.zeros(n)
        position[heads] = np.cumsum(ell)
        position[mesh.offsets[:-1]] = np.concatenate([[0.0], np.cumsum(around)[:-1]])
        far = self.arc(position, ring, i, j, mesh.component) > 1.6 * face
        i, j = (each[far & lying[i] & lying[j]] for each in (i, j))
        reach = int(0.5 * face / float(ell.mean()))
        near = self._neighbours(crossings, np.arange(-reach - 1, reach + 3))
        crossed = np.sort(near[0][:, :, None] * n + near[1][:, None, :], axis=None)
        crossed = np.concatenate([crossed, np.sort(near[1][:, :, None] * n + near[0][:, None, :], axis=None)])
        apart = ~np.isin(i * n + j, crossed)
        i, j = i[apart], j[apart]
        v = x[i] - x[j]
        v[:, 2] = 0.0
        d = np.linalg.norm(v, axis=1) + 1e-12 * face
        q = v / d[:, None]
        first, second = _barrier(np.maximum(d / face, 0.04))
        push = (1.5 * unit * float(ell.mean()) * first)[:, None] * q
        shape = (3.0 * unit * float(ell.mean()) / face * second)[:, None, None] * q[:, :, None] * q[:, None, :]
        _add(force, i, push)
        _add(force, j, -push)
        _add(form, i, shape)
        _add(form, j, shape)

        # the barrier at its diameter
        e, f = cKDTree(x[tails] + 0.5 * edge).query_pairs(
            max(4.0 * r, 2.05 * r + 2.0 * cap * face) + ell.max(), output_type="ndarray"
        ).T
        middle = position[tails] + 0.5 * ell
        far = self.arc(middle, ring, e, f, mesh.edge_component) > 1.5 * np.pi * r + 0.5 * (ell[e] + ell[f])
        e, f = e[far], f[far]
        chord, s, t = closest(EdgePairs.of(mesh, x, e, f))
        d = np.linalg.norm(chord, axis=1)
        close = d < 4.0 * r
        i, j, s, t, d, chord = e[close], f[close], s[close], t[close], d[close], chord[close]
        first, second = _barrier(np.maximum(0.5 * d / max(r, 1e-300) - 1.0, 1e-3))
        weight, q = 0.2 * ell[i] * ell[j] / max(r, 1e-300), chord / d[:, None]
        first, second = weight * first / (2.0 * r), weight * second / (2.0 * r) ** 2
        square = q[:, :, None] * q[:, None, :]
        corners = (tails[i], 0.5 - s), (heads[i], 0.5 + s), (tails[j], t - 0.5), (heads[j], -0.5 - t)
        for a, by_a in corners:
            _add(force, a, (first * by_a)[:, None] * q)
            blocks += [(a, b, (second * by_a * by_b)[:, None, None] * square) for b, by_b in corners]

        if springs is not None:
            k = springs.vertices
            force[k] += unit * np.einsum("kij,kj->ki", springs.stiffness, x[k] - springs.places)
            form[k] += unit * springs.stiffness
        force[self.held] = 0.0
        form[self.held] += 1e9 * unit * eye
        blocks.append((np.arange(n), np.arange(n), form))
        a, b, values = (np.concatenate(each) for each in zip(*blocks, strict=True))
        rows, columns = np.broadcast_arrays(3 * a[:, None, None] + np.arange(3)[:, None], 3 * b[:, None, None] + np.arange(3))
        matrix = sp.coo_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=(3 * n, 3 * n)).tocsc()
        symmetric = {"SymmetricMode": True}
        factors = splu(
            matrix + bending * self._bends_by_coordinate,
            permc_spec="MMD_AT_PLUS_A", options=symmetric, diag_pivot_thresh=0.0,
        )
        move = -factors.solve(force.ravel()).reshape(-1, 3)
        move[self.held] = 0.0
        self.speed = float(np.linalg.norm(move, axis=1).max())
        move *= min(1.0, cap * face / self.speed)

        # as far as that is proved, and strands keep apart
        gap = lambda y: float(np.linalg.norm(closest(EdgePairs.of(mesh, y, e, f))[0], axis=1).min(initial=np.inf))
        floor = min(2.05 * r, 0.97 * gap(x))
        for _ in range(12):
            if gap(x + move) > floor and self.go(x + move):
                return True
            move *= 0.6
        return False

    def go(self, seen: FloatArray) -> bool:
        """Go straight to places in the frame, shape (n, 3), if that is proved; unless something holds the curve, it is
        scaled to keep its length."""
        end = seen
        if self.free:
            edges = np.linalg.norm(self.mesh.changes(seen), axis=1).sum()
            end = self.length / edges * (seen - seen.mean(axis=0) * [1.0, 1.0, 0.0])
        end = end @ self.frame.T + self.origin
        end[self.held] = self.vertices[self.held]
        if not self.proves(end):
            return False
        self.vertices, self.seen = end, seen
        self.path.append(end)
        return True

    def proves(self, end: FloatArray) -> bool:
        """Whether the straight way to vertices, shape (n, 3), is proved free, and that of a rope if it is one."""
        if self.radius is None:
            return free_motion(self.mesh, self.vertices, end, self.obstacles, exhaustive=False).proved
        return rope_motion(self.mesh, self.vertices, end, self.radius, self.obstacles).proved

    def thicken(self, most: float) -> None:
        """Make the rope by itself as thick as there is room for."""
        here = Curve(self.seen, self.mesh)
        ell = here.edge_lengths
        e, f = cKDTree(here.midpoints).query_pairs(3.0 * most + ell.max(), output_type="ndarray").T
        around = np.add.reduceat(ell, self.mesh.edge_offsets[:-1])
        ring = np.where(self.mesh.closed, around, np.inf)
        middle = np.cumsum(ell) - 0.5 * ell
        far = self.arc(middle, ring, e, f, self.mesh.edge_component) > 1.5 * np.pi * most + 0.5 * (ell[e] + ell[f])
        chord, _, _ = closest(EdgePairs.of(self.mesh, self.seen, e[far], f[far]))
        room = 0.45 * float(np.linalg.norm(chord, axis=1).min(initial=np.inf))
        self.thick = max(self.thick, min(most, room, 1.15 * self.thick or np.inf))

    def _neighbours(self, edges: IntArray, offsets: IntArray) -> list[IntArray]:
        """For edges, the vertices at some offsets from their tails along the curve; each (k, offsets)."""
        tails = self.mesh.tails[edges]
        start = self.mesh.offsets[self.mesh.component[tails]][:, :, None]
        size = np.array(self.mesh.component_sizes)[self.mesh.component[tails]][:, :, None]
        return list(start + (tails[:, :, None] - start + offsets) % size)


def _add(total: FloatArray, index: IntArray, values: FloatArray) -> None:
    """Add values, shape (k, …), to the entries at an index, which may be there several times."""
    width = total[0].size
    places = (index[:, None] * width + np.arange(width)).ravel()
    total += np.bincount(places, values.ravel(), total.size).reshape(total.shape)


def _barrier(z: FloatArray) -> tuple[FloatArray, FloatArray]:
    """First and second derivative of −(1 − z)² log z; 0 from z = 1 on."""
    z = np.minimum(z, 1.0)
    y = 1.0 - z
    return 2.0 * y * np.log(z) - y**2 / z, -2.0 * np.log(z) + 4.0 * y / z + y**2 / z**2
