"""The operator that remedies refusals: it removes one obstacle from all selected curves for which it is the next."""

from collections.abc import Callable, Iterable, Mapping

import bpy
import numpy as np
from bpy.app.translations import pgettext_tip
from bpy.props import EnumProperty

from ...core import Curve, MobiusFlowError
from ...core.base.messages import Message
from ..curves import bake
from ..curves.doors import show_instead
from ..curves.moving import deforms
from ..curves.splines import Splines, sampled, shape, write_points
from ..live.requirements import Remedy, closable, convertible, idle, needing, selected_curves
from .button import Button


def close(obj: bpy.types.Object) -> None:
    for spline in obj.data.splines:
        spline.use_cyclic_u = True


def make_local(obj: bpy.types.Object) -> None:
    """Make an object and its curve data this file's own; materials stay linked.

    If the object must stay as it is, because it is in a linked collection, a copy is selected in its place.
    """
    local = _own(obj)
    local.data = _own(local.data)
    if not local.users_scene:
        show_instead(obj, local)


def _own(block: bpy.types.ID) -> bpy.types.ID:
    """A datablock as this file's own, or a copy of it where only other linked data uses it."""
    own = block.make_local(clear_liboverride=True)
    return own.copy() if own.library else own


def to_poly(obj: bpy.types.Object) -> None:
    """Replace smooth splines by the polygons drawn for them.

    Raises CurveError if no polygon is drawn for one of them; nothing is changed then.
    """
    frames = sampled(obj)
    closed = [flag for *_, flag in shape(obj.data)]
    drawn = Curve.from_components([frame.astype(np.float64) for frame in frames], closed)
    Splines.of(obj.data).polygons(drawn, drawn).fill(obj.data)
    write_points(obj.data, np.concatenate(frames))


def to_curve(obj: bpy.types.Object) -> bpy.types.Object:
    """Make a curve object from a text or a mesh of edges, which stays; return it, the only object selected."""
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.convert(target="CURVE", keep_original=True)
    curve = bpy.context.object
    curve.data.materials.clear()  # for meshes Blender leaves them out
    for slot in obj.material_slots:
        curve.data.materials.append(slot.material)
    return curve


def still_copy(obj: bpy.types.Object) -> bpy.types.Object:
    """Copy a curve object as it is shown now, and select the copy in its place; the original stays as it is.

    The copy has neither keys, drivers, constraints nor a parent, and none of the modifiers that may move points. The
    points are where keys and modifiers have put them; what geometry nodes and a parent do to them is left out.
    """
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
    return copy


_MENDED: Mapping[Remedy, tuple[Callable[[bpy.types.Object], object], str]] = {  # may raise MobiusFlowErrors
    Remedy.OBJECT_MODE: (  # of all objects that are edited together
        lambda _obj: bpy.ops.object.mode_set(mode="OBJECT"),
        "Leave Edit Mode; what was edited is kept",
    ),
    Remedy.MAKE_LOCAL: (
        make_local,
        "Make the selected curves of other files this file's own; their materials stay linked",
    ),
    Remedy.SINGLE_USER: (
        lambda obj: setattr(obj, "data", obj.data.copy()),
        "Give each of the selected objects curve data of its own; other objects keep what they share",
    ),
    Remedy.MAKE_3D: (
        lambda obj: setattr(obj.data, "dimensions", "3D"),
        "Let the points of the selected curves leave the plane",
    ),
    Remedy.TO_POLY: (
        to_poly,
        "Replace Bézier and NURBS splines of the selected curves by the polygons drawn for them",
    ),
    Remedy.COPY: (
        still_copy,
        "Copy curves as they are shown now, without keys, modifiers that move points, and all else that moves them",
    ),
    Remedy.TO_CURVE: (
        to_curve,
        "Make curves of the selected texts, and of meshes that are edges without faces; these stay as they are",
    ),
    Remedy.CLOSE: (close, "Join the two ends of every open spline of the selected curves"),
}


class CURVE_OT_mobius_flow_mend(Button, bpy.types.Operator):
    """Remove what keeps the selected objects from being relaxed"""

    bl_label = "Mend"
    needs = (idle,)

    remedy: EnumProperty(
        name="Remedy",
        description="What is done about it",
        items=[(each.name, each.value, description) for each, (_, description) in _MENDED.items()],
        default=Remedy.COPY.name,
    )

    @classmethod
    def description(cls, _context: bpy.types.Context, operator: "bpy.types.OperatorProperties") -> str:
        return str(pgettext_tip(_MENDED[Remedy[operator.remedy]][1]))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Mend them all; failures are reported, and leave their objects as they were."""
        remedy, before, tried, mended = Remedy[self.remedy], set(context.view_layer.objects), False, False
        curves = selected_curves(context)
        needy: Iterable[bpy.types.Object] = needing(curves, remedy)  # one by one: mending one may mend others
        if remedy is Remedy.CLOSE:
            needy = closable(curves)
        elif remedy is Remedy.TO_CURVE:
            needy = convertible(context) if context.mode == "OBJECT" and not curves else ()
        elif remedy is Remedy.COPY and context.mode == "OBJECT":
            needy = list(needy) or curves  # a copy never does harm
        for obj in needy:
            tried = True
            try:
                _MENDED[remedy][0](obj)
                mended = True
            except MobiusFlowError as error:
                self.fail(error)
        if not tried:
            return self.fail(MobiusFlowError(Message("Nothing selected needs that")))
        if remedy is Remedy.TO_CURVE:  # all curves are selected afterwards, in place of their sources
            for obj in set(context.view_layer.objects) - before:
                obj.select_set(True)
        return {"FINISHED"} if mended else {"CANCELLED"}
