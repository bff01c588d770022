"""The objects shown, as obstacles at rest in the world and in the common space of the objects that move."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...core import CurveError, Obstacle
from ...core.messages import Message
from ...core.types import FloatArray, IntArray
from .placement import Frame, Link, Placement

_FAR = 1e30  # Blender clamps infinite coordinates to the largest 32-bit number
_WORLD = Placement(np.eye(3), np.zeros(3))


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles, and edges that belong to none of them, in the world."""

    vertices: FloatArray  # positions, shape (k, 3)
    triangles: IntArray  # indices of their corners, shape (f, 3)
    edges: IntArray  # indices of the ends of those edges, shape (e, 2)

    @classmethod
    def of_mesh(
        cls, points: Frame, triangles: npt.NDArray[np.int32], edges: npt.NDArray[np.int32], placement: Placement
    ) -> "Surface":
        """What a mesh shows at a place: all its triangles, edges (e, 2), and points, (k, 3) in its own coordinates."""
        vertices = placement.to_world(points.astype(np.float64))
        return cls(vertices, triangles.astype(np.intp), _loose(edges.astype(np.intp), triangles.astype(np.intp)))

    def equals(self, other: "Surface") -> bool:
        """Whether both are the same, bit for bit."""
        pairs = ((self.vertices, other.vertices), (self.triangles, other.triangles), (self.edges, other.edges))
        return all(np.array_equal(a, b) for a, b in pairs)


def _loose(edges: IntArray, triangles: IntArray) -> IntArray:
    """The edges that are not sides of a triangle; shape (e, 2)."""
    sides = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    low, high = np.sort(edges, axis=1).T
    count = 1 + max(sides.max(initial=0), edges.max(initial=0))
    return edges[~np.isin(low * count + high, sides[:, 0] * count + sides[:, 1])]


def obstacles(name: str, surfaces: Sequence[Surface]) -> Iterator[Obstacle]:
    """Yield what an object shows, all of its parts together: its triangles, and its edges that belong to none.

    Raises CurveError if there is nothing, or a coordinate is not finite, or as good as infinite.
    """
    ends = np.cumsum([0, *(len(each.vertices) for each in surfaces)])
    vertices = np.concatenate([np.empty((0, 3)), *(each.vertices for each in surfaces)])
    kinds = [each.triangles for each in surfaces], [each.edges for each in surfaces]
    found = [np.concatenate([a + k for a, k in zip(kind, ends, strict=False)]) for kind in kinds if any(map(len, kind))]
    if not found:
        raise CurveError(Message("'{name}' shows neither faces nor edges; leave it out of what is avoided", name=name))
    for simplices in found:
        used, corners = np.unique(simplices, return_inverse=True)
        if not (np.abs(vertices[used]) < _FAR).all():
            sentence = "A point of '{name}' is not finite, or further away than anything; repair or delete it"
            raise CurveError(Message(sentence, name=name))
        yield Obstacle(vertices[used], corners.reshape(simplices.shape), name)


def in_common_space(avoid: Iterable[Obstacle], link: Link) -> tuple[Obstacle, ...]:
    """The world's obstacles in the space where motions of a link are proved: vertices are mapped there in doubles."""
    there = _WORLD.relative_to(link.placements[0])
    return tuple(Obstacle(there.to_world(each.vertices), each.faces, each.name) for each in avoid)
