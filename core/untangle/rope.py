"""An elastic rope that lies on a table: what it does by itself, and where springs lead it.

Its energy is that of its tension, of its bending, of its weight, z², a barrier at its diameter, and a repulsion *in the
plane* between strands that do not cross near there, which keeps its diagram and opens the faces of that.  A step goes
to the minimum of a convex quadratic model, as far as that is proved.  Lengths are measured by the width of a face, and
forces by the largest tension.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ..base.deadline import check_time
from ..base.types import BoolArray, FloatArray, IntArray
from ..collision import is_free, is_rope
from ..curve import Curve
from ..curve.distances import arc_distance_of_pairs, arc_distance_of_vertices
from ..curve.obstacle import Obstacle
from ..energies.edge_pairs import EdgePairs
from ..energies.rope import closest, phi
from ..knots.diagrams.projection import plane_crossings
from ..solve.symmetric import factorised

SHARP = 0.3  # cosine of the sharpest turn at a vertex, if there are no sharper ones


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


class _Model:
    """Forces on n vertices, less their springs, drags and stiffnesses: a quadratic function of displacements."""

    def __init__(self, n: int) -> None:
        self.force: FloatArray = np.zeros((n, 3))  # the derivative
        self.form: FloatArray = np.zeros((n, 3, 3))  # the second one, or what is as good: blocks on the diagonal
        self._blocks: list[tuple[IntArray, IntArray, FloatArray]] = []  # and elsewhere

    def couple(self, corners: Sequence[tuple[IntArray, FloatArray]], first: FloatArray, second: FloatArray) -> None:
        """Add a function of Σ c x over some vertices x, each a pair of indices and factors c, by its derivatives."""
        for a, by_a in corners:
            _add(self.force, a, by_a[:, None] * first)
            self._blocks += [(a, b, (by_a * by_b)[:, None, None] * second) for b, by_b in corners]

    def minimum(self) -> FloatArray:
        """The displacements of least energy, shape (n, 3)."""
        n, own = len(self.form), np.arange(len(self.form))
        a, b, blocks = map(np.concatenate, zip(*self._blocks, (own, own, self.form), strict=True))
        order = np.argsort(key := a * n + b, kind="stable")
        first = np.flatnonzero(np.diff(key[order], prepend=-1))
        rows, columns = np.divmod(key[order[first]], n)
        total = sp.csr_array((np.ones(len(order)), order, np.append(first, len(order))))  # of those with one place
        blocks = (total @ blocks.reshape(-1, 9)).reshape(-1, 3, 3)
        form = sp.bsr_array((blocks, columns, np.searchsorted(rows, np.arange(n + 1))), shape=(3 * n, 3 * n)).tocsr()
        # as it is symmetric, its rows are its columns
        form = sp.csc_array((form.data, form.indices, form.indptr), shape=form.shape)
        return -np.asarray(factorised(form).solve(self.force.ravel())).reshape(-1, 3)


class ElasticRope:
    """A curve's vertices in the user's doubles, bit for bit those that are proved, and as seen in a frame.

    ``radius`` are those of its components that are proved, if it is a rope; ``thick`` is the one that it has by itself,
    as thick as there is room for.  Vertices ``held`` stay where they are.
    """

    def __init__(
        self, curve: Curve, frame: FloatArray, held: BoolArray, obstacles: Sequence[Obstacle], radius: FloatArray | None
    ) -> None:
        self.mesh, self.frame, self.held, self.obstacles, self.radius = curve.mesh, frame, held, obstacles, radius
        self.vertices, self._start = curve.vertices, curve
        self.path: list[FloatArray] = []  # the vertices after each step so far
        self._length = curve.length if not held.any() and not obstacles else None  # that it keeps
        self._origin = (curve.vertices[held] if held.any() else curve.vertices).mean(axis=0)
        self.seen = (self.vertices - self._origin) @ frame
        self.thick, self.face, self.speed, self._pull = 0.0, 1.0, 0.0, 0.0

    @property
    def curve(self) -> Curve:
        """The curve as it is."""
        return Curve(self.vertices, self.mesh)

    def take(self, crossings: int, moves: int) -> Stage:
        """The motions that have not been taken yet; what is seen at their end comes with them."""
        stage = Stage(self._start, tuple(self.path), ViewCount(crossings, moves))
        self.path, self._start = [], self.curve
        return stage

    def mark(self) -> tuple[FloatArray, FloatArray, float, int]:
        """What `rewind` needs."""
        return self.vertices, self.seen, self.thick, len(self.path)

    def rewind(self, mark: tuple[FloatArray, FloatArray, float, int]) -> None:
        """Forget all motions since a mark."""
        self.vertices, self.seen, self.thick, count = mark
        del self.path[count:]

    def step(self, springs: Springs | None = None, cap: float = 0.35) -> bool:
        """Go one step, in which no vertex moves by more than a part ``cap`` of a face; return whether it is free."""
        check_time()
        here, mesh, face, r = Curve(self.seen, self.mesh), self.mesh, self.face, self.thick
        mean, model, x = float(here.edge_lengths.mean()), _Model(mesh.size), here.vertices
        cosine, inner = self._cosines(here), mesh.inner
        # bending, for which corners of more than 60 degrees are stiffer
        stiffness = (0.35 * face) ** 2 / mean**3 * (1.0 + 30.0 * np.maximum(0.5 - cosine, 0.0))
        before, after, one = mesh.anticycle[inner], mesh.cycle[inner], np.ones(len(inner))
        bend = stiffness[:, None] * (x[before] - 2.0 * x[inner] + x[after])
        model.couple(((before, one), (inner, -2.0 * one), (after, one)), bend, stiffness[:, None, None] * np.eye(3))
        lying = np.ones(mesh.size, dtype=bool)
        if springs is not None:
            k, scale = springs.vertices, mean / face**2
            lying[k] = springs.landed
            model.force[k] += scale * np.einsum("kij,kj->ki", springs.stiffness, x[k] - springs.places)
            model.form[k] += scale * springs.stiffness
        crossings = plane_crossings(mesh, x).edges
        self._add_tension(model, here, crossings.shape[1], lying, springs)
        self._add_repulsion(model, here, crossings, lying)
        e, f = self._strands(here, max(4.0 * r, 2.05 * r + 2.0 * cap * face), r)
        apart = self._add_barrier(model, here, e, f)
        model.force[self.held] = 0.0
        model.form[self.held] += 1e9 * mean / face**2 * np.eye(3)
        move = model.minimum()
        move[self.held] = 0.0
        self.speed = float(np.linalg.norm(move, axis=1).max())
        if self.speed == 0.0:
            return False
        move *= min(1.0, cap * face / self.speed)
        floor, sharp = min(2.05 * r, 0.97 * apart.min(initial=np.inf)), min(SHARP, cosine.min(initial=1.0))
        near = apart < floor + 2.0 * min(self.speed, cap * face)
        for _ in range(10):
            seen = x + move
            if (
                (self._cosines(Curve(seen, mesh)) >= sharp).all()
                and self._gap(seen, e[near], f[near]) > floor
                and self._go(seen)
            ):
                return True
            move *= 0.6
        return False

    def rise(self, height: float = 0.5) -> None:
        """Become so high, as a part of the size, that views from the side show other diagrams."""
        size = np.ptp(self.seen, axis=0)
        most, now = height * size.max(), max(size[2], 1e-3 * size.max())
        while now < most:
            now, before = min(now + 0.7 * self.face, most), now
            if not self._go(self.seen * [1.0, 1.0, now / before]):
                break

    def thicken(self, most: float) -> None:
        """Make the rope by itself as thick as there is room for, but not much at once."""
        room = 0.45 * self._gap(self.seen, *self._strands(Curve(self.seen, self.mesh), 3.0 * most, most))
        self.thick = max(self.thick, min(most, room, 1.15 * self.thick))

    def _add_tension(
        self, model: _Model, here: Curve, crossings: int, lying: BoolArray, springs: Springs | None
    ) -> None:
        """Tension towards the length that so many crossings need and edges of equal lengths, weight, and drag."""
        mesh, ell, face = self.mesh, here.edge_lengths, self.face
        means = (np.add.reduceat(ell, mesh.edge_offsets[:-1]) / mesh.edge_counts)[mesh.edge_component]
        unit, along, eye = float(ell.mean()) / face**2, here.edge_vectors / ell[:, None], np.eye(3)
        if springs is None:  # what is not led is to stay where ways have been planned
            need = face * max(8.0, 1.8 * crossings)
            self._pull = 0.06 * float(np.clip((ell.sum() / need - 1.0) / 0.15, -0.2, 1.0))
        goal = (1.0 - self._pull) * means
        both = along[:, :, None] * along[:, None, :]
        stiffness = both + np.maximum(0.0, 1.0 - goal / ell)[:, None, None] * (eye - both)
        one, soft = np.ones(mesh.edges), 0.06 * means
        ends = (mesh.tails, -one), (mesh.heads, one)
        model.couple(ends, ((ell - goal) / soft)[:, None] * along, stiffness / soft[:, None, None])
        model.force[:, 2] += 1.5 * unit * lying * here.vertices[:, 2]
        model.form[:, 2, 2] += 1.5 * unit * lying
        drag = 1.0 if springs is None else 3.0 if springs.landed else 20.0
        tangent = both[mesh.outgoing]
        across = unit * np.where(lying, drag, 1.0)
        model.form += across[:, None, None] * (eye - tangent) + 0.1 * unit * tangent

    def _add_repulsion(self, model: _Model, here: Curve, crossings: IntArray, lying: BoolArray) -> None:
        """Repulsion in the plane between vertices within a face that are not near one crossing, nor along the curve."""
        mesh, x, face, n = self.mesh, here.vertices, self.face, self.mesh.size
        mean = float(here.edge_lengths.mean())
        i, j = cKDTree(x[:, :2]).query_pairs(face, output_type="ndarray").T
        far = arc_distance_of_vertices(here, i, j) > 1.6 * face
        i, j = (each[far & lying[i] & lying[j]] for each in (i, j))
        reach, tails = int(0.5 * face / mean), mesh.tails[crossings]
        start = mesh.offsets[mesh.component[tails]][:, :, None]
        size = np.array(mesh.component_sizes)[mesh.component[tails]][:, :, None]
        a, b = start + (tails[:, :, None] - start + np.arange(-reach - 1, reach + 3)) % size
        near_one = np.unique(np.minimum(a[:, :, None], b[:, None]) * n + np.maximum(a[:, :, None], b[:, None]))
        apart = ~np.isin(i * n + j, near_one, assume_unique=True)
        i, j = i[apart], j[apart]
        v = (x[i] - x[j]) * [1.0, 1.0, 0.0]
        d = np.linalg.norm(v, axis=1) + 1e-12 * face
        q, weight = v / d[:, None], 1.5 * (mean / face) ** 2
        _, first, second = phi(np.maximum(d / face, 0.04))
        force, form = (
            (weight * first)[:, None] * q,
            (2.0 * weight / face * second)[:, None, None] * q[:, :, None] * q[:, None],
        )
        for vertices, sign in ((i, 1.0), (j, -1.0)):
            _add(model.force, vertices, sign * force)
            _add(model.form, vertices, form)

    def _add_barrier(self, model: _Model, here: Curve, e: IntArray, f: IntArray) -> FloatArray:
        """The barrier at the rope's diameter, between edges that are near each other; return how far apart they are."""
        r, ell = max(self.thick, 1e-12 * self.face), here.edge_lengths
        chord, s, t = closest(EdgePairs.of(self.mesh, here.vertices, e, f))
        apart = np.linalg.norm(chord, axis=1)
        e, f, chord, s, t, d = (each[apart < 4.0 * r] for each in (e, f, chord, s, t, apart))
        q, weight = chord / d[:, None], 0.2 * ell[e] * ell[f] / r
        _, first, second = phi(np.maximum(0.5 * d / r - 1.0, 1e-3))
        (a, b), (u, v) = ((self.mesh.tails[each], self.mesh.heads[each]) for each in (e, f))
        corners = (a, 0.5 - s), (b, 0.5 + s), (u, t - 0.5), (v, -0.5 - t)
        form = (0.25 * weight * second / r**2)[:, None, None] * q[:, :, None] * q[:, None]
        model.couple(corners, (0.5 * weight * first / r)[:, None] * q, form)
        return np.asarray(apart)

    def _strands(self, here: Curve, reach: float, radius: float) -> tuple[IntArray, IntArray]:
        """Pairs of edges whose middles are so near that they may be within reach, but that are far along the curve."""
        ell = here.edge_lengths
        e, f = cKDTree(here.midpoints).query_pairs(reach + ell.max(), output_type="ndarray").T
        far = arc_distance_of_pairs(here, e, f, 0.5) > 1.5 * np.pi * radius + 0.5 * (ell[e] + ell[f])
        return e[far], f[far]

    def _cosines(self, here: Curve) -> FloatArray:
        """Cosines of the angles by which the curve turns at its inner vertices."""
        along, mesh = here.edge_vectors / here.edge_lengths[:, None], self.mesh
        return np.asarray(np.einsum("ij,ij->i", along[mesh.incoming[mesh.inner]], along[mesh.outgoing[mesh.inner]]))

    def _gap(self, seen: FloatArray, e: IntArray, f: IntArray) -> float:
        """The smallest distance between pairs of edges."""
        chord, _, _ = closest(EdgePairs.of(self.mesh, seen, e, f))
        return float(np.linalg.norm(chord, axis=1).min(initial=np.inf))

    def _go(self, seen: FloatArray) -> bool:
        """Go straight to places in the frame, shape (n, 3), scaled to keep the length, if that is proved."""
        seen = np.where(self.held[:, None], self.seen, seen)
        end = seen
        if self._length is not None:
            length = np.linalg.norm(self.mesh.changes(seen), axis=1).sum()
            end = self._length / length * (seen - seen.mean(axis=0) * [1.0, 1.0, 0.0])
        end = end @ self.frame.T + self._origin
        end[self.held] = self.vertices[self.held]
        legs = self.mesh, self.vertices, end
        kept = self.radius is None or is_rope(*legs, self.radius, self.obstacles)
        if not kept or (self.radius is None and not is_free(*legs, self.obstacles)):
            return False
        self.vertices, self.seen = end, seen
        self.path.append(end)
        return True


def _add(total: FloatArray, index: IntArray, values: FloatArray) -> None:
    """Add values, shape (k, …), to the entries at an index, which may be there several times."""
    width = total[0].size
    places = (index[:, None] * width + np.arange(width)).ravel()
    total += np.bincount(places, values.ravel(), total.size).reshape(total.shape)
