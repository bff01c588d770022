"""How far all vertices can move along straight lines before two edges meet, or an edge and an obstacle."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ..base import EDGE, BoolArray, FloatArray, IntArray, Message, check_time, column_dot
from ..curve import Mesh, Obstacle
from .boxes import BoxTree, Level, contact_window, still_triangles
from .exact import first_contact, first_contact_with_triangle
from .gap import folds
from .planes import march

# Vertices of pairs of edges, or of edges and triangles at rest, that can meet before the limit, x₀, x₁, y₀, y₁, and y₂
# of triangles, shape (4 or 5, pairs); numbers of the edges, or of edge and triangle, shape (2, pairs); times up to
# which the pairs are surely free, shape (pairs,)
Candidates = tuple[IntArray, IntArray, FloatArray]
Proved = TypeVar("Proved")


@dataclass(frozen=True)
class Contact:
    """An obstruction of a motion."""

    edges: tuple[int, ...]  # the two edges that meet, or the one that meets an obstacle
    obstacle: str | None = None  # its name in sentences; None if edges meet

    @property
    def message(self) -> Message:
        """The two things that meet, as sentences name them."""
        edge, *other = (Message(EDGE, number=edge + 1) for edge in self.edges)
        return Message("{edge} and {other}", edge=edge, other=self.obstacle or other[0])


@dataclass(frozen=True)
class FreeMotion:
    """How much of a motion is proved free of contact.

    No two non-neighbour edges, and no edge and obstacle, meet at any time t in [0, time], unless time is 0.  If two
    meet, this is at most 2 % before the contact.
    """

    time: float  # 1 if the whole motion is free
    contact: Contact | None = None  # what limits it, None if nothing does, or a number is not finite
    proved: bool = True  # whether the whole motion is proved free; not in more than three dimensions: nothing is tested


def free_motion(
    mesh: Mesh, start: FloatArray, end: FloatArray, obstacles: Sequence[Obstacle] = (), *, exhaustive: bool = True
) -> FreeMotion:
    """Prove as much as possible of the motion (1−t) start + t end, t in [0, 1], free of contact.

    Neighbour edges are not tested: when they fold onto each other, one of them meets the edge after the other. In
    triangles and at the ends of arcs, where there is no such edge, a vertex is tested against an edge (`folds`).

    ``start`` and ``end`` are the vertices at both ends, shape (n, m) with m = 2 or 3; the proof is about exactly these
    floating-point numbers.  Obstacles are in the same units, and in space only.  Unless the search is exhaustive it
    ends with any contact, not the first.
    """
    size = np.maximum(np.abs(start).max(), np.abs(end).max())
    if not np.isfinite(size):  # NumPy's maximum, unlike Python's, is NaN if one is
        return FreeMotion(0.0, None, proved=False)
    search = _Search(mesh, (start, end), tuple(obstacles), max([size, *(each.size for each in obstacles)]))
    for candidates in search.candidates():
        search.take(*candidates)
        if search.met is not None and not exhaustive:
            break
    return FreeMotion(1.0) if search.met is None else FreeMotion(search.limit, search.met, proved=False)


def is_free(mesh: Mesh, start: FloatArray, end: FloatArray, obstacles: Sequence[Obstacle] = ()) -> bool:
    """Whether the motion from ``start`` to ``end``, shape (n, m), is proved free of contact; see `free_motion`."""
    return free_motion(mesh, start, end, obstacles, exhaustive=False).proved


class _Search:
    """The earliest contact so far, and what remains to be examined; an obstacle is one more list of pairs."""

    def __init__(
        self, mesh: Mesh, given: tuple[FloatArray, FloatArray], obstacles: tuple[Obstacle, ...], size: float
    ) -> None:
        # A power of two keeps products away from overflow and underflow. It changes no digits but those of the
        # smallest numbers, by less than the planes' margins: exact decisions are about the numbers as they were given.
        exponent = int(np.frexp(size)[1])
        self.mesh = mesh
        self.still = still_triangles(obstacles, exponent) if obstacles else None
        # the vertices of obstacles come after those of the curve
        self.given = given if self.still is None else tuple(np.concatenate([p, self.still.vertices]) for p in given)
        self.start, self.end = (np.ldexp(points.T, -exponent, order="C") for points in self.given)
        self.limit = 1.0  # proved free up to here, as far as pairs have been examined
        self.contact = np.inf  # the earliest contact found by an exact decision
        self.met: Contact | None = None

    def candidates(self) -> Iterator[Candidates]:
        """Yield all pairs that can meet before the limit, starting with those that can do so soon.

        No pair is lost between the two searches: boxes above it never meet later than its own (`contact_window`), so
        where these meet soon no box above is dropped by the first, and the second leaves out only what that one found.
        """
        # vertices, as edges of no length, against the edges that they would lie on
        vertices = folds(self.mesh)
        yield vertices, self.mesh.outgoing[vertices[[0, 2]]], np.zeros(vertices.shape[1])
        start, end = self.start[:, : self.mesh.size], self.end[:, : self.mesh.size]
        tree = BoxTree.build(self.mesh, start, end)
        # in this time vertices move by about an edge length: contacts until then limit the search for others
        speed = end - start
        speed -= speed.mean(axis=1, keepdims=True)
        fastest = float(np.sqrt(column_dot(speed, speed).max()))
        edges = start[:, self.mesh.heads] - start[:, self.mesh.tails]
        length = float(np.sqrt(column_dot(edges, edges)).mean())
        soon = 1.0 if 2 * length >= fastest else length / fastest
        for after, until in ((-1.0, soon), (soon, 1.0)) if soon < 1 else ((-1.0, 1.0),):
            yield from self._windows(tree, tree, 0, after, until)
            if self.still is not None:
                yield from self._windows(tree, self.still.tree, self.mesh.size, after, until)

    def _windows(self, tree: BoxTree, other: BoxTree, first: int, after: float, until: float) -> Iterator[Candidates]:
        """Pairs whose boxes meet first at a time in (after, until]; ``first`` is the first vertex of the other tree."""
        batch = 1 << 13  # pairs processed together, so that their arrays stay in the cache

        def near(level: Level, a: IntArray, others: Level, b: IntArray) -> BoolArray:
            enter, leave = contact_window(level.gaps(a, others, b))
            keep = enter <= np.minimum(leave, min(until, self.limit))
            return keep & (enter > after) if level.leaves and others.leaves else keep

        for i, j in tree.pairs(near) if other is tree else tree.pairs_with(other, near):
            for k in range(0, len(i), batch):
                a, b = i[k : k + batch], j[k : k + batch]
                enter, _ = contact_window(tree.levels[-1].gaps(a, other.levels[-1], b))
                vertices = np.concatenate([tree.corners[:, a], first + other.corners[:, b]])
                # marching begins a bit before boxes meet, where the pair is clearly apart
                yield vertices, np.stack([tree.order[a], other.order[b]]), 0.875 * enter

    def take(self, vertices: IntArray, names: IntArray, reached: FloatArray) -> None:
        """March candidates and lower the limit to the earliest time that cannot be passed."""
        reached = march(self.start, self.end, vertices, reached, self.limit)
        stopped = np.flatnonzero(reached < self.limit)
        for k in stopped[np.argsort(reached[stopped], kind="stable")]:
            time = float(reached[k])
            if time >= self.limit:
                break
            if time < 0.985 * self.contact:  # a time that near a known contact needs no decision
                decide = first_contact if len(vertices) == 4 else first_contact_with_triangle
                first, last = (points[vertices[:, k]] for points in self.given)
                contact = decide(first, last, time)
                if contact is None:
                    continue
                self.contact = min(self.contact, contact)
                time = max(time, float(np.nextafter(contact, 0.0)))
            if time < self.limit:
                edge, other = names[:, k].tolist()
                touched = self.still.obstacle_of(other) if self.still and len(vertices) == 5 else None
                self.limit, self.met = time, Contact((edge,), touched.title) if touched else Contact((edge, other))


def walk(
    leg: Callable[[float, float], Proved | None], end: float, longest: float, shortest: float
) -> Iterator[tuple[float, Proved]]:
    """Yield the proved legs of a way from 0 to ``end``, each with the place it leads to.

    ``leg(place, stride)`` tries to go on from a place by a stride, to the way's end at most: it returns what is proved,
    or None.  A stride along which nothing is proved is halved; after a leg the next one is twice as long, up to the
    longest.  Where strides shorter than ``shortest`` were needed the walk ends: what it has yielded is a part of the
    way.
    """
    place, stride = 0.0, longest
    while place < end and stride >= shortest:
        check_time()
        found = leg(place, stride)
        if found is None:
            stride *= 0.5
        else:
            place += stride
            yield place, found
            stride = min(2.0 * stride, longest)
