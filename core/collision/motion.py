"""How far all vertices can move along straight lines before two edges meet."""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

import numpy as np

from ..curve import Mesh
from ..types import BoolArray, FloatArray, IntArray
from .boxes import BoxTree, Level, contact_window
from .exact import first_contact
from .folds import folds
from .march import march

_BATCH = 1 << 13  # pairs marched together, so that their arrays stay in the cache
_SHARPNESS = 0.985  # a time proved up to this part of a known contact time is near enough to it
_EARLY_START = 0.875  # part of the time at which boxes meet where marching begins: the pair is clearly apart there


class Limit(Enum):
    """What ends a free motion."""

    NONE = "the whole motion is free of contact"
    CONTACT = "two edges meet, or come too near to each other to be told apart"
    TOUCHING_START = "two edges touch, or cannot be told apart, at the start"
    NOT_FINITE = "a vertex is not finite"
    UNTESTED = "in more than three dimensions, where nothing is knotted, contact is not tested"


@dataclass(frozen=True)
class FreeMotion:
    """How much of a motion is proved free of contact.

    Attributes
    ----------
    time
        No two non-neighbour edges meet at any time t in [0, time], unless time is 0; 1 if the whole motion is free.
        If two edges meet, this is at most 2 % before the contact.
    pair
        The edges that limit it, None if there are none.
    limit
        The reason.
    """

    time: float
    pair: tuple[int, int] | None = None
    limit: Limit = Limit.NONE

    @property
    def proved(self) -> bool:
        """Whether the whole motion is proved free of contact."""
        return self.limit is Limit.NONE


def free_motion(mesh: Mesh, start: FloatArray, end: FloatArray) -> FreeMotion:
    """Prove as much as possible of the motion (1−t) start + t end, t in [0, 1], free of contact.

    Neighbour edges are not tested: when they fold onto each other, one of them meets the edge after the other. In
    triangles and at the ends of arcs, where there is no such edge, a vertex is tested against an edge (`folds`).

    Parameters
    ----------
    mesh
        Connectivity.
    start, end
        Vertices at both ends, shape (n, m) with m = 2 or 3. The proof is about exactly these floating-point numbers.

    Raises
    ------
    ValueError
        If the shapes are wrong.
    """
    return _search(mesh, start, end, exhaustive=True)


def is_free(mesh: Mesh, start: FloatArray, end: FloatArray) -> bool:
    """Whether the motion from ``start`` to ``end``, shape (n, m), is proved free of contact; see `free_motion`."""
    return _search(mesh, start, end, exhaustive=False).limit is Limit.NONE


def _search(mesh: Mesh, start: FloatArray, end: FloatArray, *, exhaustive: bool) -> FreeMotion:
    if start.shape != end.shape or start.shape not in ((mesh.size, 2), (mesh.size, 3)):
        raise ValueError(
            f"start and end have shapes {start.shape} and {end.shape}; "
            f"both must be ({mesh.size}, 2) or ({mesh.size}, 3)"
        )
    size = np.maximum(np.abs(start).max(), np.abs(end).max())
    if not np.isfinite(size):  # NumPy's maximum, unlike Python's, is NaN if one is
        return FreeMotion(0.0, None, Limit.NOT_FINITE)
    # A power of two keeps products away from overflow and underflow. It changes no digit, but of the smallest numbers,
    # by less than the planes' margins: exact decisions are about the numbers as they were given.
    unit = -np.frexp(size)[1]
    search = _Search(mesh, np.ldexp(start.T, unit, order="C"), np.ldexp(end.T, unit, order="C"), (start, end))
    for vertices, reached in search.batches():
        search.take(vertices, reached)
        if search.pair is not None and not exhaustive:
            break
    return search.result()


class _Search:
    """The earliest contact so far, and what remains to be looked at."""

    def __init__(self, mesh: Mesh, start: FloatArray, end: FloatArray, given: tuple[FloatArray, FloatArray]) -> None:
        self.mesh, self.start, self.end, self.given = mesh, start, end, given
        self.limit = 1.0  # proved free up to here, as far as pairs have been looked at
        self.contact = np.inf  # the earliest contact found by an exact decision
        self.pair: tuple[int, int] | None = None

    def result(self) -> FreeMotion:
        if self.pair is None:
            return FreeMotion(1.0)
        return FreeMotion(self.limit, self.pair, Limit.CONTACT if self.limit > 0 else Limit.TOUCHING_START)

    def batches(self) -> Iterator[tuple[IntArray, FloatArray]]:
        """Yield pairs of edges that can meet before the limit: their vertices and the time each is surely free."""
        corners = folds(self.mesh)
        yield corners, np.zeros(corners.shape[1])
        tree = BoxTree.build(self.mesh, self.start, self.end)
        soon = self._soon()
        for after, until in ((-1.0, soon), (soon, 1.0)) if soon < 1 else ((-1.0, 1.0),):
            yield from self._windows(tree, after, until)

    def _soon(self) -> float:
        """A time in which vertices move by about an edge length: contacts until then limit the search for others."""
        speed = self.end - self.start
        speed -= speed.mean(axis=1, keepdims=True)
        fastest = float(np.sqrt(np.einsum("mn,mn->n", speed, speed).max()))
        edges = self.start[:, self.mesh.heads] - self.start[:, self.mesh.tails]
        length = float(np.sqrt(np.einsum("mn,mn->n", edges, edges)).mean())
        return 1.0 if 2 * length >= fastest else length / fastest

    def _windows(self, tree: BoxTree, after: float, until: float) -> Iterator[tuple[IntArray, FloatArray]]:
        """Pairs whose boxes meet first at a time in (after, until]."""

        def near(level: Level, a: IntArray, b: IntArray) -> BoolArray:
            enter, leave = contact_window(level.gaps(a, b))
            keep = enter <= np.minimum(leave, min(until, self.limit))
            return keep & (enter > after) if level.leaves else keep

        for i, j in tree.pairs(near):
            for k in range(0, len(i), _BATCH):
                a, b = i[k : k + _BATCH], j[k : k + _BATCH]
                enter, _ = contact_window(tree.levels[-1].gaps(a, b))
                yield tree.corners(a, b), _EARLY_START * enter

    def take(self, vertices: IntArray, reached: FloatArray) -> None:
        """March pairs and lower the limit to the earliest time that cannot be passed."""
        reached = march(self.start, self.end, vertices, reached, self.limit)
        stopped = np.flatnonzero(reached < self.limit)
        for k in stopped[np.argsort(reached[stopped], kind="stable")]:
            time = float(reached[k])
            if time >= self.limit:
                break
            if time < _SHARPNESS * self.contact:
                time = self._decide(vertices[:, k], time)
            if time < self.limit:
                i, j = self.mesh.outgoing[vertices[[0, 2], k]].tolist()
                self.limit, self.pair = time, (i, j)

    def _decide(self, vertices: IntArray, reached: float) -> float:
        """The time up to which one pair is free by exact arithmetic, infinite if it never meets."""
        start, end = self.given
        contact = first_contact(start[vertices], end[vertices], reached)
        if contact is None:
            return np.inf
        self.contact = min(self.contact, contact)
        return max(reached, float(np.nextafter(contact, 0.0)))
