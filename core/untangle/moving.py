"""A curve that moves along proved legs only, seen in a frame of its own."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..base.deadline import check_time
from ..base.types import BoolArray, FloatArray, IntArray
from ..collision import is_free, minimal_gap, survives_rounding
from ..collision.motion import walk
from ..curve import Curve, Mesh
from ..curve.obstacle import Obstacle


class ViewCount(NamedTuple):
    """How many crossings there are in the view, after how many strand moves."""

    crossings: int
    moves: int


@dataclass(frozen=True, eq=False)
class Stage:
    """Motions on one mesh; they start where the previous stage ends, except for vertices on straight edges."""

    start: Curve  # where they begin, in the user's units
    path: tuple[FloatArray, ...] = ()  # the vertices at the end of each leg, (n, 3); empty where only the mesh changes
    seen: ViewCount | None = None  # at the end of the last stage of a move, or before the first one; None in between

    @property
    def end(self) -> Curve:
        """The curve reached."""
        return self.start.with_vertices(self.path[-1]) if self.path else self.start


class MovingCurve:
    """A curve's vertices in the user's doubles, bit for bit those that were proved, and in a frame for planning.

    It is made of embedded polygons in space, vertices ``held`` that neither move nor vanish, as ends do not, and
    obstacles that edges must not meet.
    """

    def __init__(self, curve: Curve, held: IntArray, obstacles: Sequence[Obstacle] = ()) -> None:
        self.curve, self.obstacles = curve, tuple(obstacles)
        self.held: BoolArray = np.zeros(len(curve), dtype=bool)  # whether each vertex is; shape (n,)
        self.held[held] = self.held[curve.mesh.ends] = True
        self.frame: FloatArray = np.eye(3)  # a rotation; the third of its columns points to the eye
        self.stages: list[Stage] = []  # all motions that have not been taken
        self.moves = 0  # how many strand moves have been made

    @property
    def mesh(self) -> Mesh:
        """Its connectivity."""
        return self.curve.mesh

    @property
    def seen(self) -> FloatArray:
        """The vertices in the frame; shape (n, 3)."""
        return self.curve.vertices @ self.frame

    @property
    def size(self) -> float:
        """The largest extent in the frame's plane."""
        return float(np.ptp(self.seen[:, :2], axis=0).max())

    @property
    def gap(self) -> float:
        """The smallest distance between edges that are not neighbours."""
        return minimal_gap(self.curve)[0]

    def move(self, vertices: IntArray, targets: FloatArray) -> bool:
        """Move some vertices straight to places in the frame, shape (k, 3), if that is proved free."""
        return self._go(vertices, targets @ self.frame.T)

    def follow(self, vertices: IntArray, targets: Callable[[int], FloatArray], count: int) -> bool:
        """Move some vertices through targets 1, 2, … to the last, in as few motions as possible, if these are free."""

        def moved(at: float, stride: float) -> bool | None:
            return self.move(vertices, targets(min(int(at + stride), count))) or None

        return max((place for place, _ in walk(moved, count, count, 1.0)), default=0.0) >= count

    def straighten(self, vertices: IntArray, parts: FloatArray) -> bool:
        """Move some vertices to given parts of the way between their neighbours, which stay, if that is proved free."""
        start, end = self.curve.vertices[self.mesh.anticycle[vertices]], self.curve.vertices[self.mesh.cycle[vertices]]
        return self._go(vertices, start + parts[:, None] * (end - start))

    def resize(self, length: float) -> bool:
        """Scale the curve to a length, if nothing is held and that is proved free."""
        middle = self.curve.vertices.mean(axis=0)
        places = middle + (length / self.curve.length) * (self.curve.vertices - middle)
        return not self.held.any() and self._go(np.arange(self.mesh.size), places)

    def _go(self, vertices: IntArray, places: FloatArray) -> bool:
        check_time()
        end = self.curve.vertices.copy()
        free = ~self.held[vertices]
        end[vertices[free]] = places[free]
        if not is_free(self.mesh, self.curve.vertices, end, self.obstacles):
            return False
        last = self.stages.pop() if self.stages else Stage(self.curve)
        self.curve = self.curve.with_vertices(end)
        self.stages.append(Stage(last.start, (*last.path, self.curve.vertices)))
        return True

    def insert(self, places: FloatArray, first: int = 0) -> bool:
        """Put vertices on edges, at tails plus fractions, in ascending order, if rounding allows it.

        A closed component is renumbered so that it begins with vertex ``first`` of the new mesh.
        """
        tails = np.floor(places).astype(np.intp)
        start, end = self.curve.vertices[tails], self.curve.vertices[self.mesh.cycle[tails]]
        points = np.insert(self.curve.vertices, tails + 1, start + (places - tails)[:, None] * (end - start), axis=0)
        added = np.bincount(self.mesh.component[tails], minlength=len(self.mesh.component_sizes))
        mesh = Mesh(tuple((np.array(self.mesh.component_sizes) + added).tolist()), self.mesh.closed)
        order = np.arange(mesh.size)
        part = mesh.slices[mesh.component[first]]
        if mesh.closed[mesh.component[first]]:
            order[part] = np.roll(order[part], part.start - first)
        held = np.insert(self.held, tails + 1, False)
        finer = Curve(points[order], mesh)
        return self._change_mesh(finer, held[order], survives=finer)

    def without(self, dropped: IntArray) -> Curve:
        """The curve without some vertices."""
        left = np.bincount(np.delete(self.mesh.component, dropped), minlength=len(self.mesh.component_sizes))
        return Curve(np.delete(self.curve.vertices, dropped, axis=0), Mesh(tuple(left.tolist()), self.mesh.closed))

    def drop(self, dropped: IntArray) -> bool:
        """Remove vertices that lie, up to rounding, on the segments between their neighbours, if rounding allows it."""
        return self._change_mesh(self.without(dropped), np.delete(self.held, dropped), survives=self.curve)

    def _change_mesh(self, curve: Curve, held: BoolArray, survives: Curve) -> bool:
        if not survives_rounding(survives, self.obstacles):
            return False
        self.curve, self.held = curve, held
        self.stages.append(Stage(curve))
        return True

    def take(self, crossings: int) -> list[Stage]:
        """The stages not yet taken, or at least one where the curve is; ``crossings`` are seen at its end."""
        *stages, last = self.stages or [Stage(self.curve)]
        self.stages = []
        return [*stages, replace(last, seen=ViewCount(crossings, self.moves))]

    def mark(self) -> tuple[Curve, BoolArray, int, int]:
        """What `rewind` needs."""
        return self.curve, self.held, len(self.stages), len(self.stages[-1].path) if self.stages else 0

    def rewind(self, mark: tuple[Curve, BoolArray, int, int]) -> None:
        """Forget all motions since a mark."""
        self.curve, self.held, stages, legs = mark
        del self.stages[stages:]
        if stages:
            self.stages[-1] = Stage(self.stages[-1].start, self.stages[-1].path[:legs])
