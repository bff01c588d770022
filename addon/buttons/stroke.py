"""Strokes of the toolbar's tool, which become knots; clicking a crossing swaps over and under there."""

import contextlib
import threading
from collections.abc import Sequence

import bpy
import numpy as np
from bpy.props import CollectionProperty
from bpy_extras.view3d_utils import location_3d_to_region_2d, region_2d_to_location_3d
from mathutils import Vector

from ...core import Curve, MobiusFlowError
from ...core.curve.smooth import arc_lengths
from ...core.knots import Drawing
from ...core.knots.inscribed import averaged
from ...core.messages import Message
from ...core.types import FloatArray
from ..curves.exchange import read_splines
from ..engine.placement import DrawingPlane
from ..live import overlay
from ..live.requirements import Condition
from ..translations import iface_, rpt_
from .adding import OBJECT_MODE
from .drawing import DrawsKnot, described

_PLANE = "mobius_flow_plane"  # custom property of drawn curves: origin and axes of the plane, in their coordinates
_NEAR = 15.0  # pixels, at the usual scale: a click this near a crossing means it
_STEP = 4.0  # pixels from one point of a stroke to the next
_SHORTEST = 60.0  # pixels
_LOOK = 0.1  # seconds between checks of what the stroke is so far
_NAMED = 16  # most crossings of a knot that is named while it is drawn
_PASSES = 6  # averaging passes that take the hand's trembling out of a stroke
_VIEW = Condition("Draw in a 3D view", lambda context: getattr(context, "region_data", None) is None)


