"""Operators that lift drawings into knots."""

import contextlib
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import bpy
import numpy as np
from bpy.props import BoolProperty, BoolVectorProperty, CollectionProperty, FloatProperty, IntProperty
from bpy_extras.object_utils import object_data_add
from bpy_extras.view3d_utils import region_2d_to_location_3d

from ...core import Curve, MobiusFlowError
from ...core.base import FloatArray, Message
from ...core.curve import Mesh, arc_lengths, smoothed
from ...core.keys.placement import Placement
from ...core.keys.planes import DrawingPlane
from ...core.knots import Drawing, knot_type
from ...core.knots.inscribed import averaged
from ..curves.strands import Strands, read_link
from ..live import overlay
from ..live.drag import projected
from ..live.requirements import Condition
from ..live.selection import selected_curves
from ..translations import iface_, rpt_
from .adding import OBJECT_MODE, AddsKnot

_DRAWN = Condition("Draw a flat curve and select it first", lambda context: not selected_curves(context))
_SWITCHES = 32  # Blender's longest array of switches


class DrawsKnot(AddsKnot):
    """An operator that lifts a drawing into a knot, and adds it where it was drawn."""

    common = ("color_components",)
    placing = ()

    def add(self, context: bpy.types.Context, plane: DrawingPlane, lifted: Curve, crossings: int) -> FloatArray:
        """Add a knot that was lifted from a plane, report its type, and return where its object is."""
        vertices, (name, said) = plane.raised(lifted.vertices), described(lifted, crossings)
        middle = vertices.mean(axis=0)
        obj = object_data_add(context, self.curve_data(name, vertices - middle, lifted))
        obj.location, obj.rotation_euler = middle, (0.0, 0.0, 0.0)
        self.report({"INFO"}, rpt_(said))
        return np.asarray(middle)


class CURVE_OT_mobius_flow_draw_knot(DrawsKnot, bpy.types.Operator):
    """Make a knot of the selected flat drawing: where strands cross, one goes over the other; the drawing stays"""

    bl_label = "Knot from Drawing"
    needs = (OBJECT_MODE, _DRAWN)

    change: BoolVectorProperty(
        name="Change Crossings",
        description="Swap over and under at a crossing; they are numbered along the curve",
        size=_SWITCHES,
        default=(False,) * _SWITCHES,
        options={"SKIP_SAVE"},
    )
    mirror: BoolProperty(name="Mirror", description="Swap over and under at all crossings", default=False)
    height: FloatProperty(
        name="Height",
        description="How far strands go over and under; 1 for what looks right in the space there",
        default=1.0,
        min=0.01,
        soft_max=3.0,
        max=100.0,
    )
    number: BoolProperty(
        name="Number Crossings", description="Mark each crossing by an empty that shows its number", default=False
    )
    hide_drawing: BoolProperty(
        name="Hide Drawing", description="Hide the curves that were drawn, in renders too", default=True
    )
    count: IntProperty(name="Crossings", description="Number of crossings found", options={"HIDDEN", "SKIP_SAVE"})

    def act(self, context: bpy.types.Context) -> None:
        """Lift the drawing and add it as a new object."""
        drawn = selected_curves(context)
        self.check_lengths()
        # the drawing in world space; open splines, such as strokes, are closed by their chords
        curve = Curve.from_components(read_link(drawn)[0].components)
        plane = DrawingPlane.of(curve)
        drawing = Drawing.of(plane.flattened(curve))
        self.count = len(drawing.crossings)
        lifted = drawing.lifted([k + 1 for k in range(min(self.count, _SWITCHES)) if self.change[k]])
        height = -self.height if self.mirror else self.height
        lifted = lifted.with_vertices(lifted.vertices * [1.0, 1.0, height])
        middle = self.add(context, plane, lifted, self.count)
        if self.number:
            places = np.column_stack([drawing.crossings, np.zeros(self.count)])
            size = 0.03 * float(np.ptp(lifted.vertices))
            for number, place in enumerate(plane.raised(places) - middle, 1):
                empty = bpy.data.objects.new(str(number), None)
                empty.empty_display_size, empty.show_name, empty.show_in_front = size, True, True
                empty.parent, empty.location = context.object, place
                context.collection.objects.link(empty)
        for obj in drawn if self.hide_drawing else ():
            obj.hide_set(True)
            obj.hide_render = True

    def own(self) -> Sequence[str]:
        return "mirror", "height", "number", "hide_drawing"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.label(text=iface_("Change Crossings (1 to {count})", count=min(self.count, _SWITCHES)))
        grid = layout.grid_flow(row_major=True, columns=8, even_columns=True, align=True)
        for k in range(min(self.count, _SWITCHES)):
            grid.prop(self, "change", index=k, text=str(k + 1), toggle=True)
        AddsKnot.draw(self, context)


