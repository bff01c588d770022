"""Dragging in a 3D view: a strand is grabbed where the mouse is pressed on it, and pulled along with the mouse."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from bpy_extras.view3d_utils import region_2d_to_location_3d

from ...core import Curve
from ...core.base import FloatArray, dot
from ...core.curve.distances import points_along


@dataclass(eq=False)
class Drag:
    """The held point of a link, by component and share of its length, and the place in view that it is pulled to."""

    component: int
    share: float
    target: FloatArray  # shape (3,)
    region: Any  # the one of the 3D view where the mouse was pressed
    offset: FloatArray  # from the mouse to the target, in pixels, when it was pressed; shape (2,)
    pins: bool = False  # whether the point stays pinned where it is let go

    @classmethod
    def at(cls, curve: Curve, region: Any, mouse: FloatArray, near: float, radius: float = 0.0) -> "Drag | None":
        """A drag of the strand under the mouse, the one in front if there are several; None if none is near.

        ``near``: how far it may be, in pixels; ``radius``: of the tube, in the world.
        """
        flat, depth, seen = projected(region, curve.vertices)
        tails, heads = curve.mesh.tails, curve.mesh.heads
        along, way = flat[heads] - flat[tails], mouse - flat[tails]
        t = dot(way, along) / np.maximum(dot(along, along), 1e-12)
        t = np.clip(t, 0.0, 1.0)
        distance = np.linalg.norm(way - t[:, None] * along, axis=1)
        distance[~(seen[tails] & seen[heads])] = np.inf
        aside = np.array(region.data.view_matrix, dtype=np.float64)[0, :3]  # to the right, whatever the view's scale
        edges_of_tube = projected(region, curve.vertices + radius / np.linalg.norm(aside) * aside)[0]
        beside = np.maximum(0.0, distance - np.linalg.norm(edges_of_tube - flat, axis=1)[tails])
        if not beside.min() <= near:
            return None
        # a strand in front may be 4 pixels farther from the mouse than one behind
        under = np.flatnonzero(beside <= min(near, beside.min() + 4.0))
        front = under[np.argmin(((1.0 - t) * depth[tails] + t * depth[heads])[under])]
        # edges under the mouse within 5 % of all belong to one strand
        strand = under[curve.mesh.index_distance(np.full_like(under, front), under) <= 0.05 * len(curve)]
        edge = int(strand[np.argmin(distance[strand])])
        component = int(curve.mesh.edge_component[edge])
        length = curve.arc_starts[edge] + t[edge] * curve.edge_lengths[edge]
        place = curve.vertices[tails[edge]] + t[edge] * curve.edge_vectors[edge]
        share = min(1.0, float(length / curve.component_lengths[component]))
        return cls(component, share, place, region, flat[tails[edge]] + t[edge] * along[edge] - mouse)

    def held(self, curve: Curve) -> FloatArray:
        """The held point on a curve; shape (3,)."""
        place = self.share * curve.component_lengths[[self.component]]
        return np.asarray(points_along(curve, np.array([self.component]), place)[0])

    def under(self, mouse: FloatArray) -> FloatArray:
        """The place under the mouse in the plane of the view through the target; shape (3,)."""
        there = region_2d_to_location_3d(self.region, self.region.data, mouse + self.offset, self.target.tolist())
        return np.array(there, dtype=np.float64)


def corner(region: Any) -> FloatArray:
    """The lower left corner of a region in its window, in pixels; shape (2,)."""
    return np.array([region.x, region.y], dtype=np.float64)


def size(region: Any) -> FloatArray:
    """Width and height of a region, in pixels; shape (2,)."""
    return np.array([region.width, region.height], dtype=np.float64)


def projected(region: Any, points: FloatArray) -> tuple[FloatArray, FloatArray, Any]:
    """Where points, (n, 3), appear in a region, in pixels, (n, 2), how deep, (n,), and which are in front, (n,)."""
    matrix = np.array(region.data.perspective_matrix, dtype=np.float64)
    *place, w = (np.pad(points, ((0, 0), (0, 1)), constant_values=1.0) @ matrix.T).T
    x, y, depth = np.array(place) / np.where(w > 0.0, w, 1.0)
    return 0.5 * (1.0 + np.stack([x, y], axis=1)) * size(region), depth, w > 0.0