class CURVE_OT_mobius_flow_stroke(DrawsKnot, bpy.types.Operator):
    """Draw a stroke, which closes itself and goes over and under by turns; click a crossing to swap the two strands"""

    bl_label = "Draw Knot"
    needs = (OBJECT_MODE, _VIEW)

    path: CollectionProperty(name="Path", type=bpy.types.OperatorMousePath, options={"SKIP_SAVE", "HIDDEN"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Swap strands where there is a crossing, or else begin a stroke."""
        mouse = np.array([event.mouse_region_x, event.mouse_region_y], dtype=np.float64)
        try:
            if (drawn := Drawn.at(context.object)) and (crossing := drawn.crossing(context, mouse)):
                lifted, count = drawn.drawing.lifted([crossing]), len(drawn.drawing.crossings)
                name, said = described(lifted, count)
                obj, old = context.object, context.object.data
                obj.data = self.curve_data(name, drawn.plane.raised(lifted.vertices), lifted)
                obj.data[_PLANE], obj.name = list(old[_PLANE]), name
                bpy.data.curves.remove(old)
                self.report({"INFO"}, rpt_(said))
                return {"FINISHED"}
        except MobiusFlowError as error:
            return self.fail(error)
        self._stroke, self._name = [mouse], _Name()
        self._timer = context.window_manager.event_timer_add(_LOOK, window=context.window)
        self._handle = bpy.types.SpaceView3D.draw_handler_add(self._trace, (), "WINDOW", "POST_PIXEL")
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "MOUSEMOVE":
            mouse = np.array([event.mouse_region_x, event.mouse_region_y], dtype=np.float64)
            if np.linalg.norm(mouse - self._stroke[-1]) >= _STEP:
                self._stroke.append(mouse)
                context.area.tag_redraw()
        elif event.type == "TIMER":
            self._name.look(self._stroke)
            context.area.tag_redraw()
        elif event.type == "LEFTMOUSE" and event.value == "RELEASE":
            self.cancel(context)
            if _length(self._stroke) < _SHORTEST:
                return {"CANCELLED"}
            for place in self._stroke:
                self.path.add().loc = place
            return self.execute(context)
        elif event.type in {"ESC", "RIGHTMOUSE"}:
            self.cancel(context)
            return {"CANCELLED"}
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Remove the stroke's trace and name, also when Blender ends the operator."""
        context.window_manager.event_timer_remove(self._timer)
        bpy.types.SpaceView3D.draw_handler_remove(self._handle, "WINDOW")
        if context.area is not None:
            context.area.tag_redraw()

    def act(self, context: bpy.types.Context) -> None:
        """Lift the stroke towards the viewer, and add it at the depth of the 3D cursor."""
        self.check_lengths()
        stroke = [np.array(each.loc) for each in self.path]
        if _length(stroke) < _SHORTEST:
            raise MobiusFlowError(Message("The stroke is too short; draw a longer one"))
        plane = DrawingPlane(np.array(context.scene.cursor.location), np.array(context.region_data.view_matrix)[:3, :3])
        depth = context.scene.cursor.location
        places = [region_2d_to_location_3d(context.region, context.region_data, each, depth) for each in _even(stroke)]
        drawing = Drawing.of(plane.flattened(Curve(np.array(places))))
        middle = self.add(context, plane, drawing.lifted(), len(drawing.crossings))
        context.object.data[_PLANE] = [*(plane.origin - middle).tolist(), *plane.axes.ravel().tolist()]

    def _trace(self) -> None:
        overlay.line(np.array([*self._stroke, self._stroke[0]]), overlay.GOLD, 2.0)
        if self._name.said:
            overlay.label(iface_(self._name.said), self._stroke[-1])


class _Name:
    """What a stroke would be if it ended now; a thread finds the answer, so drawing never waits."""

    def __init__(self) -> None:
        self.said = ""
        self._seen = 0  # points of the stroke that the name is about
        self._thread: threading.Thread | None = None

    def look(self, stroke: Sequence[FloatArray]) -> None:
        """Start to name what has been drawn since, if the last search is over."""
        if self._seen != len(stroke) and not (self._thread is not None and self._thread.is_alive()):
            self._seen = len(stroke)
            self._thread = threading.Thread(target=self._find, args=(list(stroke),), daemon=True)
            self._thread.start()

    def _find(self, stroke: Sequence[FloatArray]) -> None:
        said = ""
        if _length(stroke) >= _SHORTEST:
            with contextlib.suppress(MobiusFlowError):  # it touches itself for a moment
                drawing = Drawing.of(Curve(_even(stroke)))
                count = len(drawing.crossings)
                named = described(drawing.lifted(), count)[1] if count <= _NAMED else None
                said = named or Message("{count} crossings", count=count)
        self.said = said


class Drawn:
    """A knot as it was drawn, and the places, in its coordinates, where strands cross."""

    def __init__(self, obj: bpy.types.Object) -> None:
        plane = np.array(obj.data[_PLANE])
        self.plane = DrawingPlane(plane[:3], plane[3:].reshape(3, 3))
        curve = Curve.from_components(read_splines(obj))
        self.drawing = Drawing.seen(curve.with_vertices((curve.vertices - self.plane.origin) @ self.plane.axes.T))
        crossings = self.drawing.crossings
        self.places = self.plane.raised(np.column_stack([crossings, np.zeros(len(crossings))]))
        self._world = obj.matrix_world

    @classmethod
    def at(cls, obj: bpy.types.Object | None) -> "Drawn | None":
        """The knot of an object, if it was drawn and has not been relaxed."""
        drawn = obj is not None and obj.type == "CURVE" and _PLANE in obj.data and obj.data.shape_keys is None
        return cls(obj) if drawn else None

    def crossing(self, context: bpy.types.Context, mouse: FloatArray) -> int | None:
        """The number, from 1, of the crossing under the mouse."""
        for number, place in enumerate(self.places, 1):
            there = location_3d_to_region_2d(context.region, context.region_data, self._world @ Vector(place))
            if there and np.linalg.norm(mouse - np.array(there)) < _NEAR * context.preferences.system.ui_scale:
                return number
        return None


def _length(stroke: Sequence[FloatArray]) -> float:
    return float(arc_lengths(np.array(stroke))[-1])


def _even(stroke: Sequence[FloatArray]) -> FloatArray:
    """A stroke, closed, with points at equal distances and smooth; shape (n, 2)."""
    closed = np.array([*stroke, stroke[0]])
    arc = arc_lengths(closed)
    at = np.arange(0.0, arc[-1], 2 * _STEP)
    return averaged(Curve(np.column_stack([np.interp(at, arc, x) for x in closed.T])), _PASSES)
