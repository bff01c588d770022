"""What cannot be relaxed, and why: one sentence for the user, and the button that mends it where one can."""

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...core.messages import Message
from ..curves import bake, bevel, sampling
from ..curves.deforming import what_deforms
from ..curves.moving import what_moves
from . import registry
from .refusal import Refusal, Remedy

if TYPE_CHECKING:
    import bpy

_Check = Callable[["bpy.types.Object"], Iterator[Refusal]]
_FLATTEST = 1e-6  # smallest ratio of an object's scales that 32-bit matrices can be inverted with


def selected_curves(context: "bpy.types.Context") -> list["bpy.types.Object"]:
    """The curve objects that are relaxed together: all that are selected, whichever is active."""
    return [obj for obj in context.selected_objects if obj.type == "CURVE"]


def refusal(context: "bpy.types.Context") -> Refusal | None:
    """Say why the selected curves cannot be relaxed, or return None if they can.

    Cheap enough for every redraw: only coordinates and what is drawn for smooth splines are left for
    `exchange.read_link` to check. Smooth splines are no hindrance here, see `unsampled`.
    """
    if refused := running():
        return refused
    objects = selected_curves(context)
    return hindrance(objects) if objects else _no_curve(context)


def unreadable(context: "bpy.types.Context") -> Refusal | None:
    """Say why other objects cannot be made of the selected curves, or return None if they can."""
    if refused := running():
        return refused
    objects = selected_curves(context)
    return undrawn(objects) if objects else _no_curve(context)


def undrawn(objects: Sequence["bpy.types.Object"]) -> Refusal | None:
    """Say which of some curve objects is being edited, 2D, or has splines of too few points; None if none is."""
    return running() or _first(objects, (_mode, _splines))


def unfitting(context: "bpy.types.Context") -> Refusal | None:
    """Say why the selected curves cannot be drawn as fitted tubes, or return None if they can."""
    return unreadable(context) or _first(selected_curves(context), (_ownership, _bevel))


def unpaintable(context: "bpy.types.Context") -> Refusal | None:
    """Say why the selected curves cannot be given materials, or return None if they can."""
    return unreadable(context) or _first(selected_curves(context), (_ownership,))


def hindrance(objects: Sequence["bpy.types.Object"]) -> Refusal | None:
    """Say why curve objects cannot be relaxed together, or return None if they can."""
    return _first(objects, _checks(objects))


def needing(objects: Sequence["bpy.types.Object"], remedy: Remedy) -> Iterator["bpy.types.Object"]:
    """Yield the curve objects that a remedy is the next to help; each is looked at when it is its turn."""
    checks = (*_checks(objects), _smooth)
    for obj in objects:
        refused = _first([obj], checks)
        if refused is not None and refused.remedy is remedy:
            yield obj


def curves_at_hand(context: "bpy.types.Context") -> list["bpy.types.Object"]:
    """The curve objects that are being edited, or the selected ones where none is."""
    return list(context.objects_in_mode) if context.mode == "EDIT_CURVE" else selected_curves(context)


def unpinnable(context: "bpy.types.Context") -> Refusal | None:
    """Say why points of these cannot be pinned, or return None if they can."""
    objects = curves_at_hand(context)
    return running() or (_first(objects, (_ownership,)) if objects else _no_curve(context))


def closable(objects: Sequence["bpy.types.Object"]) -> Iterator["bpy.types.Object"]:
    """Yield the curve objects with open splines that may be closed: keys of a baked curve are about open ones."""
    for obj in objects:
        open_ones = not all(spline.use_cyclic_u for spline in obj.data.splines)
        if open_ones and not bake.is_baked(obj.data) and not _first([obj], (_mode, _ownership, _animation)):
            yield obj


def _checks(objects: Sequence["bpy.types.Object"]) -> Sequence[_Check]:
    return _CHECKS if len(objects) == 1 else (*_CHECKS, _place)


def unbaked(context: "bpy.types.Context") -> Refusal | None:
    """Say which of the selected curves was not baked, or return None if all were."""
    return bare(selected_curves(context))


def bare(objects: Sequence["bpy.types.Object"]) -> Refusal | None:
    """Say which of some curve objects was not baked, or return None if all were."""
    found = next((obj for obj in objects if not bake.is_baked(obj.data)), None)
    if found is None:
        return None
    if bake.was_baked(found.data):
        return _changed(found)
    return Refusal(Message("'{name}' has no keys of Möbius Flow; press Relax first", name=found.name))


