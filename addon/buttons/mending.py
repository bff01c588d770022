"""Buttons for what is refused: each mends one hindrance, on all selected curves that it is the next one of."""

from collections.abc import Iterable

import bpy

from ...core import MobiusFlowError
from ...core.messages import Message
from ..curves import copying, mending
from ..live.checks import convertible, needing, running, selected_curves
from ..live.refusal import Remedy
from ..translations import rpt_, tip_


class _Mending:
    """What all of these buttons have in common."""

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - read by Blender
    remedy: Remedy

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is something to mend, and nothing is being relaxed."""
        refused = running()
        cls.poll_message_set(tip_(refused.sentence if refused else Message("Nothing selected needs that")))
        return refused is None and any(cls.concerned(context))

    @classmethod
    def concerned(cls, context: bpy.types.Context) -> Iterable[bpy.types.Object]:
        """The objects that need it; each is looked at when it is its turn, as mending one may mend others."""
        return needing(selected_curves(context), cls.remedy)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Mend them all; what cannot be mended is said, and stays as it is."""
        mended = [self._mend(obj) for obj in self.concerned(context)]
        return {"FINISHED"} if any(mended) else {"CANCELLED"}

    def _mend(self, obj: bpy.types.Object) -> bool:
        try:
            self.mend(obj)
        except MobiusFlowError as error:
            self.report({"ERROR"}, rpt_(str(error)))
            return False
        return True

    @staticmethod
    def mend(obj: bpy.types.Object) -> object:
        """Mend one of them."""
        raise NotImplementedError


class CURVE_OT_mobius_flow_object_mode(_Mending, bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
    """Leave Edit Mode; what was edited is kept"""

    bl_idname = Remedy.OBJECT_MODE.value
    bl_label = "Back to Object Mode"
    remedy = Remedy.OBJECT_MODE

    @staticmethod
    def mend(_obj: bpy.types.Object) -> object:
        """Leave it with all objects that are edited together."""
        return bpy.ops.object.mode_set(mode="OBJECT")


class CURVE_OT_mobius_flow_make_local(_Mending, bpy.types.Operator):  # noqa: N801
    """Make the selected curves of other files this file's own; their materials stay linked"""

    bl_idname = Remedy.MAKE_LOCAL.value
    bl_label = "Make Local"
    remedy = Remedy.MAKE_LOCAL
    mend = staticmethod(mending.make_local)


class CURVE_OT_mobius_flow_single_user(_Mending, bpy.types.Operator):  # noqa: N801
    """Give each of the selected objects curve data of its own; other objects keep what they share"""

    bl_idname = Remedy.SINGLE_USER.value
    bl_label = "Make Single User"
    remedy = Remedy.SINGLE_USER
    mend = staticmethod(mending.make_single_user)


class CURVE_OT_mobius_flow_make_3d(_Mending, bpy.types.Operator):  # noqa: N801
    """Let the points of the selected curves leave the plane"""

    bl_idname = Remedy.MAKE_3D.value
    bl_label = "Make 3D"
    remedy = Remedy.MAKE_3D
    mend = staticmethod(mending.make_3d)


class CURVE_OT_mobius_flow_to_poly(_Mending, bpy.types.Operator):  # noqa: N801
    """Replace Bézier and NURBS splines of the selected curves by the polygons drawn for them"""

    bl_idname = Remedy.TO_POLY.value
    bl_label = "Convert to Poly"
    remedy = Remedy.TO_POLY
    mend = staticmethod(mending.to_poly)


class CURVE_OT_mobius_flow_copy(_Mending, bpy.types.Operator):  # noqa: N801
    """Copy curves as they are shown now, without keys, modifiers that move points, and all else that moves them"""

    bl_idname = Remedy.COPY.value
    bl_label = "Make Still Copy"
    remedy = Remedy.COPY
    mend = staticmethod(copying.still_copy)

    @classmethod
    def concerned(cls, context: bpy.types.Context) -> Iterable[bpy.types.Object]:
        """The selected curves that need it, or all of them if none does: a copy never does harm."""
        objects = selected_curves(context) if context.mode == "OBJECT" else []
        return list(super().concerned(context)) or objects


class CURVE_OT_mobius_flow_to_curve(_Mending, bpy.types.Operator):  # noqa: N801
    """Make curves of the selected texts, and of meshes that are edges without faces; these stay as they are"""

    bl_idname = Remedy.TO_CURVE.value
    bl_label = "Convert to Curve"
    remedy = Remedy.TO_CURVE
    mend = staticmethod(mending.to_curve)

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


CLASSES = (
    CURVE_OT_mobius_flow_object_mode,
    CURVE_OT_mobius_flow_make_local,
    CURVE_OT_mobius_flow_single_user,
    CURVE_OT_mobius_flow_make_3d,
    CURVE_OT_mobius_flow_to_poly,
    CURVE_OT_mobius_flow_copy,
    CURVE_OT_mobius_flow_to_curve,
)
