"""Operators for how curves look: their size while they move, how they lie, and the tubes around them."""

import bpy
from bpy.props import EnumProperty

from ...core.messages import Message
from ..curves import baked_keys
from ..curves.baked_keys import keep_size
from ..curves.bevel import fit_tubes
from ..engine.size import Measure
from ..engine.words import named
from ..live.checks import CLEARABLE, FITTABLE, PAINTABLE, RELAXABLE, UNEDITED
from ..live.requirements import Condition, selected_curves
from ..pictures.materials import colour_components
from ..properties import MEASURE_ITEMS
from ..translations import rpt_
from .button import Button, button

_KEYS = {"FIRST": 0, "LAST": -1}
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
        keys = keep_size(objects, measure, _KEYS[self.reference])
        kept = "{measure} of {names} stays at all {count} keys"
        names = named([obj.name for obj in objects])
        _report(self, Message(kept, measure=_KEPT[measure], names=names, count=len(keys.frames)), keys.unproved)


@button("Lay Flat", RELAXABLE)
def lay_flat(operator: Button, context: bpy.types.Context) -> None:
    """Turn the selected curves so that they lie flat: the shape at the end of their animation extends least upwards"""
    _report_turn(operator, baked_keys.lay_flat(selected_curves(context)))


@button("Face Camera", RELAXABLE, _CAMERA)
def face_camera(operator: Button, context: bpy.types.Context) -> None:
    """Turn the selected curves so that the scene's camera sees their widest side"""
    _report_turn(operator, baked_keys.face_camera(selected_curves(context), context.scene.camera))


def _report_turn(operator: Button, unproved: int) -> None:
    if unproved:
        _report(operator, Message("The curves were turned"), unproved)


def _report(operator: Button, what: Message, unproved: int) -> None:
    """Report what was done, and whether the animation is still proved."""
    if unproved:
        one, several = (
            "{done}; 1 motion between keys is NOT proved free of contact",
            "{done}; {count} motions between keys are NOT proved free of contact",
        )
        operator.report({"WARNING"}, rpt_(one if unproved == 1 else several, done=what, count=unproved))
    else:
        operator.report({"INFO"}, rpt_("{done}, proved free of contact", done=what))


@button("Fit Tube", FITTABLE)
def fit_tube(_operator: Button, context: bpy.types.Context) -> None:
    """Draw the selected curves as the thickest round tubes that do not touch. Relaxing keeps them so"""
    fit_tubes(selected_curves(context))


@button("Color Components", PAINTABLE)
def color_components(_operator: Button, context: bpy.types.Context) -> None:
    """Give each spline of the selected objects a material of its own, in slots after those that are there"""
    first = 0
    for obj in selected_curves(context):  # components are numbered across all objects
        colour_components(obj.data, first)
        first += len(obj.data.splines)
