"""The size of baked curves while they move, and how they lie."""

import bpy
from bpy.props import EnumProperty

from ...core.messages import Message
from ..curves.resized import keep_size
from ..curves.turned import face_camera, lay_flat
from ..engine.size import Measure
from ..engine.words import named
from ..live.checks import edited, refusal, selected_curves, unclearable
from ..live.refusal import Refusal
from ..properties import measure_items
from ..translations import rpt_
from .refusing import Refusing

_KEYS = {"FIRST": 0, "LAST": -1}
_KEPT = {
    Measure.LENGTH: Message("The length"),
    Measure.BOX: Message("The bounding box"),
    Measure.RADIUS: Message("The radius"),
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
        objects, measure = selected_curves(context), Measure[self.measure]
        keys = keep_size(objects, measure, _KEYS[self.reference])
        kept = "{measure} of {names} stays at all {count} keys"
        names = named([obj.name for obj in objects])
        _tell(self, Message(kept, measure=_KEPT[measure], names=names, count=len(keys.frames)), keys.unproved)


class _Turning(Refusing):
    """What operators that turn curves have in common."""

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """What cannot be relaxed cannot be turned."""
        return refusal(context)

    def act(self, context: bpy.types.Context) -> None:
        """Turn them."""
        if unproved := self.turn(context):
            _tell(self, Message("The curves were turned"), unproved)

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
        missing = None if context.scene.camera else Refusal(Message("The scene has no camera; add one first"))
        return refusal(context) or missing

    def turn(self, context: bpy.types.Context) -> int:
        """Turn them to the camera."""
        return face_camera(selected_curves(context), context.scene.camera)


def _tell(operator: bpy.types.Operator, what: Message, unproved: int) -> None:
    """Say what was done, and whether the animation is proved still."""
    if unproved:
        one, several = (
            "{done}; 1 motion between keys is NOT proved free of contact",
            "{done}; {count} motions between keys are NOT proved free of contact",
        )
        operator.report({"WARNING"}, rpt_(one if unproved == 1 else several, done=what, count=unproved))
    else:
        operator.report({"INFO"}, rpt_("{done}, proved free of contact", done=what))


CLASSES = (CURVE_OT_mobius_flow_keep_size, CURVE_OT_mobius_flow_lay_flat, CURVE_OT_mobius_flow_face_camera)
