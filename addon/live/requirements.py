"""Requirements of operators on curves and scenes: a failed one gives a sentence, and a remedy if there is one."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any

import bpy
import numpy as np

from ...core import MobiusFlowError
from ...core.base.messages import Message
from ..curves import bake, bevel, splines
from ..curves.moving import what_deforms, what_moves
from ..curves.splines import box
from ..curves.strands import KINDS, has_loops
from ..curves.surroundings import CARRIER, TUBE_OF, WITHOUT_SHAPE
from . import registry


class Remedy(Enum):
    """A remedy for a refusal, which the operator *Mend* applies; the values say on its button what it does."""

    OBJECT_MODE = "Back to Object Mode"
    MAKE_LOCAL = "Make Local"
    SINGLE_USER = "Make Single User"
    TO_CURVE = "Convert to Curve"
    TO_POLY = "Convert to Poly"
    MAKE_3D = "Make 3D"
    COPY = "Make Still Copy"
    CLOSE = "Close Splines"


@dataclass(frozen=True)
class Refusal:
    """Why something cannot be done and what helps, in one sentence, and the button that does so, if there is one."""

    sentence: Message
    remedy: Remedy | None = None


Requirement = Callable[[bpy.types.Context], Refusal | None]
_Choice = Callable[[bpy.types.Context], list[bpy.types.Object]]


@dataclass(frozen=True)
class Check:
    """A requirement on a curve object: where ``failure`` finds something, the sentence says so.

    What is found fills in ``field`` in the sentence or, if it is a mapping, several fields. ``together`` marks
    what is required only of curves that are relaxed together, ``any_kind`` what is of objects of other kinds, too.
    """

    sentence: str
    failure: Callable[[bpy.types.Object], Any]
    remedy: Remedy | None = None
    field: str = ""
    together: bool = False
    any_kind: bool = False

    def refusal(self, obj: bpy.types.Object) -> Refusal | None:
        if not (self.any_kind or obj.type == "CURVE") or not (found := self.failure(obj)):
            return None
        values = found if isinstance(found, Mapping) else {self.field: found}
        return Refusal(Message(self.sentence, name=obj.name, **values), self.remedy)


@dataclass(frozen=True)
class Condition:
    """A requirement on the scene, or on everything selected."""

    sentence: str
    fails: Callable[[bpy.types.Context], bool]

    def __call__(self, context: bpy.types.Context) -> Refusal | None:
        return Refusal(Message(self.sentence)) if self.fails(context) else None


def selected_curves(context: bpy.types.Context, *more: str) -> list[bpy.types.Object]:
    """The curve objects that are selected, whichever is active, and those whose motion selected copies show.

    ``more``: other custom properties of objects, which say what curve object they were made of.
    """
    made_of = list(context.selected_objects)
    for name in (CARRIER, *more):
        made_of = [obj.get(name, obj) for obj in made_of if obj is not None]
    there = (obj for obj in made_of if obj is not None and obj.name in context.scene.objects)
    return [obj for obj in dict.fromkeys(there) if obj.type == "CURVE"]


def shown_curves(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The curve objects whose motion is seen: those selected, and those that selected tubes' meshes were made of."""
    return selected_curves(context, TUBE_OF)


