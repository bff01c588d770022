"""What cannot be relaxed, and why: one sentence for the user, and the button that mends it where one can."""

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

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
    """Say which of some curve objects is being edited, or has splines that are not closed; None if there is none."""
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
        return Refusal(f"'{found.name}' has other keys or points than it was baked with; undo that, or relax a copy")
    return Refusal(f"'{found.name}' has no keys of Möbius Flow; press Relax first")


def edited(context: "bpy.types.Context") -> Refusal | None:
    """Say which of the selected curves has keys that somebody has edited, or return None; not for every redraw."""
    return edited_by_hand(selected_curves(context))


def edited_by_hand(objects: Sequence["bpy.types.Object"]) -> Refusal | None:
    """Say which of some curve objects has keys that somebody has edited, or return None; not for every redraw."""
    for obj in objects:
        if bake.is_baked(obj.data) and bake.is_edited(obj.data):
            sentence = f"Keys of '{obj.name}' were edited; undo that, or remove the keys to relax the curve as it is"
            return Refusal(sentence, Remedy.COPY)
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
    return Refusal(f"{run.name} is being relaxed; stop that first") if run else None


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
        return Refusal(f"'{obj.name}' is hidden; show it first")
    if obj is None or obj.type == "CURVE" or not obj.select_get():
        return Refusal("Select a curve object first")
    kind = obj.bl_rna.properties["type"].enum_items[obj.type].name
    sentence = f"'{obj.name}' is of type {kind}; select a curve object, or convert it with Object > Convert > Curve"
    return Refusal(sentence, Remedy.TO_CURVE if obj.mode == "OBJECT" and convertible(context) else None)


def _mode(obj: "bpy.types.Object") -> Iterator[Refusal]:
    if obj.mode != "OBJECT":
        yield Refusal(f"'{obj.name}' is being edited; go back to Object Mode first", Remedy.OBJECT_MODE)


def _ownership(obj: "bpy.types.Object") -> Iterator[Refusal]:
    data, how = obj.data, "make it local first (Object > Relations > Make Local)"
    if obj.library or data.library:
        yield Refusal(f"'{obj.name}' is linked from another file; {how}", Remedy.MAKE_LOCAL)
    elif obj.override_library or data.override_library:
        yield Refusal(f"'{obj.name}' is a library override; {how}", Remedy.MAKE_LOCAL)
    elif data.users - data.use_fake_user > 1:
        sentence = (
            f"'{obj.name}' shares its curve data '{data.name}' with other objects; make it single-user first "
            "(Object > Relations > Make Single User)"
        )
        yield Refusal(sentence, Remedy.SINGLE_USER)


def _splines(obj: "bpy.types.Object") -> Iterator[Refusal]:
    data = obj.data
    if data.dimensions != "3D":
        yield Refusal(f"'{obj.name}' is a 2D curve; set its Shape to 3D first (Object Data properties)", Remedy.MAKE_3D)
    if not data.splines:
        yield Refusal(f"'{obj.name}' has no splines; give it at least one closed poly spline")
    for k, spline in enumerate(data.splines, 1):
        fewest = 2 if spline.type == "BEZIER" else 3
        count = len(spline.bezier_points if spline.type == "BEZIER" else spline.points)
        name = f"Spline {k} of '{obj.name}'"
        if count < fewest:
            yield Refusal(
                f"{name} has fewer than {fewest} points, too few for a closed curve; give it more, or delete it"
            )
        elif not spline.use_cyclic_u:
            yield Refusal(f"{name} is open; close it first (Edit Mode, Curve > Toggle Cyclic)", Remedy.CLOSE)


def _bevel(obj: "bpy.types.Object") -> Iterator[Refusal]:
    if not bevel.can_fit(obj.data):
        what = "a profile, taper, extrusion, offset or point radii of its own"
        yield Refusal(f"'{obj.name}' has {what}; remove them first")


def _smooth(obj: "bpy.types.Object") -> Iterator[Refusal]:
    for k, spline in enumerate(obj.data.splines, 1):
        if spline.type != "POLY":
            sentence = (
                f"Spline {k} of '{obj.name}' is a {sampling.kind(spline)} spline; convert it to Poly first "
                "(Edit Mode, Curve > Set Spline Type > Poly), or set Sample Splines"
            )
            yield Refusal(sentence, Remedy.TO_POLY)


def _animation(obj: "bpy.types.Object") -> Iterator[Refusal]:
    if not bake.is_baked(obj.data) and (sentence := _animated(obj)):
        yield Refusal(sentence, Remedy.COPY)


def _animated(obj: "bpy.types.Object") -> str | None:
    data = obj.data
    animation = data.animation_data
    if data.shape_keys:
        return f"'{obj.name}' has shape keys; remove them or relax a copy without them"
    if animation and (animation.action or animation.nla_tracks):
        return f"The curve data of '{obj.name}' is animated; remove the animation or relax a copy without it"
    if animation and any(driver.data_path.startswith("splines") for driver in animation.drivers):
        return f"Points of '{obj.name}' are driven; remove the drivers or relax a copy without them"
    return None


def _deformation(obj: "bpy.types.Object") -> Iterator[Refusal]:
    if deformer := what_deforms(obj):
        how = "remove it, or relax a copy without it"
        yield Refusal(f"{deformer} moves its points, so that strands may be seen to cross; {how}", Remedy.COPY)


def _transform(obj: "bpy.types.Object") -> Iterator[Refusal]:
    matrix = np.array(obj.matrix_world, dtype=np.float64)
    scales = np.linalg.svd(matrix[:3, :3], compute_uv=False) if np.isfinite(matrix).all() else np.zeros(3)
    if not scales[2] > _FLATTEST * scales[0]:
        yield Refusal(f"'{obj.name}' is scaled to nothing in some direction; give it a scale other than 0")


def _place(obj: "bpy.types.Object") -> Iterator[Refusal]:
    if mover := what_moves(obj):
        sentence = (
            f"'{obj.name}' is moved by {mover}, and curves relaxed together must keep their places; "
            "remove that, or relax each curve alone"
        )
        yield Refusal(sentence, Remedy.COPY)


_CHECKS = (_mode, _ownership, _splines, _animation, _deformation, _transform)
