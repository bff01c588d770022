"""The size of baked curves while they move, and how they lie."""

import bpy
from bpy.props import EnumProperty

from ...core import MobiusFlowError
from ..curves.resized import keep_size
from ..curves.turned import face_camera, lay_flat
from ..engine.size import Measure
from ..engine.words import named
from ..live.checks import edited, refusal, selected_curves, unclearable
from ..properties import measure_items
from .acting import Acting

_KEYS = {"FIRST": 0, "LAST": -1}


class CURVE_OT_mobius_flow_keep_size(Acting, bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
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
    def refusal(cls, context: bpy.types.Context) -> str | None:
        """Say why there are no keys to be scaled, or return None if there are."""
        return unclearable(context)

    def act(self, context: bpy.types.Context) -> None:
        """Scale all keys."""
        if reason := edited(context):
            raise MobiusFlowError(reason)
        objects, measure = selected_curves(context), Measure[self.measure]
        keys = keep_size(objects, measure, _KEYS[self.reference])
        kept = f"The {measure.value.lower()} of {named([obj.name for obj in objects])}"
        self.tell(f"{kept} stays at all {len(keys.frames)} keys", keys.unproved)


class _Turning(Acting):
    """What operators that turn curves have in common."""

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str | None:
        """Say why the selected curves cannot be turned, or return None if they can."""
        return refusal(context)

    def act(self, context: bpy.types.Context) -> None:
        """Turn them."""
        if unproved := self.turn(context):
            self.tell("The curves were turned", unproved)

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
    def refusal(cls, context: bpy.types.Context) -> str | None:
        """Say why they cannot be turned to the camera, or return None if they can."""
        return refusal(context) or (None if context.scene.camera else "The scene has no camera; add one first")

    def turn(self, context: bpy.types.Context) -> int:
        """Turn them to the camera."""
        return face_camera(selected_curves(context), context.scene.camera)


CLASSES = (CURVE_OT_mobius_flow_keep_size, CURVE_OT_mobius_flow_lay_flat, CURVE_OT_mobius_flow_face_camera)
