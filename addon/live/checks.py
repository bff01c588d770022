"""The table of requirements on curves to be relaxed, drawn as tubes, cleared and so on.

Cheap enough for every redraw, except `UNEDITED`. Coordinates, and what is drawn for smooth splines, are left for
`exchange.read_link` to check.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import bpy
import numpy as np

from ..curves import bake, bevel, splines
from ..curves.moving import what_deforms, what_moves
from .requirements import Check, Curves, Remedy, curves_at_hand, shown_curves

_FLATTEST = 1e-6  # smallest ratio of an object's scales at which 32-bit matrices can be inverted


def _short_spline(obj: bpy.types.Object) -> dict[str, int] | None:
    for number, spline in enumerate(obj.data.splines, 1):
        fewest = 3 if spline.use_cyclic_u and spline.type != "BEZIER" else 2
        if len(spline.bezier_points if spline.type == "BEZIER" else spline.points) < fewest:
            return {"number": number, "fewest": fewest}
    return None


def _smooth_spline(obj: bpy.types.Object) -> dict[str, Any] | None:
    numbered = enumerate(obj.data.splines, 1)
    return next(({"number": k, "kind": splines.kind(each)} for k, each in numbered if each.type != "POLY"), None)


def _has_action(obj: bpy.types.Object) -> bool:
    animation = obj.data.animation_data
    return bool(animation and (animation.action or animation.nla_tracks))


def _has_driven_points(obj: bpy.types.Object) -> bool:
    animation = obj.data.animation_data
    return any(driver.data_path.startswith("splines") for driver in (animation.drivers if animation else ()))


def _unless_baked(failure: Callable[[bpy.types.Object], Any]) -> Callable[[bpy.types.Object], Any]:
    return lambda obj: not bake.is_baked(obj.data) and failure(obj)


def _is_flat(obj: bpy.types.Object) -> bool:
    matrix = np.array(obj.matrix_world, dtype=np.float64)
    scales = np.linalg.svd(matrix[:3, :3], compute_uv=False) if np.isfinite(matrix).all() else np.zeros(3)
    return not scales[2] > _FLATTEST * scales[0]


_OBJECT_MODE = Check(
    "'{name}' is being edited; go back to Object Mode first", lambda obj: obj.mode != "OBJECT", Remedy.OBJECT_MODE
)
_OWN = (
    Check(
        "'{name}' is linked from another file; make it local first (Object > Relations > Make Local)",
        lambda obj: obj.library or obj.data.library,
        Remedy.MAKE_LOCAL,
    ),
    Check(
        "'{name}' is a library override; make it local first (Object > Relations > Make Local)",
        lambda obj: obj.override_library or obj.data.override_library,
        Remedy.MAKE_LOCAL,
    ),
    Check(
        "'{name}' shares its curve data '{data}' with other objects; make it single-user first "
        "(Object > Relations > Make Single User)",
        lambda obj: obj.data.name if obj.data.users - obj.data.use_fake_user > 1 else None,
        Remedy.SINGLE_USER,
        "data",
    ),
)
_SPLINES = (
    Check(
        "'{name}' is a 2D curve; set its Shape to 3D first (Object Data properties)",
        lambda obj: obj.data.dimensions != "3D",
        Remedy.MAKE_3D,
    ),
    Check("'{name}' has no splines; give it at least one poly spline", lambda obj: not obj.data.splines),
    Check("Spline {number} of '{name}' has fewer than {fewest} points; give it more, or delete it", _short_spline),
)
_KEYS = (
    Check(
        "'{name}' has shape keys; remove them or relax a copy without them",
        _unless_baked(lambda obj: obj.data.shape_keys),
        Remedy.COPY,
    ),
    Check(
        "The curve data of '{name}' is animated; remove the animation or relax a copy without it",
        _unless_baked(_has_action),
        Remedy.COPY,
    ),
    Check(
        "Points of '{name}' are driven; remove the drivers or relax a copy without them",
        _unless_baked(_has_driven_points),
        Remedy.COPY,
    ),
)
_UNCHANGED = Check(
    "'{name}' has other keys or points than it was baked with; undo that, or relax a copy",
    _unless_baked(lambda obj: bake.was_baked(obj.data)),
    Remedy.COPY,
)
_OWN_KEYS = (
    # a curve that was baked, and has no keys any more, is like any other
    replace(_UNCHANGED, failure=lambda obj: _UNCHANGED.failure(obj) and any(each.failure(obj) for each in _KEYS)),
    *_KEYS,
)
_BAKED = (
    _UNCHANGED,
    Check("'{name}' has no keys of Möbius Flow; press Relax first", lambda obj: not bake.was_baked(obj.data)),
)
_UNKEYED = Curves(_OBJECT_MODE, *_OWN, *_OWN_KEYS)

RELAXABLE = Curves(
    *(_OBJECT_MODE, *_OWN, *_SPLINES, *_OWN_KEYS),
    Check(
        "{deformer} moves its points, so that strands may be seen to cross; remove it, or relax a copy without it",
        what_deforms,
        Remedy.COPY,
        "deformer",
    ),
    Check("'{name}' is scaled to nothing in some direction; give it a scale other than 0", _is_flat),
    Check(
        "'{name}' is moved by {mover}, and curves relaxed together must keep their places; "
        "remove that, or relax each curve alone",
        what_moves,
        Remedy.COPY,
        "mover",
        together=True,
    ),
)
READABLE = Curves(_OBJECT_MODE, *_SPLINES)
FILMABLE = Curves(*READABLE.checks, among=shown_curves)
PAINTABLE = Curves(*READABLE.checks, *_OWN)
FITTABLE = Curves(
    *PAINTABLE.checks,
    Check(
        "'{name}' has a profile, taper, extrusion, offset or point radii of its own; remove them first",
        lambda obj: not bevel.can_fit(obj.data),
    ),
)
PINNABLE = Curves(*_OWN, among=curves_at_hand)
BAKED = Curves(*_BAKED)
CLEARABLE = Curves(*_BAKED, _OBJECT_MODE, *_OWN)
UNEDITED = Curves(
    Check(
        "Keys of '{name}' were edited; undo that, or remove the keys to relax the curve as it is",
        lambda obj: bake.is_baked(obj.data) and bake.is_edited(obj.data),
        Remedy.COPY,
    )
)
POLYGONS = Curves(
    Check(
        "Spline {number} of '{name}' is a {kind} spline; convert it to Poly first "
        "(Edit Mode, Curve > Set Spline Type > Poly), or set Sample Splines",
        _smooth_spline,
        Remedy.TO_POLY,
    )
)


def needing(objects: Sequence[bpy.types.Object], remedy: Remedy) -> Iterator[bpy.types.Object]:
    """Yield the curve objects whose first refusal has this remedy, examining each in its turn."""
    several = len(objects) > 1
    checks = [*RELAXABLE.checks, *POLYGONS.checks]
    alone = Curves(*(replace(check, together=check.together and not several) for check in checks))
    for obj in objects:
        refusal = alone.of([obj])
        if refusal is not None and refusal.remedy is remedy:
            yield obj


def closable(objects: Sequence[bpy.types.Object]) -> Iterator[bpy.types.Object]:
    """Yield the curve objects with open splines that may be closed: a baked curve's keys are made for open ones."""
    for obj in objects:
        is_open = not all(spline.use_cyclic_u for spline in obj.data.splines)
        if is_open and not bake.is_baked(obj.data) and not _UNKEYED.of([obj]):
            yield obj
