"""The operator that remedies refusals: it removes one obstacle from all selected curves for which it is the next."""

from collections.abc import Callable, Iterable

import bpy
import numpy as np
from bpy.app.translations import pgettext_tip
from bpy.props import EnumProperty

from ...core import Curve, MobiusFlowError
from ...core.base import Message
from ..curves import bake
from ..curves.doors import show_instead
from ..curves.moving import deforms
from ..curves.splines import Splines, sampled, shape, write_points
from ..live.requirements import Remedy, idle, needing
from ..live.selection import convertible, selected_curves
from .button import Button


def _leave_edit_mode(_obj: bpy.types.Object) -> None:
    """Leave Edit Mode; what was edited is kept"""
    bpy.ops.object.mode_set(mode="OBJECT")  # for all objects that are edited together


def _make_local(obj: bpy.types.Object) -> None:
    """Make the selected curves of other files this file's own; their materials stay linked"""

    def own(block: bpy.types.ID) -> bpy.types.ID:
        made = block.make_local(clear_liboverride=True)
        return made.copy() if made.library else made  # where only other linked data uses it

    local = own(obj)
    local.data = own(local.data)
    if not local.users_scene:  # the object must stay as it is, because it is in a linked collection
        show_instead(obj, local)


def _make_single_user(obj: bpy.types.Object) -> None:
    """Give each of the selected objects curve data of its own; other objects keep what they share"""
    obj.data = obj.data.copy()


def _make_3d(obj: bpy.types.Object) -> None:
    """Let the points of the selected curves leave the plane"""
    obj.data.dimensions = "3D"


def _to_poly(obj: bpy.types.Object) -> None:
    """Replace Bézier and NURBS splines of the selected curves by the polygons drawn for them"""
    frames = sampled(obj)
    closed = [flag for *_, flag in shape(obj.data)]
    drawn = Curve.from_components([frame.astype(np.float64) for frame in frames], closed)
    Splines.of(obj.data).polygons(drawn, drawn).fill(obj.data)
    write_points(obj.data, np.concatenate(frames))


def _still_copy(obj: bpy.types.Object) -> None:
    """Copy curves as they are shown now, without keys, modifiers that move points, and all else that moves them"""
    # what geometry nodes and a parent do to points is left out; the copy is selected in place of the original
    world = obj.matrix_world.copy()
    copy = obj.copy()
    show_instead(obj, copy)
    for modifier in (moving := list(filter(deforms, copy.modifiers))):
        modifier.use_apply_on_spline = True  # not on what is drawn around it
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = copy.evaluated_get(depsgraph)
    try:
        shown = Splines.of(evaluated.to_curve(depsgraph, apply_modifiers=True))
    finally:
        evaluated.to_curve_clear()
    copy.data = obj.data.copy()
    for modifier in moving:
        copy.modifiers.remove(modifier)
    bake.forget(copy)
    copy.data.animation_data_clear()
    copy.animation_data_clear()
    copy.constraints.clear()
    copy.parent = None
    shown.fill(copy.data)
    bpy.context.view_layer.update()
    if copy.matrix_world != world:  # something that was removed held it there
        copy.matrix_world = world
        bpy.context.view_layer.update()
        copy.data.transform(copy.matrix_world.inverted_safe() @ world)  # shear, which no object has by itself


def _to_curve(obj: bpy.types.Object) -> None:
    """Make curves of the selected texts, and of meshes that are edges without faces; these stay as they are"""
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.convert(target="CURVE", keep_original=True)
    curve = bpy.context.object
    curve.data.materials.clear()  # for meshes Blender leaves them out
    for slot in obj.material_slots:
        curve.data.materials.append(slot.material)


# what mends an object, with the tooltip as docstring; it may raise a MobiusFlowError
_MENDED: dict[Remedy, Callable[[bpy.types.Object], object]] = {
    Remedy.OBJECT_MODE: _leave_edit_mode,
    Remedy.MAKE_LOCAL: _make_local,
    Remedy.SINGLE_USER: _make_single_user,
    Remedy.MAKE_3D: _make_3d,
    Remedy.TO_POLY: _to_poly,
    Remedy.COPY: _still_copy,
    Remedy.TO_CURVE: _to_curve,
}


class CURVE_OT_mobius_flow_mend(Button, bpy.types.Operator):
    """Remove what keeps the selected objects from being relaxed"""

    bl_label = "Mend"
    needs = (idle,)

    remedy: EnumProperty(
        name="Remedy",
        description="What is done about it",
        items=[(each.name, each.value, str(mend.__doc__)) for each, mend in _MENDED.items()],
        default=Remedy.COPY.name,
    )

    @classmethod
    def description(cls, _context: bpy.types.Context, operator: "bpy.types.OperatorProperties") -> str:
        return str(pgettext_tip(str(_MENDED[Remedy[operator.remedy]].__doc__)))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Mend them all; failures are reported, and leave their objects as they were."""
        remedy, before, tried, mended = Remedy[self.remedy], set(context.view_layer.objects), False, False
        curves = selected_curves(context)
        needy: Iterable[bpy.types.Object] = needing(curves, remedy)  # one by one: mending one may mend others
        if remedy is Remedy.TO_CURVE:
            needy = convertible(context) if context.mode == "OBJECT" and not curves else ()
        elif remedy is Remedy.COPY and context.mode == "OBJECT":
            needy = list(needy) or curves  # a copy never does harm
        for obj in needy:
            tried = True
            try:
                _MENDED[remedy](obj)
                mended = True
            except MobiusFlowError as error:
                self.fail(error)
        if not tried:
            return self.fail(MobiusFlowError(Message("Nothing selected needs that")))
        if remedy is Remedy.TO_CURVE:  # all curves are selected afterwards, in place of their sources
            for obj in set(context.view_layer.objects) - before:
                obj.select_set(True)
        return {"FINISHED"} if mended else {"CANCELLED"}
