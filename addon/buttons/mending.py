"""Buttons that remedy refusals: each removes one obstacle from all selected curves for which it is the next."""

from collections.abc import Callable, Iterable

import bpy

from ...core import MobiusFlowError
from ...core.messages import Message
from ..curves import remedies
from ..live.checks import needing
from ..live.requirements import Refusal, Remedy, convertible, idle, selected_curves
from .button import Button


class _Mending(Button):
    mend: Callable[[bpy.types.Object], object]  # raises MobiusFlowError for what it cannot mend

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        return idle() or (None if any(cls.concerned(context)) else Refusal(Message("Nothing selected needs that")))

    @classmethod
    def concerned(cls, context: bpy.types.Context) -> Iterable[bpy.types.Object]:
        """The objects that need it, examined one by one, as mending one may mend others."""
        return needing(selected_curves(context), Remedy(cls.bl_idname))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Mend them all; failures are reported, and leave their objects as they were."""
        results = {"CANCELLED"}
        for obj in self.concerned(context):
            try:
                self.mend(obj)
            except MobiusFlowError as error:
                self.fail(error)
            else:
                results = {"FINISHED"}
        return results


class CURVE_OT_mobius_flow_object_mode(_Mending, bpy.types.Operator):
    """Leave Edit Mode; what was edited is kept"""

    bl_label = "Back to Object Mode"

    @staticmethod
    def mend(_obj: bpy.types.Object) -> object:
        return bpy.ops.object.mode_set(mode="OBJECT")  # of all objects that are edited together


class CURVE_OT_mobius_flow_make_local(_Mending, bpy.types.Operator):
    """Make the selected curves of other files this file's own; their materials stay linked"""

    bl_label = "Make Local"
    mend = staticmethod(remedies.make_local)


class CURVE_OT_mobius_flow_single_user(_Mending, bpy.types.Operator):
    """Give each of the selected objects curve data of its own; other objects keep what they share"""

    bl_label = "Make Single User"
    mend = staticmethod(remedies.make_single_user)


class CURVE_OT_mobius_flow_make_3d(_Mending, bpy.types.Operator):
    """Let the points of the selected curves leave the plane"""

    bl_label = "Make 3D"
    mend = staticmethod(remedies.make_3d)


class CURVE_OT_mobius_flow_to_poly(_Mending, bpy.types.Operator):
    """Replace Bézier and NURBS splines of the selected curves by the polygons drawn for them"""

    bl_label = "Convert to Poly"
    mend = staticmethod(remedies.to_poly)


class CURVE_OT_mobius_flow_copy(_Mending, bpy.types.Operator):
    """Copy curves as they are shown now, without keys, modifiers that move points, and all else that moves them"""

    bl_label = "Make Still Copy"
    mend = staticmethod(remedies.still_copy)

    @classmethod
    def concerned(cls, context: bpy.types.Context) -> Iterable[bpy.types.Object]:
        """The selected curves that need it, or all of them if none does: a copy never does harm."""
        objects = selected_curves(context) if context.mode == "OBJECT" else []
        return list(super().concerned(context)) or objects


class CURVE_OT_mobius_flow_to_curve(_Mending, bpy.types.Operator):
    """Make curves of the selected texts, and of meshes that are edges without faces; these stay as they are"""

    bl_label = "Convert to Curve"
    mend = staticmethod(remedies.to_curve)

    @classmethod
    def concerned(cls, context: bpy.types.Context) -> Iterable[bpy.types.Object]:
        """Texts and meshes, where no curve is selected."""
        return convertible(context) if context.mode == "OBJECT" and not selected_curves(context) else ()

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Convert them; all curves are selected afterwards, in place of what they were made of."""
        before = set(context.view_layer.objects)
        super().execute(context)
        for obj in set(context.view_layer.objects) - before:
            obj.select_set(True)
        return {"FINISHED"}
