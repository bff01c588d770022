"""What cannot be relaxed, and why: one sentence for the user, naming what to do about it."""

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..curves import bake, bevel, sampling
from ..curves.moving import what_moves
from . import registry

if TYPE_CHECKING:
    import bpy

_Check = Callable[["bpy.types.Object"], Iterator[str]]
_FLATTEST = 1e-6  # smallest ratio of an object's scales that 32-bit matrices can be inverted with


def selected_curves(context: "bpy.types.Context") -> list["bpy.types.Object"]:
    """The curve objects that are relaxed together: all that are selected, whichever is active."""
    return [obj for obj in context.selected_objects if obj.type == "CURVE"]


def refusal(context: "bpy.types.Context") -> str | None:
    """Say why the selected curves cannot be relaxed, or return None if they can.

    Cheap enough for every redraw: only coordinates and what is drawn for smooth splines are left for
    `exchange.read_link` to check. Smooth splines are no hindrance here, see `unsampled`.
    """
    if reason := _running():
        return reason
    objects = selected_curves(context)
    return hindrance(objects) if objects else _no_curve(context.active_object)


def unreadable(context: "bpy.types.Context") -> str | None:
    """Say why other objects cannot be made of the selected curves, or return None if they can."""
    if reason := _running():
        return reason
    objects = selected_curves(context)
    return _first(objects, (_mode, _splines)) if objects else _no_curve(context.active_object)


def unfitting(context: "bpy.types.Context") -> str | None:
    """Say why the selected curves cannot be drawn as fitted tubes, or return None if they can."""
    return unreadable(context) or _first(selected_curves(context), (_ownership, _bevel))


def unpaintable(context: "bpy.types.Context") -> str | None:
    """Say why the selected curves cannot be given materials, or return None if they can."""
    return unreadable(context) or _first(selected_curves(context), (_ownership,))


def hindrance(objects: Sequence["bpy.types.Object"]) -> str | None:
    """Say why curve objects cannot be relaxed together, or return None if they can."""
    return _first(objects, _CHECKS if len(objects) == 1 else (*_CHECKS, _place))


def unbaked(context: "bpy.types.Context") -> str | None:
    """Say which of the selected curves was not baked, or return None if all were."""
    objects = selected_curves(context)
    bare = next((obj for obj in objects if not bake.is_baked(obj.data)), None)
    return f"'{bare.name}' has no keys of Möbius Flow; press Relax first" if bare is not None else None


def edited(context: "bpy.types.Context") -> str | None:
    """Say which of the selected curves has keys that somebody has edited, or return None; not for every redraw."""
    for obj in selected_curves(context):
        if bake.is_baked(obj.data) and bake.is_edited(obj.data):
            return f"Keys of '{obj.name}' were edited; undo that, or remove the keys to relax the curve as it is"
    return None


def unclearable(context: "bpy.types.Context") -> str | None:
    """Say why the selected curves cannot be given back as they were before they were baked, or return None."""
    if reason := _running():
        return reason
    objects = selected_curves(context)
    if not objects:
        return _no_curve(context.active_object)
    return unbaked(context) or _first(objects, (_mode, _ownership))


def _first(objects: Sequence["bpy.types.Object"], checks: Sequence[_Check]) -> str | None:
    return next((reason for obj in objects for check in checks for reason in check(obj)), None)


def unsampled(objects: Sequence["bpy.types.Object"]) -> str | None:
    """Say which spline must become a polygon first, or return None if there is none: nobody was asked yet."""
    for obj in objects:
        for k, spline in enumerate(obj.data.splines, 1):
            if spline.type != "POLY":
                return (
                    f"Spline {k} of '{obj.name}' is a {sampling.kind(spline)} spline; convert it to Poly first "
                    "(Edit Mode, Curve > Set Spline Type > Poly), or set Sample Splines"
                )
    return None


