"""Operators for how curves look: their size while they move, how they lie, the tubes around them, and on paper."""

from pathlib import Path

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty

from ...core.base import Message, MobiusFlowError, write_file
from ...core.driver.words import named
from ...core.keys.arcs import seen
from ...core.keys.figure import Pen, figure
from ...core.keys.paper import PAPERS
from ...core.keys.placement import Measure
from ..curves import bake, pins, recorded, surroundings
from ..curves.bevel import fit_tubes
from ..live.requirements import CLEARABLE, FITTABLE, PAINTABLE, PINNABLE, READABLE, RELAXABLE, UNEDITED, Condition, idle
from ..live.selection import avoided, curves_at_hand, selected_curves
from ..pictures.materials import colour_components
from ..properties import MEASURE_ITEMS
from ..translations import rpt_
from .button import Button, button

_KEPT = {
    Measure.LENGTH: Message("The length"),
    Measure.BOX: Message("The bounding box"),
    Measure.RADIUS: Message("The radius"),
}
_CAMERA = Condition("The scene has no camera; add one first", lambda context: context.scene.camera is None)


class CURVE_OT_mobius_flow_keep_size(Button, bpy.types.Operator):
    """Scale the selected curves at each of their keys, so that their size stays while they move"""

    bl_label = "Keep Size"
    needs = (CLEARABLE,)
    needs_at_last = (UNEDITED,)

    measure: EnumProperty(name="Keep", description="What stays", items=MEASURE_ITEMS, default=Measure.BOX.name)
    reference: EnumProperty(
        name="Size Of",
        description="Key whose size all others are given",
        items=[("FIRST", "First Key", "As large as at the beginning"), ("LAST", "Last Key", "As large as at the end")],
        default="FIRST",
    )

    def act(self, context: bpy.types.Context) -> None:
        objects, measure = selected_curves(context), Measure[self.measure]
        keys = recorded.keep_size(objects, measure, 0 if self.reference == "FIRST" else -1)
        kept = "{measure} of {names} stays at all {count} keys"
        names = named([obj.name for obj in objects])
        _report(self, Message(kept, measure=_KEPT[measure], names=names, count=len(keys.frames)), keys.unproved)


@button("Lay Flat", RELAXABLE)
def lay_flat(operator: Button, context: bpy.types.Context) -> None:
    """Turn the selected curves so that they lie flat: the shape at the end of their animation extends least upwards"""
    if unproved := recorded.turn(selected_curves(context)):
        _report(operator, Message("The curves were turned"), unproved)


@button("Face Camera", RELAXABLE, _CAMERA)
def face_camera(operator: Button, context: bpy.types.Context) -> None:
    """Turn the selected curves so that the scene's camera sees their widest side"""
    if unproved := recorded.turn(selected_curves(context), context.scene.camera):
        _report(operator, Message("The curves were turned"), unproved)


def _report(operator: Button, what: Message, unproved: int) -> None:
    """Report what was done, and whether the animation is still proved."""
    if unproved:
        one = "{done}; 1 motion between keys is NOT proved free of contact"
        several = "{done}; {count} motions between keys are NOT proved free of contact"
        operator.report({"WARNING"}, rpt_(one if unproved == 1 else several, done=what, count=unproved))
    else:
        operator.report({"INFO"}, rpt_("{done}, proved free of contact", done=what))


class CURVE_OT_mobius_flow_fit_tube(Button, bpy.types.Operator):
    """Draw the selected curves as the ropes that they were relaxed as, or as the thickest round tubes that do not \
touch. Relaxing keeps them so until you change their bevel"""

    bl_label = "Fit Tube"
    needs = (FITTABLE,)

    constant: BoolProperty(
        name="Constant Thickness",
        description="Draw tubes as thick throughout the animation as fits where there is least room, instead of as "
        "thick as fits at each moment",
    )

    def act(self, context: bpy.types.Context) -> None:
        fit_tubes(selected_curves(context), self.constant)


