"""Buttons that remedy refusals: each removes one obstacle from all selected curves for which it is the next."""

from collections.abc import Iterable

import bpy

from ...core import MobiusFlowError
from ...core.messages import Message
from ..curves import remedies
from ..live.checks import needing
from ..live.requirements import Refusal, Remedy, convertible, idle, selected_curves
from .button import Button, button


class _Mending(Button):
    """`act` mends one object; it raises a MobiusFlowError for what it cannot mend."""

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        return idle() or (None if any(cls.concerned(context)) else Refusal(Message("Nothing selected needs that")))

    @classmethod
    def concerned(cls, context: bpy.types.Context) -> Iterable[bpy.types.Object]:
        """The objects that need mending, examined one by one, because mending one may mend others."""
        return needing(selected_curves(context), Remedy(cls.bl_idname))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Mend them all; failures are reported, and leave their objects as they were."""
        results = {"CANCELLED"}
        for obj in self.concerned(context):
            try:
                self.act(obj)
            except MobiusFlowError as error:
                self.fail(error)
            else:
                results = {"FINISHED"}
        return results


@button("Back to Object Mode", base=_Mending)
def object_mode(_operator: Button, _obj: bpy.types.Object) -> None:
    """Leave Edit Mode; what was edited is kept"""
    bpy.ops.object.mode_set(mode="OBJECT")  # of all objects that are edited together


@button("Make Local", base=_Mending)
def make_local(_operator: Button, obj: bpy.types.Object) -> None:
    """Make the selected curves of other files this file's own; their materials stay linked"""
    remedies.make_local(obj)


@button("Make Single User", base=_Mending)
def single_user(_operator: Button, obj: bpy.types.Object) -> None:
    """Give each of the selected objects curve data of its own; other objects keep what they share"""
    obj.data = obj.data.copy()


@button("Make 3D", base=_Mending)
def make_3d(_operator: Button, obj: bpy.types.Object) -> None:
    """Let the points of the selected curves leave the plane"""
    obj.data.dimensions = "3D"


@button("Convert to Poly", base=_Mending)
def to_poly(_operator: Button, obj: bpy.types.Object) -> None:
    """Replace Bézier and NURBS splines of the selected curves by the polygons drawn for them"""
    remedies.to_poly(obj)


class CURVE_OT_mobius_flow_copy(_Mending, bpy.types.Operator):
    """Copy curves as they are shown now, without keys, modifiers that move points, and all else that moves them"""

    bl_label = "Make Still Copy"

    def act(self, obj: bpy.types.Object) -> None:
        remedies.still_copy(obj)

    @classmethod
    def concerned(cls, context: bpy.types.Context) -> Iterable[bpy.types.Object]:
        """The selected curves that need it, or all of them if none does: a copy never does harm."""
        objects = selected_curves(context) if context.mode == "OBJECT" else []
        return list(super().concerned(context)) or objects


class CURVE_OT_mobius_flow_to_curve(_Mending, bpy.types.Operator):
    """Make curves of the selected texts, and of meshes that are edges without faces; these stay as they are"""

    bl_label = "Convert to Curve"

    def act(self, obj: bpy.types.Object) -> None:
        remedies.to_curve(obj)

    @classmethod
    def concerned(cls, context: bpy.types.Context) -> Iterable[bpy.types.Object]:
        """Texts and meshes, where no curve is selected."""
        return convertible(context) if context.mode == "OBJECT" and not selected_curves(context) else ()

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Convert them; all curves are selected afterwards, in place of their sources."""
        before = set(context.view_layer.objects)
        super().execute(context)
        for obj in set(context.view_layer.objects) - before:
            obj.select_set(True)
        return {"FINISHED"}