def edited(context: "bpy.types.Context") -> Refusal | None:
    """Say which of the selected curves has keys that somebody has edited, or return None; not for every redraw."""
    return edited_by_hand(selected_curves(context))


def edited_by_hand(objects: Sequence["bpy.types.Object"]) -> Refusal | None:
    """Say which of some curve objects has keys that somebody has edited, or return None; not for every redraw."""
    for obj in objects:
        if bake.is_baked(obj.data) and bake.is_edited(obj.data):
            sentence = "Keys of '{name}' were edited; undo that, or remove the keys to relax the curve as it is"
            return Refusal(Message(sentence, name=obj.name), Remedy.COPY)
    return None


def unclearable(context: "bpy.types.Context") -> Refusal | None:
    """Say why the selected curves cannot be given back as they were before they were baked, or return None."""
    if refused := running():
        return refused
    objects = selected_curves(context)
    return locked(objects) if objects else _no_curve(context)


def locked(objects: Sequence["bpy.types.Object"]) -> Refusal | None:
    """Say why curve objects cannot be given back as they were before they were baked, or return None."""
    return running() or bare(objects) or _first(objects, (_mode, _ownership))


def _first(objects: Sequence["bpy.types.Object"], checks: Sequence[_Check]) -> Refusal | None:
    return next((refused for obj in objects for check in checks for refused in check(obj)), None)


def unsampled(objects: Sequence["bpy.types.Object"]) -> Refusal | None:
    """Say which spline must become a polygon first, or return None if there is none: nobody was asked yet."""
    return _first(objects, (_smooth,))


def running() -> Refusal | None:
    """Say that a relaxation is going on, or return None if there is none."""
    run = registry.current()
    return Refusal(Message("{names} is being relaxed; stop that first", names=run.name)) if run else None


def convertible(context: "bpy.types.Context") -> list["bpy.types.Object"]:
    """The selected objects of this file that lines can be made of: texts, and meshes of edges alone."""
    own = (obj for obj in context.selected_objects if not (obj.library or obj.override_library))
    return [obj for obj in own if obj.type == "FONT" or _is_wire(obj)]


def _is_wire(obj: "bpy.types.Object") -> bool:
    return obj.type == "MESH" and len(obj.data.edges) > 0 and not len(obj.data.polygons)


def _no_curve(context: "bpy.types.Context") -> Refusal:
    """Say what is wrong with the active object where no curve is selected; hiding deselects."""
    obj = context.active_object
    if obj is not None and obj.type == "CURVE" and not obj.visible_get():
        return Refusal(Message("'{name}' is hidden; show it first", name=obj.name))
    if obj is None or obj.type == "CURVE" or not obj.select_get():
        return Refusal(Message("Select a curve object first"))
    kind = obj.bl_rna.properties["type"].enum_items[obj.type].name
    sentence = "'{name}' is of type {type}; select a curve object, or convert it with Object > Convert > Curve"
    return Refusal(
        Message(sentence, name=obj.name, type=kind),
        Remedy.TO_CURVE if obj.mode == "OBJECT" and convertible(context) else None,
    )


def _mode(obj: "bpy.types.Object") -> Iterator[Refusal]:
    if obj.mode != "OBJECT":
        sentence = Message("'{name}' is being edited; go back to Object Mode first", name=obj.name)
        yield Refusal(sentence, Remedy.OBJECT_MODE)


def _ownership(obj: "bpy.types.Object") -> Iterator[Refusal]:
    data = obj.data
    if obj.library or data.library:
        sentence = "'{name}' is linked from another file; make it local first (Object > Relations > Make Local)"
        yield Refusal(Message(sentence, name=obj.name), Remedy.MAKE_LOCAL)
    elif obj.override_library or data.override_library:
        sentence = "'{name}' is a library override; make it local first (Object > Relations > Make Local)"
        yield Refusal(Message(sentence, name=obj.name), Remedy.MAKE_LOCAL)
    elif data.users - data.use_fake_user > 1:
        sentence = (
            "'{name}' shares its curve data '{data}' with other objects; make it single-user first "
            "(Object > Relations > Make Single User)"
        )
        yield Refusal(Message(sentence, name=obj.name, data=data.name), Remedy.SINGLE_USER)