def relaxed_together(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected objects that are curves of any kind; a mesh with faces is none where there are others."""
    chosen = [obj for obj in context.selected_objects if obj.type in KINDS and CARRIER not in obj]
    lines = [obj for obj in chosen if obj.type != "MESH" or (obj.data.edges and not obj.data.polygons)]
    found = [*selected_curves(context), *lines]
    return found or [obj for obj in chosen if has_loops(obj.data)]


def curves_at_hand(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The curve objects that are being edited, or the selected ones where none is."""
    return list(context.objects_in_mode) if context.mode == "EDIT_CURVE" else selected_curves(context)


class Curves:
    """The requirement that there are curve objects, all of which pass some checks, while nothing is being relaxed."""

    def __init__(self, *checks: Check, among: _Choice = selected_curves) -> None:
        self.checks, self._among = checks, among

    def __call__(self, context: bpy.types.Context) -> Refusal | None:
        objects = self._among(context)
        if objects or idle(context):
            return idle(context) or self.of(objects)
        # say what is wrong with the active object; hiding deselects
        obj = context.active_object
        if obj is not None and obj.type == "CURVE" and not obj.visible_get():
            return Refusal(Message("'{name}' is hidden; show it first", name=obj.name))
        if obj is None or obj.type == "CURVE" or not obj.select_get():
            return Refusal(Message("Select a curve object first"))
        kind = obj.bl_rna.properties["type"].enum_items[obj.type].name
        sentence = "'{name}' is of type {type}; select a curve object, or convert it with Object > Convert > Curve"
        remedy = Remedy.TO_CURVE if obj.mode == "OBJECT" and convertible(context) else None
        return Refusal(Message(sentence, name=obj.name, type=kind), remedy)

    def of(self, objects: Sequence[bpy.types.Object]) -> Refusal | None:
        several = len(objects) > 1
        checks = [check for check in self.checks if several or not check.together]
        return next((refusal for obj in objects for check in checks if (refusal := check.refusal(obj))), None)


def first(context: bpy.types.Context, requirements: Sequence[Requirement]) -> Refusal | None:
    return next((refusal for each in requirements if (refusal := each(context))), None)


def require(*refusals: Refusal | None) -> None:
    """Raise a MobiusFlowError with the first of some refusals, if there is any."""
    if refused := next((each for each in refusals if each), None):
        raise MobiusFlowError(refused.sentence)


def idle(_context: bpy.types.Context | None = None) -> Refusal | None:
    """Require that nothing is being relaxed."""
    run = registry.current()
    return Refusal(Message("{names} is being relaxed; stop that first", names=run.name)) if run else None


def convertible(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected objects of this file that lines can be made of: texts, and meshes of edges alone."""
    own = (obj for obj in context.selected_objects if not (obj.library or obj.override_library))
    texts_and_meshes = (obj for obj in own if obj.type in ("FONT", "MESH"))
    return [obj for obj in texts_and_meshes if obj.type == "FONT" or (obj.data.edges and not obj.data.polygons)]


def avoided(context: bpy.types.Context, name: str | None = None) -> list[bpy.types.Object]:
    """What selected curves must not touch: visible objects with a shape of a collection, and the container they lie in.

    The collection is the scene's, or one given by name, and then there is no container. An empty name means to avoid
    nothing; raises MobiusFlowError if there is no collection of that name.
    """
    collection = context.scene.mobius_flow_surroundings.avoid if name is None else bpy.data.collections.get(name)
    if name and collection is None:
        raise MobiusFlowError(Message("There is no collection '{name}' to avoid", name=name))
    found, relaxed = list[bpy.types.Object](), relaxed_together(context)
    for obj in collection.all_objects if collection is not None else ():
        bare = obj.type in WITHOUT_SHAPE or (obj.type == "EMPTY" and obj.instance_type == "NONE")
        if not bare and obj not in relaxed and obj.visible_get():
            found.append(obj)
    outer = container(context) if name is None else None
    return found if outer is None or outer in found or not outer.visible_get() else [*found, outer]


def container(context: bpy.types.Context) -> bpy.types.Object | None:
    """The mesh that was picked as a container, if the boxes of all selected curves lie in its own."""
    outer, curves = context.scene.mobius_flow_surroundings.container, relaxed_together(context)
    if outer is None or not curves:
        return None
    (low, high), boxes = box(outer), map(box, curves)
    return outer if all((low <= least).all() and (most <= high).all() for least, most in boxes) else None


def _short_spline(obj: bpy.types.Object) -> dict[str, int] | None:
    for number, spline in enumerate(obj.data.splines, 1):
        fewest = 3 if spline.use_cyclic_u and spline.type != "BEZIER" else 2
        if len(spline.bezier_points if spline.type == "BEZIER" else spline.points) < fewest:
            return {"number": number, "fewest": fewest}
    return None


def _smooth_spline(obj: bpy.types.Object) -> dict[str, Any] | None:
    numbered = enumerate(obj.data.splines, 1)
    return next(({"number": k, "kind": splines.kind(each)} for k, each in numbered if each.type != "POLY"), None)


def _unless_baked(failure: Callable[[bpy.types.Object], Any]) -> Callable[[bpy.types.Object], Any]:
    return lambda obj: not bake.is_baked(obj.data) and failure(obj)


def _is_flat(obj: bpy.types.Object) -> bool:
    matrix = np.array(obj.matrix_world, dtype=np.float64)
    scales = np.linalg.svd(matrix[:3, :3], compute_uv=False) if np.isfinite(matrix).all() else np.zeros(3)
    return not scales[2] > 1e-6 * scales[0]  # matrices of smaller ratios cannot be inverted in 32 bits


_OBJECT_MODE = Check(
    "'{name}' is being edited; go back to Object Mode first",
    lambda obj: obj.mode != "OBJECT",
    Remedy.OBJECT_MODE,
    any_kind=True,
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
        _unless_baked(lambda obj: (own := obj.data.animation_data) and (own.action or own.nla_tracks)),
        Remedy.COPY,
    ),
    Check(
        "Points of '{name}' are driven; remove the drivers or relax a copy without them",
        _unless_baked(
            lambda obj: (
                (own := obj.data.animation_data) and any(each.data_path.startswith("splines") for each in own.drivers)
            )
        ),
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
    Check(
        "'{name}' has no keys of Möbius Flow; press Relax first",
        lambda obj: obj.type != "CURVE" or not bake.was_baked(obj.data),
        any_kind=True,
    ),
)
_UNKEYED = Curves(_OBJECT_MODE, *_OWN, *_OWN_KEYS)

_RELAXABLE = (
    *(_OBJECT_MODE, *_OWN, *_SPLINES, *_OWN_KEYS),
    Check(
        "{deformer} moves its points, so that strands may be seen to cross; remove it, or relax a copy without it",
        what_deforms,
        Remedy.COPY,
        "deformer",
    ),
    Check("'{name}' is scaled to nothing in some direction; give it a scale other than 0", _is_flat, any_kind=True),
    Check(
        "'{name}' is moved by {mover}, and curves relaxed together must keep their places; "
        "remove that, or relax each curve alone",
        what_moves,
        Remedy.COPY,
        "mover",
        together=True,
        any_kind=True,
    ),
)
RELAXABLE = Curves(*_RELAXABLE)
ENTERABLE = Curves(*_RELAXABLE, among=relaxed_together)
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
TUBED = Curves(
    Check(
        "'{name}' has no bevel depth; set it to the rope's radius first (Object Data properties, Geometry > Bevel)",
        lambda obj: not splines.depth(obj.data),
    ),
    Check(
        "'{name}' has no thickness; give its points an attribute named radius first",
        lambda obj: obj.type == "MESH" and "radius" not in obj.data.attributes,
        any_kind=True,
    ),
    among=relaxed_together,
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
    ),
    among=relaxed_together,
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
