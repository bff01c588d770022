"""Points that stay where they are while their curve is relaxed: pinned, and let go."""

from collections.abc import Iterator

import bpy
import numpy as np

from ...core import MobiusFlowError
from ...core.messages import Message
from ...core.types import BoolArray
from ..curves import bake, pins
from ..engine.words import named
from ..live.checks import curves_at_hand, unpinnable
from ..live.refusal import Refusal
from ..translations import rpt_
from .refusing import Refusing


class _Pinning(Refusing):
    """What operators that pin points have in common."""

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """Curves must be there, and be this file's own."""
        return unpinnable(context)

    def chosen(self, context: bpy.types.Context) -> Iterator[tuple[bpy.types.Object, int, BoolArray]]:
        """Yield curve objects, numbers of their splines, and the points of these that are meant."""
        for obj in curves_at_hand(context):
            for number, spline in enumerate(obj.data.splines):
                yield obj, number, self.points(spline)

    @staticmethod
    def points(spline: bpy.types.Spline) -> BoolArray:
        """The points of a spline that are meant."""
        raise NotImplementedError

    def act(self, context: bpy.types.Context) -> None:
        """Pin the points, if all of them can be."""
        chosen = [each for each in self.chosen(context) if each[2].any()]
        if not chosen:
            raise MobiusFlowError(self.nothing)
        for each in chosen:
            pins.check_place(*each)
        for obj, number, points in chosen:
            pins.pin(obj.data.splines[number], points)
        self._tell(context)

    def _tell(self, context: bpy.types.Context) -> None:
        objects = curves_at_hand(context)
        told = Message("Points that are pinned: {count}", count=sum(pins.count(obj.data) for obj in objects))
        if baked := [obj.name for obj in objects if bake.is_baked(obj.data)]:
            sentence = "{pinned}; Continue minds that, Bake Again begins with {names} as pinned before"
            told = Message(sentence, pinned=told, names=named(baked))
        self.report({"INFO"}, rpt_(told))


class CURVE_OT_mobius_flow_pin(_Pinning, bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
    """Pin the selected points: they stay exactly where they are while the curve is relaxed"""

    bl_idname = "curve.mobius_flow_pin"
    bl_label = "Pin Selected Points"
    nothing = Message("No points are selected; select some to pin")
    points = staticmethod(pins.selected)

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """Points are selected in Edit Mode."""
        if context.mode != "EDIT_CURVE":
            return Refusal(Message("Go to Edit Mode and select the points to pin"))
        return super().refusal(context)


class CURVE_OT_mobius_flow_pin_ends(_Pinning, bpy.types.Operator):  # noqa: N801
    """Pin both ends of every open spline of the selected curves, so that no knot slips off"""

    bl_idname = "curve.mobius_flow_pin_ends"
    bl_label = "Pin Ends"
    nothing = Message("All splines are closed and have no ends; select an open one")
    points = staticmethod(pins.ends)


class CURVE_OT_mobius_flow_unpin(_Pinning, bpy.types.Operator):  # noqa: N801
    """Let pinned points move again: the selected ones in Edit Mode, and all of the selected curves in Object Mode"""

    bl_idname = "curve.mobius_flow_unpin"
    bl_label = "Unpin"

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """Some must be pinned."""
        if refused := super().refusal(context):
            return refused
        if any(pins.count(obj.data) for obj in curves_at_hand(context)):
            return None
        return Refusal(Message("No points of the selected curves are pinned"))

    def act(self, context: bpy.types.Context) -> None:
        """Let them go."""
        chosen = pins.selected if context.mode == "EDIT_CURVE" else _all
        for obj in curves_at_hand(context):
            for spline in obj.data.splines:
                pins.unpin(spline, chosen(spline))
        self._tell(context)


def _all(spline: bpy.types.Spline) -> BoolArray:
    return np.ones(len(pins.marked(spline)), dtype=bool)


CLASSES = (CURVE_OT_mobius_flow_pin, CURVE_OT_mobius_flow_pin_ends, CURVE_OT_mobius_flow_unpin)