def _running() -> str | None:
    run = registry.current()
    return f"{run.name} is being relaxed; stop that first" if run else None


def _no_curve(obj: "bpy.types.Object | None") -> str:
    """Say what is wrong with the active object where no curve is selected; hiding deselects."""
    if obj is not None and obj.type == "CURVE" and not obj.visible_get():
        return f"'{obj.name}' is hidden; show it first"
    if obj is None or obj.type == "CURVE" or not obj.select_get():
        return "Select a curve object first"
    kind = obj.bl_rna.properties["type"].enum_items[obj.type].name
    return f"'{obj.name}' is of type {kind}; select a curve object, or convert it with Object > Convert > Curve"


def _mode(obj: "bpy.types.Object") -> Iterator[str]:
    if obj.mode != "OBJECT":
        yield f"'{obj.name}' is being edited; go back to Object Mode first"


def _ownership(obj: "bpy.types.Object") -> Iterator[str]:
    data = obj.data
    if obj.library or data.library:
        yield f"'{obj.name}' is linked from another file; make it local first (Object > Relations > Make Local)"
    elif obj.override_library or data.override_library:
        yield f"'{obj.name}' is a library override; make it local first (Object > Relations > Make Local)"
    elif data.users - data.use_fake_user > 1:
        yield (
            f"'{obj.name}' shares its curve data '{data.name}' with other objects; make it single-user first "
            "(Object > Relations > Make Single User)"
        )


def _splines(obj: "bpy.types.Object") -> Iterator[str]:
    data = obj.data
    if data.dimensions != "3D":
        yield f"'{obj.name}' is a 2D curve; set its Shape to 3D first (Object Data properties)"
    if not data.splines:
        yield f"'{obj.name}' has no splines; give it at least one closed poly spline"
    for k, spline in enumerate(data.splines, 1):
        fewest = 2 if spline.type == "BEZIER" else 3
        count = len(spline.bezier_points if spline.type == "BEZIER" else spline.points)
        if not spline.use_cyclic_u:
            yield f"Spline {k} of '{obj.name}' is open; close it first (Edit Mode, Curve > Toggle Cyclic)"
        elif count < fewest:
            yield (
                f"Spline {k} of '{obj.name}' has fewer than {fewest} points, too few for a closed curve; "
                "give it more, or delete it"
            )


def _bevel(obj: "bpy.types.Object") -> Iterator[str]:
    if not bevel.can_fit(obj.data):
        yield f"'{obj.name}' has a profile, taper, extrusion, offset or point radii of its own; remove them first"


def _animation(obj: "bpy.types.Object") -> Iterator[str]:
    data = obj.data
    if bake.is_baked(data):
        return
    if data.shape_keys:
        yield f"'{obj.name}' has shape keys; remove them or relax a copy without them"
    animation = data.animation_data
    if animation and (animation.action or animation.nla_tracks):
        yield f"The curve data of '{obj.name}' is animated; remove the animation or relax a copy without it"
    elif animation and any(driver.data_path.startswith("splines") for driver in animation.drivers):
        yield f"Points of '{obj.name}' are driven; remove the drivers or relax a copy without them"


def _transform(obj: "bpy.types.Object") -> Iterator[str]:
    matrix = np.array(obj.matrix_world, dtype=np.float64)
    scales = np.linalg.svd(matrix[:3, :3], compute_uv=False) if np.isfinite(matrix).all() else np.zeros(3)
    if not scales[2] > _FLATTEST * scales[0]:
        yield f"'{obj.name}' is scaled to nothing in some direction; give it a scale other than 0"


def _place(obj: "bpy.types.Object") -> Iterator[str]:
    if mover := what_moves(obj):
        yield (
            f"'{obj.name}' is moved by {mover}, and curves relaxed together must keep their places; "
            "remove that, or relax each curve alone"
        )


_CHECKS = (_mode, _ownership, _splines, _animation, _transform)
