"""An elastic rope that lies on a table: what it does by itself, and where springs lead it.

Its energy is that of its tension, of its bending, of its weight, z², a barrier at its diameter, and a repulsion *in the
plane* between strands that do not cross near there, which keeps its diagram and opens the faces of that.  A step goes
to the minimum of a convex quadratic model, as far as that is proved.  Lengths are measured by the width of a face, and
forces by the largest tension.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..base import BoolArray, FloatArray, IntArray, check_time, dot
from ..collision import is_rope, minimal_gap
from ..curve import Curve, Obstacle, arc_distance_of_pairs
from ..curve.distances import arc_distance_of_vertices
from ..energies.edge_pairs import EdgePairs
from ..energies.rope import closest, phi
from ..knots.diagrams.projection import plane_crossings
from .model import ElasticModel, add_at


class Legs(NamedTuple):
    """Motions on one mesh; they start where the previous ones end, except for vertices on straight edges."""

    start: Curve  # where they begin, in the user's units
    path: tuple[FloatArray, ...]  # the vertices at the end of each leg, (n, 3); empty where only the mesh changes
    crossings: int  # in the view, at the end
    moves: int  # of strands, by then

    @property
    def end(self) -> Curve:
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

    stride: ClassVar[float] = 0.35  # the most that a vertex moves in a step, or in a leg of several, in faces
    fat: ClassVar[float] = 0.08  # the largest ``thick``, in faces
    hold: ClassVar[float] = 30.0  # stiffness of springs, in that of its weight
    sharp: ClassVar[float] = 0.3  # cosine of the sharpest turn at a vertex, if there are no sharper ones

    def __init__(
        self, curve: Curve, frame: FloatArray, held: BoolArray, obstacles: Sequence[Obstacle], radius: FloatArray | None
    ) -> None:
        self.mesh, self.frame, self.held, self.obstacles, self.radius = curve.mesh, frame, held, obstacles, radius
        self.vertices, self._start = curve.vertices, curve
        self.path: list[FloatArray] = []  # the vertices at the end of each leg so far
        self._key: FloatArray | None = None  # those where the last leg begins, if it may go on
        self._length = curve.length if not held.any() and not obstacles else None  # that it keeps
        self._origin = (curve.vertices[held] if held.any() else curve.vertices).mean(axis=0)
        self.seen = (self.vertices - self._origin) @ frame
        self.thick, self.face, self.speed, self._pull = 0.0, 1.0, 0.0, 0.0

    @property
    def curve(self) -> Curve:
        return Curve(self.vertices, self.mesh)

    def take(self, crossings: int, moves: int) -> Legs:
        """The motions that have not been taken yet; what is seen at their end comes with them."""
        legs = Legs(self._start, tuple(self.path), crossings, moves)
        self.path, self._start, self._key = [], self.curve, None
        return legs

    def mark(self) -> tuple[FloatArray, FloatArray, float, int]:
        """What `rewind` needs."""
        self._key = None
        return self.vertices, self.seen, self.thick, len(self.path)

    def rewind(self, mark: tuple[FloatArray, FloatArray, float, int]) -> None:
        """Forget all motions since a mark."""
        self.vertices, self.seen, self.thick, count = mark
        self._key = None
        del self.path[count:]

    def step(self, springs: Springs | None = None) -> bool:
        """Go one step, in which no vertex moves by more than a stride; return whether it is free."""
        check_time()
        here, mesh, face, r = Curve(self.seen, self.mesh), self.mesh, self.face, self.thick
        most = self.stride * face
        mean, model, x = float(here.edge_lengths.mean()), ElasticModel(mesh.size), here.vertices
        cosine, inner = self._cosines(here), mesh.inner
        # bending, for which corners of more than 60 degrees are stiffer
        stiffness = (0.35 * face) ** 2 / mean**3 * (1.0 + 30.0 * np.maximum(0.5 - cosine, 0.0))
        before, after, one = mesh.anticycle[inner], mesh.cycle[inner], np.ones(len(inner))
        bend = stiffness[:, None] * (x[before] - 2.0 * x[inner] + x[after])
        model.couple(((before, one), (inner, -2.0 * one), (after, one)), bend, stiffness[:, None, None] * np.eye(3))
        lying = np.ones(mesh.size, dtype=bool)
        if springs is not None:
            k, scale = springs.vertices, self.hold * mean / face**2
            lying[k] = springs.landed
            model.force[k] += scale * np.einsum("kij,kj->ki", springs.stiffness, x[k] - springs.places)
            model.form[k] += scale * springs.stiffness
        crossings = plane_crossings(mesh, x).edges
        self._add_tension(model, here, crossings.shape[1], lying, springs)
        self._add_repulsion(model, here, crossings, lying)
        e, f = self._strands(here, max(4.0 * r, 2.05 * r + 2.0 * most), r)
        apart = self._add_barrier(model, here, e, f)
        model.force[self.held] = 0.0
        model.form[self.held] += 1e9 * mean / face**2 * np.eye(3)
        move = model.minimum()
        move[self.held] = 0.0
        self.speed = float(np.linalg.norm(move, axis=1).max())
        if self.speed == 0.0:
            return False
        move *= min(1.0, most / self.speed)
        floor, sharp = min(2.05 * r, 0.97 * apart.min(initial=np.inf)), min(self.sharp, cosine.min(initial=1.0))
        near = apart < floor + 2.0 * min(self.speed, most)
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
        """Rise to a part of the size, or until corners are right, so that views from the side show other diagrams."""
        size = np.ptp(self.seen, axis=0)
        most, now = height * size.max(), max(size[2], 1e-3 * size.max())
        while now < most:
            now, before = min(now + 0.7 * self.face, most), now
            seen = self.seen * [1.0, 1.0, now / before]
            if self._cosines(Curve(seen, self.mesh)).min(initial=1.0) < 0.0 or not self._go(seen):
                break

    def lie_down(self, crossings: int, wide: float = 1.2) -> None:
        """Lie down flat, and become as thick as is good for leading strands.

        A face becomes so wide, times the root of the area for each crossing, if there is rope enough: else it shrinks.
        """
        thick = 0.0 if self.radius is None else 1.05 * float(self.radius.max())
        size = float(np.ptp(self.seen, axis=0).max())
        area = 10.0 * np.sqrt(np.linalg.det(np.cov(self.seen[:, :2].T)).clip(0.0))  # that of an ellipse, or nearly so
        enough = float(np.linalg.norm(self.mesh.changes(self.seen), axis=1).sum()) / _needed(crossings)
        self.face = max(min(wide * np.sqrt(area / max(crossings, 3)), enough), thick / self.fat, 0.02 * size)
        self.thick = max(0.45 * minimal_gap(self.curve)[0], thick)
        for k in range(40):
            if not self.step():
                break
            self._thicken()
            if k > 10 and self.speed < 0.1 * self.face and self.thick > 0.99 * self.fat * self.face:
                break

    def settle(self) -> None:
        """Come to rest, or nearly so."""
        for k in range(20):
            if not self.step() or (k >= 3 and self.speed < 0.08 * self.face):
                break
            self._thicken()

    def _thicken(self) -> None:
        """Become by itself as thick as there is room for, but not much at once."""
        most = self.fat * self.face
        room = 0.45 * self._gap(self.seen, *self._strands(Curve(self.seen, self.mesh), 3.0 * most, most))
        self.thick = max(self.thick, min(most, room, 1.15 * self.thick))

    def _add_tension(
        self, model: ElasticModel, here: Curve, crossings: int, lying: BoolArray, springs: Springs | None
    ) -> None:
        """Tension towards the length that so many crossings need and edges of equal lengths, weight, and drag."""
        mesh, ell, face = self.mesh, here.edge_lengths, self.face
        means = (np.add.reduceat(ell, mesh.edge_offsets[:-1]) / mesh.edge_counts)[mesh.edge_component]
        unit, along, eye = float(ell.mean()) / face**2, here.edge_vectors / ell[:, None], np.eye(3)
        if springs is None:  # what is not led is to stay where ways have been planned
            slack = ell.sum() / (face * _needed(crossings)) - 1.0
            self._pull = float(np.clip(0.4 * slack, -0.012, 0.02))  # more draws hooked loops tight
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

    def _add_repulsion(self, model: ElasticModel, here: Curve, crossings: IntArray, lying: BoolArray) -> None:
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
            add_at(model.force, vertices, sign * force)
            add_at(model.form, vertices, form)

    def _add_barrier(self, model: ElasticModel, here: Curve, e: IntArray, f: IntArray) -> FloatArray:
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
        return dot(along[mesh.incoming[mesh.inner]], along[mesh.outgoing[mesh.inner]])

    def _gap(self, seen: FloatArray, e: IntArray, f: IntArray) -> float:
        """The smallest distance between pairs of edges."""
        chord, _, _ = closest(EdgePairs.of(self.mesh, seen, e, f))
        return float(np.linalg.norm(chord, axis=1).min(initial=np.inf))

    def _go(self, seen: FloatArray) -> bool:
        """Go straight to places in the frame, shape (n, 3), scaled to keep the length, if that is proved.

        A straight way from where the last leg begins replaces it, unless that is far: then there are fewer legs.
        """
        seen, scale = np.where(self.held[:, None], self.seen, seen), 1.0
        end = seen
        if self._length is not None:
            scale = self._length / float(np.linalg.norm(self.mesh.changes(seen), axis=1).sum())
            end = scale * (seen - seen.mean(axis=0) * [1.0, 1.0, 0.0])
        end = end @ self.frame.T + self._origin
        end[self.held] = self.vertices[self.held]

        def proved(start: FloatArray) -> bool:
            return is_rope(self.mesh, start, end, self.radius, self.obstacles)

        key, most = self._key, self.stride * self.face * scale
        if key is not None and np.linalg.norm(end - key, axis=1).max() <= most and proved(key):
            self.path[-1] = end
        elif proved(self.vertices):
            self._key = self.vertices
            self.path.append(end)
        else:
            return False
        self.vertices, self.seen = end, seen
        return True


def _needed(crossings: int) -> float:
    """The length of a rope with so many crossings, in faces."""
    return max(8.0, 1.8 * crossings)
