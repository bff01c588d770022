"""Objects that are no curve objects: a curve object carries their keys, and a copy of theirs shows its motion.

The source is hidden, and otherwise left alone. The copy is of the same kind, with all that the source's curves have;
bundled nodes put its points where the carrier has them. It is rendered where there is no extension, too.
"""

import bpy
import numpy as np
from mathutils import Matrix

from ...core import Curve, MobiusFlowError
from ...core.base import Message
from . import bake, keyframes
from .assets import add_nodes, drop_nodes
from .splines import SOURCE, mesh_of, new_curve_data, write_points
from .strands import Strands, copied
from .surroundings import CARRIER

_MOTION = "Möbius Flow Motion"
_BEFORE = "mobius_flow_before"  # of a copy, while its carrier is relaxed anew: the data that it had
# fmt: off
_PLACE = (  # a matrix instead would be split into these anew, and lose shear and the last bits
    "rotation_mode", "location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle", "scale",
    "delta_location", "delta_rotation_euler", "delta_rotation_quaternion", "delta_scale",
    "parent_type", "parent", "parent_bone", "parent_vertices", "matrix_parent_inverse",
)
# fmt: on


def object_like(obj: bpy.types.Object, data: bpy.types.ID) -> bpy.types.Object:
    """Make an object for other data, with the place and the parent of an object but not its animation."""
    made = bpy.data.objects.new(data.name, data)
    for name in _PLACE:
        setattr(made, name, getattr(obj, name))
    return made


def show_instead(obj: bpy.types.Object, other: bpy.types.Object) -> None:
    """Put an object into the collections of another, selected, and active if the other was."""
    view_layer = bpy.context.view_layer
    was_active = view_layer.objects.active == obj
    own = [each for each in obj.users_collection if each.library is None and each.override_library is None]
    for collection in own or [bpy.context.scene.collection]:
        if other.name not in collection.objects:
            collection.objects.link(other)
    obj.select_set(False)
    other.select_set(True)
    if was_active:
        view_layer.objects.active = other


def enter(source: bpy.types.Object) -> bpy.types.Object:
    """Make a carrier of what an object shows, and hide that; raises CurveError as `Strands.of`."""
    strands = Strands.of(source)
    data = new_curve_data(f"{source.name} Keys", strands.mesh)
    write_points(data, np.concatenate(strands.components).astype(np.float32))
    thick = strands.attributes.get("radius")
    for spline, points in zip(data.splines, strands.mesh.slices, strict=True):
        spline.points.foreach_set("radius", np.zeros(len(spline.points)) if thick is None else thick.values[points])
    others = [each[SOURCE] for each in bpy.data.curves if SOURCE in each]  # which may have hidden it
    rendered = any(each["rendered"] for each in others if each["object"] == source)
    data[SOURCE] = {"object": source, "rendered": rendered or not source.hide_render}
    carrier = object_like(source, data)
    show_instead(source, carrier)
    source.hide_set(True)
    source.hide_render = True
    bpy.context.view_layer.update()
    return carrier


def leave(data: bpy.types.Curve) -> None:
    """Remove a carrier, which may be gone, and its copy, and show the source again."""
    source, rendered = data[SOURCE]["object"], data[SOURCE]["rendered"]
    carriers = [obj for obj in bpy.data.objects if obj.data == data]
    for copy in [obj for obj in bpy.data.objects if CARRIER in obj]:
        if copy[CARRIER] in carriers or (copy[CARRIER] is None and _BEFORE in copy):
            bpy.data.batch_remove([copy, copy.data])
    drop_nodes(_MOTION)
    others = (obj.data for obj in bpy.data.objects if obj.type == "CURVE" and obj.data != data)  # copies of carriers
    hidden = any(SOURCE in each and each[SOURCE]["object"] == source for each in others)
    if source is not None and source.name in bpy.context.view_layer.objects and not hidden:
        source.hide_render = not rendered
        source.hide_set(False)
        source.select_set(True)
        for carrier in carriers:
            show_instead(carrier, source)
    for carrier in carriers:
        bpy.data.objects.remove(carrier)
    keyframes.remove(data)
    bpy.context.view_layer.update()


def copy_of(carrier: bpy.types.Object) -> bpy.types.Object | None:
    """The object that shows a carrier's motion, if there is one."""
    return next((obj for obj in bpy.data.objects if obj.get(CARRIER) == carrier), None)


def strands_of(carrier: bpy.types.Object) -> Strands:
    """What a carrier that has no keys was made of; raises MobiusFlowError if that is not so any more."""
    source = carrier.data[SOURCE]["object"]
    if source is not None:
        hidden = source.hide_get()
        source.hide_set(False)  # or else its modifiers make nothing
        try:
            strands = Strands.of(source)
        finally:
            source.hide_set(hidden)
        if strands.mesh == mesh_of(carrier.data):
            return strands
    sentence = "'{name}' has other points than what it was made of; delete it, and relax that anew"
    raise MobiusFlowError(Message(sentence, name=carrier.name))


def follow(carrier: bpy.types.Object, strands: Strands, drawn: Curve, refined: Curve) -> None:
    """Let a copy of the source show the motion of a carrier, which gets the points of a refined curve.

    ``drawn``: the curve before; ``refined``: in the carrier's coordinates. Until `keep` it can be withdrawn.
    """
    source, copy = carrier.data[SOURCE]["object"], copy_of(carrier)
    data = copied(source, strands, drawn, refined)
    if copy is not None:
        before, copy.data = copy.data, data
        if _BEFORE in copy:
            bpy.data.batch_remove([before])
        else:
            copy[_BEFORE] = before
        return
    alike = data.id_type == source.data.id_type
    copy = source.copy() if alike else bpy.data.objects.new("", data)
    copy.name, copy.data = f"{source.name} Relaxed", data
    copy[CARRIER], copy[_BEFORE] = carrier, ""
    copy.animation_data_clear()
    copy.constraints.clear()
    if not strands.own:
        copy.modifiers.clear()
    add_nodes(copy, _MOTION, carrier, "radius" in strands.attributes)
    copy.modifiers.move(len(copy.modifiers) - 1, 0)
    copy.parent, copy.parent_type, copy.matrix_parent_inverse = carrier, "OBJECT", Matrix()
    copy.matrix_basis = Matrix()
    copy.hide_render = not carrier.data[SOURCE]["rendered"]
    for collection in carrier.users_collection:
        collection.objects.link(copy)


def keep(carrier: bpy.types.Object) -> None:
    """Make what shows a carrier final."""
    copy = copy_of(carrier)
    before = copy.pop(_BEFORE, None) if copy is not None else None
    if before:
        bpy.data.batch_remove([before])


def withdraw(carrier: bpy.types.Object | None) -> None:
    """Take back what has been done since `keep`: a carrier that never had keys goes, too, and the source is shown."""
    if carrier is None or SOURCE not in carrier.data:
        return
    copy = copy_of(carrier)
    if copy is not None and _BEFORE in copy:
        made, before = copy.data, copy.pop(_BEFORE)
        if before:
            copy.data = before
        bpy.data.batch_remove([made] if before else [copy, made])
    if not bake.is_baked(carrier.data) and copy_of(carrier) is None:
        leave(carrier.data)
