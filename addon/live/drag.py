"""Dragging in a 3D view: a strand is grabbed where the mouse is pressed on it, and pulled along with the mouse."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from bpy_extras.view3d_utils import region_2d_to_location_3d

from ...core import Curve
from ...core.curve.distances import points_along
from ...core.types import FloatArray
from ..curves.exchange import stretch

if TYPE_CHECKING:
    from .run import Run

_NEAR = 15.0  # pixels from the mouse to a strand, at the usual scale of the interface
_ALIKE = 4.0  # pixels by which a strand in front may be farther from the mouse than one behind
_STRAND = 0.05  # share of all edges within which the edges under the mouse belong to one strand
_OVER = ("UI", "TOOLS", "HEADER", "TOOL_HEADER")  # regions that may lie over a view
_GIZMOS = np.array([1.2, 4.0])  # width and height of the navigation gizmo's corner, in sizes of the gizmo


@dataclass(eq=False)
class Drag:
    """The held point of a link, by component and share of its length, and the place in view that it is pulled to."""

    component: int
    share: float
    target: FloatArray  # shape (3,)
    region: Any  # the one of the 3D view where the mouse was pressed
    offset: FloatArray  # from the mouse to the target, in pixels, when it was pressed; shape (2,)

    @classmethod
    def at(cls, curve: Curve, region: Any, mouse: FloatArray, near: float, radius: float = 0.0) -> "Drag | None":
        """A drag of the strand under the mouse, the one in front if there are several; None if none is near.

        ``near``: how far it may be, in pixels; ``radius``: of the tube, in the world.
        """
        flat, depth, seen = projected(region, curve.vertices)
        tails, heads = curve.mesh.tails, curve.mesh.heads
        along, way = flat[heads] - flat[tails], mouse - flat[tails]
        t = np.einsum("ij,ij->i", way, along) / np.maximum(np.einsum("ij,ij->i", along, along), 1e-12)
        t = np.clip(t, 0.0, 1.0)
        distance = np.linalg.norm(way - t[:, None] * along, axis=1)
        distance[~(seen[tails] & seen[heads])] = np.inf
        aside = np.array(region.data.view_matrix, dtype=np.float64)[0, :3]  # to the right, whatever the view's scale
        edges_of_tube = projected(region, curve.vertices + radius / np.linalg.norm(aside) * aside)[0]
        beside = np.maximum(0.0, distance - np.linalg.norm(edges_of_tube - flat, axis=1)[tails])
        if not beside.min() <= near:
            return None
        under = np.flatnonzero(beside <= min(near, beside.min() + _ALIKE))
        front = under[np.argmin(((1.0 - t) * depth[tails] + t * depth[heads])[under])]
        strand = under[curve.mesh.index_distance(np.full_like(under, front), under) <= _STRAND * len(curve)]
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


def handle(run: "Run", context: bpy.types.Context, event: bpy.types.Event) -> bool:
    """Let the mouse drag what is relaxed; return whether the event was about that.

    A press with a modifier belongs to Blender; letting go with Ctrl leaves a pin.
    """
    mouse = np.array([event.mouse_x, event.mouse_y], dtype=np.float64)
    if event.type == "LEFTMOUSE" and event.value == "PRESS":
        if run.drag is not None:  # the release got lost, in another window
            run.let_go()
        found = None if bool(event.ctrl or event.shift or event.alt or event.oskey) else _under(run, context, mouse)
        if found is not None:
            run.grab(found)
        return found is not None
    if run.drag is None:
        return False
    if event.type == "MOUSEMOVE":
        run.pull(run.drag.under(mouse - _corner(run.drag.region)))
    elif event.type == "LEFTMOUSE" and event.value == "RELEASE":
        run.let_go(pin=event.ctrl)
    else:
        return False
    return True


def _under(run: "Run", context: bpy.types.Context, mouse: FloatArray) -> Drag | None:
    """The strand of a running relaxation under the mouse, in a 3D view without anything over it."""
    if run.state.name != "RUNNING" or run.shown is None:
        return None
    region, curve = _region(context, mouse), run.group.in_view
    if region is None or curve is None:
        return None
    near, radius = (
        _NEAR * context.preferences.system.ui_scale,
        max(stretch(each) * each.data.bevel_depth for each in run.group.objects),
    )
    return Drag.at(curve, region, mouse - _corner(region), near, radius)


def _region(context: bpy.types.Context, mouse: FloatArray) -> Any:
    """The region of a 3D view that has the mouse, unless a sidebar, a header or the navigation gizmo has it."""
    areas = context.window.screen.areas if context.window else []
    found = [region for area in areas if area.type == "VIEW_3D" for region in area.regions if _inside(region, mouse)]
    regions = [region for region in found if region.type == "WINDOW"]
    if not regions or any(region.type in _OVER for region in found):
        return None
    view, system = context.preferences.view, context.preferences.system
    corner = _GIZMOS * view.gizmo_size_navigate_v3d * system.ui_scale
    far = _corner(regions[0]) + _size(regions[0]) - mouse
    return None if view.show_navigate_ui and (far < corner).all() else regions[0]


def _inside(region: Any, mouse: FloatArray) -> bool:
    place, size = mouse - _corner(region), _size(region)
    return bool((size > 1).all() and (place >= 0).all() and (place < size).all())


def _corner(region: Any) -> FloatArray:
    return np.array([region.x, region.y], dtype=np.float64)


def _size(region: Any) -> FloatArray:
    return np.array([region.width, region.height], dtype=np.float64)


def projected(region: Any, points: FloatArray) -> tuple[FloatArray, FloatArray, Any]:
    """Where points, (n, 3), appear in a region, in pixels, (n, 2), how deep, (n,), and which are in front, (n,)."""
    matrix = np.array(region.data.perspective_matrix, dtype=np.float64)
    *place, w = (np.pad(points, ((0, 0), (0, 1)), constant_values=1.0) @ matrix.T).T
    x, y, depth = np.array(place) / np.where(w > 0.0, w, 1.0)
    return 0.5 * (1.0 + np.stack([x, y], axis=1)) * _size(region), depth, w > 0.0