class CURVE_OT_mobius_flow_draw_diagram(Button, bpy.types.Operator):
    """Draw the selected curves as knots are drawn on paper, from where the fewest strands cross, \
as they are at the end of their animation"""

    bl_label = "Draw Diagram"
    bl_options = {"REGISTER"}
    needs = (READABLE,)

    filepath: StringProperty(name="File", description="Where the drawing goes: SVG, PDF or, with .tex, TikZ")
    arrows: BoolProperty(name="Arrows", description="Show the directions of the curves")
    numbers: BoolProperty(name="Numbers", description="Number the crossings")

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        self.filepath = self.filepath or f"{context.object.name}.svg"
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def act(self, context: bpy.types.Context) -> None:
        path = Path(bpy.path.abspath(self.filepath))
        if (paper := PAPERS.get(path.suffix.lower())) is None:
            raise MobiusFlowError(
                Message("Drawings are .svg, .pdf or .tex; give '{name}' one of these", name=path.name)
            )
        objects = selected_curves(context)
        shapes = [recorded.Recorded.of(obj) for obj in objects]
        link = recorded.in_world(objects, shapes, [each.points[-1] for each in shapes])
        write_file(path, paper(figure(seen([link]), pen=Pen(arrows=self.arrows, numbers=self.numbers))))
        self.report({"INFO"}, rpt_("Drawn: {path}", path=path))


@button("Color Components", PAINTABLE)
def color_components(_operator: Button, context: bpy.types.Context) -> None:
    """Give each spline of the selected objects a material of its own, in slots after those that are there"""
    first = 0
    for obj in selected_curves(context):  # components are numbered across all objects
        colour_components(obj.data, first)
        first += len(obj.data.splines)


def _near(context: bpy.types.Context) -> list[bpy.types.Object]:
    return surroundings.near(context, selected_curves(context), avoided(context))


_PINNED = Condition(
    "No points of the selected curves are pinned",
    lambda context: not any(pins.count(obj.data) for obj in curves_at_hand(context)),
)
_NEARBY = Condition("Nothing near the selected curves is left to avoid", lambda context: not _near(context))


@button("Pin", PINNABLE)
def pin(operator: Button, context: bpy.types.Context) -> None:
    """Pin the selected points in Edit Mode, and the ends of open splines in Object Mode: they stay exactly where they \
are while the curve is relaxed"""
    edited = context.mode == "EDIT_CURVE"
    curves = curves_at_hand(context)
    splines = [(obj, number, spline) for obj in curves for number, spline in enumerate(obj.data.splines)]
    wanted = pins.selected if edited else pins.ends
    chosen = [(*each, points) for *each, spline in splines if (points := wanted(spline)).any()]
    if not chosen:
        closed = "All splines are closed and have no ends; go to Edit Mode and select the points to pin"
        raise MobiusFlowError(Message("No points are selected; select some to pin" if edited else closed))
    for each in chosen:
        pins.check_place(*each)
    for obj, number, points in chosen:
        pins.pin(obj.data.splines[number], points)
    _report_count(operator, context)


@button("Unpin", PINNABLE, _PINNED)
def unpin(operator: Button, context: bpy.types.Context) -> None:
    """Let pinned points move again: the selected ones in Edit Mode, and all of the selected curves in Object Mode"""
    for obj in curves_at_hand(context):
        for spline in obj.data.splines:
            pins.unpin(spline, pins.selected(spline) if context.mode == "EDIT_CURVE" else pins.marked(spline))
    _report_count(operator, context)


def _report_count(operator: Button, context: bpy.types.Context) -> None:
    objects = curves_at_hand(context)
    said = Message("Pinned points: {count}", count=sum(pins.count(obj.data) for obj in objects))
    if baked := [obj.name for obj in objects if bake.is_baked(obj.data)]:
        sentence = "{pinned}; Continue keeps them, Bake Again starts from {names} as pinned before"
        said = Message(sentence, pinned=said, names=named(baked))
    operator.report({"INFO"}, rpt_(said))


@button("Add to Avoid", idle, _NEARBY)
def avoid(operator: Button, context: bpy.types.Context) -> None:
    """Let relaxed curves never touch what is near them now: put it into the collection Avoid, besides those it is in"""
    found = _near(context)
    collection = surroundings.add(context.scene, found)
    names = named([obj.name for obj in found])
    operator.report({"INFO"}, rpt_("'{collection}' has {names} now", collection=collection.name, names=names))