def described(curve: Curve, crossings: int) -> tuple[str, Message]:
    """A name for a drawn knot, and a description of it."""
    found = knot_type(curve)
    said = Message("{count} crossings", count=crossings) if crossings != 1 else Message("1 crossing")
    if found.proved and found.names == ("0_1",):
        return "Drawn Unknot", Message("{crossings}: it is not knotted", crossings=said)
    if not found.names:
        return "Drawn Knot", said
    known = Message("one of {knots}", knots=", ".join(found.names)) if len(found.names) > 1 else found.names[0]
    name = "Drawn Knot" if len(found.names) > 1 else f"Drawn {found.names[0]}"
    sentence = "{crossings}: {knots}, proved" if found.proved else "{crossings}: perhaps {knots}, not proved"
    return name, Message(sentence, crossings=said, knots=known)


_PLANE = "mobius_flow_plane"  # custom property of drawn curves: origin and axes of the plane, in their coordinates
_SHORTEST, _STEP = 60.0, 4.0  # of a stroke, and from one of its points to the next, in pixels
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
            if found := _crossing(context, mouse):
                drawing, plane, number = found
                lifted, count = drawing.lifted([number]), len(drawing.crossings)
                name, said = described(lifted, count)
                obj, old = context.object, context.object.data
                obj.data = self.curve_data(name, plane.raised(lifted.vertices), lifted)
                obj.data[_PLANE], obj.name = list(old[_PLANE]), name
                bpy.data.curves.remove(old)
                self.report({"INFO"}, rpt_(said))
                return {"FINISHED"}
        except MobiusFlowError as error:
            return self.fail(error)
        self._stroke, self._said, self._naming = [mouse], "", ThreadPoolExecutor(1)
        self._answer = self._naming.submit(_name, [mouse])
        self._timer = context.window_manager.event_timer_add(0.1, window=context.window)  # to name the stroke
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
            if self._answer.done():  # what it would be if it ended now; drawing never waits
                self._said, self._answer = self._answer.result(), self._naming.submit(_name, list(self._stroke))
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
        self._naming.shutdown(wait=False)
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
        if self._said:
            overlay.label(iface_(self._said), self._stroke[-1])


def _name(stroke: Sequence[FloatArray]) -> str:
    """What a stroke would be if it ended now; nothing where it is too short, or touches itself for a moment."""
    if _length(stroke) >= _SHORTEST:
        with contextlib.suppress(MobiusFlowError):
            drawing = Drawing.of(Curve(_even(stroke)))
            count = len(drawing.crossings)
            return described(drawing.lifted(), count)[1] if count <= 16 else Message("{count} crossings", count=count)
    return ""


def _crossing(context: bpy.types.Context, mouse: FloatArray) -> tuple[Drawing, DrawingPlane, int] | None:
    """The active object's drawing, if it has one and was not relaxed, and which crossing is under the mouse, from 1."""
    obj = context.object
    if obj is None or obj.type != "CURVE" or _PLANE not in obj.data or obj.data.shape_keys is not None:
        return None
    values, curve = np.array(obj.data[_PLANE]), Curve.from_components(Strands.of(obj).components)
    plane = DrawingPlane(values[:3], values[3:].reshape(3, 3))
    drawing = Drawing.seen(curve.with_vertices((curve.vertices - plane.origin) @ plane.axes.T))
    places = plane.raised(np.column_stack([drawing.crossings, np.zeros(len(drawing.crossings))]))
    there, _, in_front = projected(context.region, Placement.from_matrix(obj.matrix_world).to_world(places))
    near = in_front & (np.linalg.norm(mouse - there, axis=1) < 15.0 * context.preferences.system.ui_scale)
    return (drawing, plane, int(near.argmax()) + 1) if near.any() else None


def _length(stroke: Sequence[FloatArray]) -> float:
    return float(arc_lengths(np.array(stroke))[-1])


def _even(stroke: Sequence[FloatArray]) -> FloatArray:
    """A stroke, closed, with points at equal distances and smooth; shape (n, 2).

    It goes along the spline through the stroke's points, if strands cross there as they do on the polygon.
    """
    closed = np.array([*stroke, stroke[0]])
    arc = arc_lengths(closed)
    corners = np.stack([np.interp(np.arange(0.0, arc[-1], 2 * _STEP), arc, x) for x in closed.T], axis=1)
    polygon = averaged(Curve(corners), 6)  # passes that take the hand's trembling out
    apart = closed[:-1][np.diff(arc) > 0.0]
    with contextlib.suppress(MobiusFlowError):  # it touches itself, or has too few points
        smooth = averaged(smoothed(Curve(apart), Mesh((len(corners),))), 6)
        if _crossings(smooth) == _crossings(polygon):
            return smooth
    return polygon


def _crossings(points: FloatArray) -> list[int]:
    """The crossings of a closed plane polygon, numbered as they are first reached, in the order of its points."""
    return list((np.argsort(Drawing.of(Curve(points)).passes, axis=None) // 2).tolist())