def _splines(obj: "bpy.types.Object") -> Iterator[Refusal]:
    data = obj.data
    if data.dimensions != "3D":
        sentence = "'{name}' is a 2D curve; set its Shape to 3D first (Object Data properties)"
        yield Refusal(Message(sentence, name=obj.name), Remedy.MAKE_3D)
    if not data.splines:
        yield Refusal(Message("'{name}' has no splines; give it at least one poly spline", name=obj.name))
    for k, spline in enumerate(data.splines, 1):
        fewest = 3 if spline.use_cyclic_u and spline.type != "BEZIER" else 2
        count = len(spline.bezier_points if spline.type == "BEZIER" else spline.points)
        if count < fewest:
            sentence = "Spline {number} of '{name}' has fewer than {fewest} points; give it more, or delete it"
            yield Refusal(Message(sentence, number=k, name=obj.name, fewest=fewest))


def _bevel(obj: "bpy.types.Object") -> Iterator[Refusal]:
    if not bevel.can_fit(obj.data):
        sentence = "'{name}' has a profile, taper, extrusion, offset or point radii of its own; remove them first"
        yield Refusal(Message(sentence, name=obj.name))


def _smooth(obj: "bpy.types.Object") -> Iterator[Refusal]:
    for k, spline in enumerate(obj.data.splines, 1):
        if spline.type != "POLY":
            sentence = (
                "Spline {number} of '{name}' is a {kind} spline; convert it to Poly first "
                "(Edit Mode, Curve > Set Spline Type > Poly), or set Sample Splines"
            )
            yield Refusal(Message(sentence, number=k, name=obj.name, kind=sampling.kind(spline)), Remedy.TO_POLY)


def _animation(obj: "bpy.types.Object") -> Iterator[Refusal]:
    if not bake.is_baked(obj.data) and (sentence := _animated(obj)):
        yield _changed(obj) if bake.was_baked(obj.data) else Refusal(sentence, Remedy.COPY)


def _changed(obj: "bpy.types.Object") -> Refusal:
    """Say that a curve was baked and is not any more what it was then: shape keys alone would be no hindrance."""
    sentence = "'{name}' has other keys or points than it was baked with; undo that, or relax a copy"
    return Refusal(Message(sentence, name=obj.name), Remedy.COPY)


def _animated(obj: "bpy.types.Object") -> Message | None:
    data = obj.data
    animation = data.animation_data
    if data.shape_keys:
        return Message("'{name}' has shape keys; remove them or relax a copy without them", name=obj.name)
    if animation and (animation.action or animation.nla_tracks):
        sentence = "The curve data of '{name}' is animated; remove the animation or relax a copy without it"
        return Message(sentence, name=obj.name)
    if animation and any(driver.data_path.startswith("splines") for driver in animation.drivers):
        return Message("Points of '{name}' are driven; remove the drivers or relax a copy without them", name=obj.name)
    return None


def _deformation(obj: "bpy.types.Object") -> Iterator[Refusal]:
    if deformer := what_deforms(obj):
        sentence = (
            "{deformer} moves its points, so that strands may be seen to cross; remove it, or relax a copy without it"
        )
        yield Refusal(Message(sentence, deformer=deformer), Remedy.COPY)


def _transform(obj: "bpy.types.Object") -> Iterator[Refusal]:
    matrix = np.array(obj.matrix_world, dtype=np.float64)
    scales = np.linalg.svd(matrix[:3, :3], compute_uv=False) if np.isfinite(matrix).all() else np.zeros(3)
    if not scales[2] > _FLATTEST * scales[0]:
        sentence = "'{name}' is scaled to nothing in some direction; give it a scale other than 0"
        yield Refusal(Message(sentence, name=obj.name))


def _place(obj: "bpy.types.Object") -> Iterator[Refusal]:
    if mover := what_moves(obj):
        sentence = (
            "'{name}' is moved by {mover}, and curves relaxed together must keep their places; "
            "remove that, or relax each curve alone"
        )
        yield Refusal(Message(sentence, name=obj.name, mover=mover), Remedy.COPY)


_CHECKS = (_mode, _ownership, _splines, _animation, _deformation, _transform)
