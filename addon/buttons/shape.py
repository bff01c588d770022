"""What can be done with the shape of a relaxed curve: its size, its attitude, its balance; minimum or saddle."""

from contextlib import suppress
from typing import Any

import bpy
from bpy.props import EnumProperty

from ...core import MobiusFlowError
from ..curves.baked_keys import BakedKeys
from ..curves.resized import keep_size
from ..curves.turned import face_camera, lay_flat
from ..engine.phrase import Phrase
from ..engine.rest import Rest
from ..engine.size import Measure
from ..engine.words import named
from ..live.checks import edited, refusal, selected_curves, unclearable
from ..live.modal import redraw_views
from ..live.refusal import Refusal
from ..properties import SETTINGS, measure_items, relax_options
from ..translations import rpt_
from .baking import Rebaking
from .refusing import Refusing

_KEPT = {
    Measure.LENGTH: Phrase("The length"),
    Measure.BOX: Phrase("The bounding box"),
    Measure.RADIUS: Phrase("The radius"),
}


class CURVE_OT_mobius_flow_keep_size(Refusing, bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
    """Scale the selected curves at each of their keys, so that their size stays while they move"""

    bl_idname = "curve.mobius_flow_keep_size"
    bl_label = "Keep Size"

    measure: EnumProperty(name="Keep", description="What stays", items=measure_items(), default=Measure.BOX.name)
    reference: EnumProperty(
        name="Size Of",
        description="Which key has the size that all are given",
        items=[("FIRST", "First Key", "As large as at the beginning"), ("LAST", "Last Key", "As large as at the end")],
        default="FIRST",
    )

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """Baked curves are wanted."""
        return unclearable(context)

    def last_refusal(self, context: bpy.types.Context) -> Refusal | None:
        """Nobody has edited their keys."""
        return edited(context)

    def act(self, context: bpy.types.Context) -> None:
        """Scale all keys."""
        objects = selected_curves(context)
        keys = keep_size(objects, Measure[self.measure], {"FIRST": 0, "LAST": -1}[self.reference])
        redraw_views(context.window_manager)  # which they are not by themselves
        kept = "{measure} of {names} stays at all {count} keys"
        names = named([obj.name for obj in objects])
        said = Phrase(kept, measure=_KEPT[Measure[self.measure]], names=names, count=len(keys.frames))
        _tell(self, said, keys.unproved)


class _Turning(Refusing):
    """What operators that turn curves have in common."""

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """What cannot be relaxed cannot be turned."""
        return refusal(context)

    def act(self, context: bpy.types.Context) -> None:
        """Turn them."""
        unproved = self.turn(context)
        redraw_views(context.window_manager)
        if unproved:
            _tell(self, Phrase("The curves were turned"), unproved)

    def turn(self, context: bpy.types.Context) -> int:
        """Turn the selected curves, and count the motions that are not proved any more."""
        raise NotImplementedError


class CURVE_OT_mobius_flow_lay_flat(_Turning, bpy.types.Operator):  # noqa: N801
    """Turn the selected curves so that they lie flat: the shape at the end of their animation extends least upwards"""

    bl_idname = "curve.mobius_flow_lay_flat"
    bl_label = "Lay Flat"

    def turn(self, context: bpy.types.Context) -> int:
        """Lay them flat."""
        return lay_flat(selected_curves(context))


class CURVE_OT_mobius_flow_face_camera(_Turning, bpy.types.Operator):  # noqa: N801
    """Turn the selected curves so that the scene's camera sees their widest side"""

    bl_idname = "curve.mobius_flow_face_camera"
    bl_label = "Face Camera"

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """There must be a camera."""
        missing = None if context.scene.camera else Refusal(Phrase("The scene has no camera; add one first"))
        return refusal(context) or missing

    def turn(self, context: bpy.types.Context) -> int:
        """Turn them to the camera."""
        return face_camera(selected_curves(context), context.scene.camera)


class CURVE_OT_mobius_flow_balance(Rebaking, bpy.types.Operator):  # noqa: N801
    """Go on to the shape of the same energy that bends least for its length; new keys follow the old ones"""

    bl_idname = "curve.mobius_flow_balance"
    bl_label = "Balance"
    continues = True

    def values(self, context: bpy.types.Context) -> dict[str, Any]:
        """The settings, with balance."""
        return super().values(context) | {"balance": True}


class CURVE_OT_mobius_flow_check(Refusing, bpy.types.Operator):  # noqa: N801
    """Tell whether the selected curves have come to rest at a minimum of the energy or at a saddle; nothing changes"""

    bl_idname = "curve.mobius_flow_check"
    bl_label = "Check"
    bl_options = {"REGISTER"}  # noqa: RUF012 - read by Blender

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """Baked curves are wanted."""
        return Rebaking.refusal(context)

    def last_refusal(self, context: bpy.types.Context) -> Refusal | None:
        """Nobody has edited their keys."""
        return edited(context)

    def act(self, context: bpy.types.Context) -> None:
        """Look at the end of the animation."""
        values = {name: getattr(context.scene.mobius_flow, name) for name in SETTINGS}
        self.report({"INFO"}, rpt_(_rest(context, values)[1]))


class CURVE_OT_mobius_flow_leave_saddle(Rebaking, bpy.types.Operator):  # noqa: N801
    """Go on downhill where the selected curves rest on a saddle of the energy; new keys follow the old ones"""

    bl_idname = "curve.mobius_flow_leave_saddle"
    bl_label = "Leave Saddle"
    continues = True

    def values(self, context: bpy.types.Context) -> dict[str, Any]:
        """The settings, with the way off saddles."""
        return super().values(context) | {"escape_saddles": True}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do the whole job, if there is anything to leave."""
        return {"CANCELLED"} if self._rests(context) else super().execute(context)

    def begin(self, context: bpy.types.Context, values: dict[str, Any]) -> set[str]:
        """Start the run, if there is anything to leave."""
        return {"CANCELLED"} if self._rests(context) else super().begin(context, values)

    def _rests(self, context: bpy.types.Context) -> bool:
        """Say so if the curves are at a minimum already; what else is wrong the relaxation tells."""
        with suppress(MobiusFlowError):
            index, words = _rest(context, self.values(context))
            if index == 0:
                self.report({"INFO"}, rpt_(words))
                return True
        return False


def _rest(context: bpy.types.Context, values: dict[str, Any]) -> tuple[int | None, Phrase]:
    """Number of ways down from where the selected curves rest, and a sentence; raises MobiusFlowError."""
    context.view_layer.update()
    objects = selected_curves(context)
    rest = Rest.of(BakedKeys(objects).curves[-1], relax_options(values))
    return rest.index, Phrase("{names}: {rest}", names=named([obj.name for obj in objects]), rest=rest.words)


def _tell(operator: bpy.types.Operator, what: Phrase, unproved: int) -> None:
    """Say what was done, and whether the animation is proved still."""
    if unproved:
        sentence = "{done}; {count} motions between keys are NOT proved free of contact"
        operator.report({"WARNING"}, rpt_(sentence, done=what, count=unproved))
    else:
        operator.report({"INFO"}, rpt_("{done}, proved free of contact", done=what))


CLASSES = (
    CURVE_OT_mobius_flow_keep_size,
    CURVE_OT_mobius_flow_lay_flat,
    CURVE_OT_mobius_flow_face_camera,
    CURVE_OT_mobius_flow_balance,
    CURVE_OT_mobius_flow_check,
    CURVE_OT_mobius_flow_leave_saddle,
)
