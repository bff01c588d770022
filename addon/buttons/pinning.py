"""Operators that hold curves in place: they pin points, close ends, and let curves avoid objects."""

import bpy

from ...core import MobiusFlowError
from ...core.messages import Message
from ..curves import bake, pins, remedies, surroundings
from ..engine.words import named
from ..live.checks import PINNABLE, closable
from ..live.requirements import Condition, avoided, curves_at_hand, idle, selected_curves
from ..translations import rpt_
from .button import Button, button


def _near(context: bpy.types.Context) -> list[bpy.types.Object]:
    return surroundings.near(context, selected_curves(context), avoided(context))


_EDITED = Condition("Go to Edit Mode and select the points to pin", lambda context: context.mode != "EDIT_CURVE")
_PINNED = Condition(
    "No points of the selected curves are pinned",
    lambda context: not any(pins.count(obj.data) for obj in curves_at_hand(context)),
)
_OPEN = Condition(
    "No selected curve has an open spline without keys; select one in Object Mode",
    lambda context: not any(closable(selected_curves(context))),
)
_NEARBY = Condition("Nothing near the selected curves is left to avoid", lambda context: not _near(context))


class _Pinning(Button):
    """The base of operators that pin points; ``points`` selects the points of a spline to pin."""

    def act(self, context: bpy.types.Context) -> None:
        """Pin the points, if all of them can be."""
        curves = curves_at_hand(context)
        splines = [(obj, number, spline) for obj in curves for number, spline in enumerate(obj.data.splines)]
        chosen = [(*each, points) for *each, spline in splines if (points := self.points(spline)).any()]
        if not chosen:
            raise MobiusFlowError(self.nothing)
        for each in chosen:
            pins.check_place(*each)
        for obj, number, points in chosen:
            pins.pin(obj.data.splines[number], points)
        _report_count(self, context)


class CURVE_OT_mobius_flow_pin(_Pinning, bpy.types.Operator):
    """Pin the selected points: they stay exactly where they are while the curve is relaxed"""

    bl_label = "Pin Selected Points"
    needs = (_EDITED, PINNABLE)
    nothing = Message("No points are selected; select some to pin")
    points = staticmethod(pins.selected)


class CURVE_OT_mobius_flow_pin_ends(_Pinning, bpy.types.Operator):
    """Pin both ends of every open spline of the selected curves, so that no knot slips off"""

    bl_label = "Pin Ends"
    needs = (PINNABLE,)
    nothing = Message("All splines are closed and have no ends; select an open one")
    points = staticmethod(pins.ends)


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


@button("Close Splines", idle, _OPEN)
def close(_operator: Button, context: bpy.types.Context) -> None:
    """Join the two ends of every open spline of the selected curves"""
    for obj in closable(selected_curves(context)):
        remedies.close(obj)


@button("Add to Avoid", idle, _NEARBY)
def avoid(operator: Button, context: bpy.types.Context) -> None:
    """Let relaxed curves never touch what is near them now: put it into the collection Avoid, besides those it is in"""
    found = _near(context)
    collection = surroundings.add(context.scene, found)
    names = named([obj.name for obj in found])
    operator.report({"INFO"}, rpt_("'{collection}' has {names} now", collection=collection.name, names=names))
