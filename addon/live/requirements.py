"""Requirements of operators on curves and scenes: a failed one gives a sentence, and a remedy if there is one."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

import bpy
import numpy as np

from ...core.base import Message, MobiusFlowError
from ..curves import bake, bevel, splines
from ..curves.keyframes import count_own, fcurves_of
from ..curves.moving import what_deforms, what_moves
from . import registry
from .selection import convertible, curves_at_hand, relaxed_together, selected_curves, shown_curves


class Remedy(Enum):
    """A remedy for a refusal, which the operator *Mend* applies; the values say on its button what it does."""

    OBJECT_MODE = "Back to Object Mode"
    MAKE_LOCAL = "Make Local"
    SINGLE_USER = "Make Single User"
    TO_CURVE = "Convert to Curve"
    TO_POLY = "Convert to Poly"
    MAKE_3D = "Make 3D"
    COPY = "Make Still Copy"


@dataclass(frozen=True)
class Refusal:
    """Why something cannot be done and what helps, in one sentence, and the button that does so, if there is one."""

    sentence: Message
    remedy: Remedy | None = None


Requirement = Callable[[bpy.types.Context], Refusal | None]
_Examine = Callable[[bpy.types.Object], Iterator[Refusal]]
_Choice = Callable[[bpy.types.Context], list[bpy.types.Object]]


@dataclass(frozen=True)
class Condition:
    """A requirement on the scene, or on everything selected."""

    sentence: str
    fails: Callable[[bpy.types.Context], bool]

    def __call__(self, context: bpy.types.Context) -> Refusal | None:
        return Refusal(Message(self.sentence)) if self.fails(context) else None


class Curves:
    """The requirement that there are curve objects, all of which pass examinations, while nothing is being relaxed.

    ``others``: those that objects of other kinds have to pass.
    """

    def __init__(self, *curves: _Examine, others: Sequence[_Examine] = (), among: _Choice = selected_curves) -> None:
        self._curves, self._others, self._among = curves, others, among

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

    def of(self, objects: Sequence[bpy.types.Object], several: bool | None = None) -> Refusal | None:
        """The first refusal of an object; ``several``: whether others are relaxed together with them."""
        several = len(objects) > 1 if several is None else several
        pairs = ((obj, each) for obj in objects for each in (self._curves if obj.type == "CURVE" else self._others))
        found = (refusal for obj, examine in pairs if several or examine is not _moved for refusal in examine(obj))
        return next(found, None)


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


def _refused(obj: bpy.types.Object, sentence: str, remedy: Remedy | None = None, **values: Any) -> Refusal:
    return Refusal(Message(sentence, name=obj.name, **values), remedy)


def _edited(obj: bpy.types.Object) -> Iterator[Refusal]:
    if obj.mode != "OBJECT":
        yield _refused(obj, "'{name}' is being edited; go back to Object Mode first", Remedy.OBJECT_MODE)


def _shared(obj: bpy.types.Object) -> Iterator[Refusal]:
    if obj.library or obj.data.library:
        sentence = "'{name}' is linked from another file; make it local first (Object > Relations > Make Local)"
        yield _refused(obj, sentence, Remedy.MAKE_LOCAL)
    if obj.override_library or obj.data.override_library:
        sentence = "'{name}' is a library override; make it local first (Object > Relations > Make Local)"
        yield _refused(obj, sentence, Remedy.MAKE_LOCAL)
    if obj.data.users - obj.data.use_fake_user > 1:
        sentence = (
            "'{name}' shares its curve data '{data}' with other objects; make it single-user first "
            "(Object > Relations > Make Single User)"
        )
        yield _refused(obj, sentence, Remedy.SINGLE_USER, data=obj.data.name)


def _unreadable(obj: bpy.types.Object) -> Iterator[Refusal]:
    if obj.data.dimensions != "3D":
        sentence = "'{name}' is a 2D curve; set its Shape to 3D first (Object Data properties)"
        yield _refused(obj, sentence, Remedy.MAKE_3D)
    if not obj.data.splines:
        yield _refused(obj, "'{name}' has no splines; give it at least one poly spline")
    for number, spline in enumerate(obj.data.splines, 1):
        fewest = 3 if spline.use_cyclic_u and spline.type != "BEZIER" else 2
        if len(splines.control_points(spline)) < fewest:
            sentence = "Spline {number} of '{name}' has fewer than {fewest} points; give it more, or delete it"
            yield _refused(obj, sentence, number=number, fewest=fewest)


def _keyed(obj: bpy.types.Object) -> Iterator[Refusal]:
    """Keys of somebody else's; a curve that was baked, and has no keys any more, is like any other."""
    own, keys = obj.data.animation_data, obj.data.shape_keys
    moving = own and (own.action or own.nla_tracks)
    driven = own and any(each.data_path.startswith("splines") for each in own.drivers)
    if bake.is_baked(obj.data) or not (keys or moving or driven):
        return
    yield from _changed(obj)
    if keys:
        yield _refused(obj, "'{name}' has shape keys; remove them or relax a copy without them", Remedy.COPY)
    if moving:
        sentence = "The curve data of '{name}' is animated; remove the animation or relax a copy without it"
        yield _refused(obj, sentence, Remedy.COPY)
    sentence = "Points of '{name}' are driven; remove the drivers or relax a copy without them"
    yield _refused(obj, sentence, Remedy.COPY)


def _changed(obj: bpy.types.Object) -> Iterator[Refusal]:
    if _has_coordinate_curves(obj):
        yield _refused(obj, "'{name}' has keys of an earlier version; press Clear first")
    yield from _edited_since(obj)


def _edited_since(obj: bpy.types.Object) -> Iterator[Refusal]:
    if bake.was_baked(obj.data) and not bake.is_baked(obj.data) and not _has_coordinate_curves(obj):
        sentence = "'{name}' has other keys or points than it was baked with; undo that, or relax a copy"
        yield _refused(obj, sentence, Remedy.COPY)


def _has_coordinate_curves(obj: bpy.types.Object) -> bool:
    """Whether an earlier version has keyed the coordinates of its points, each by an F-curve."""
    ours = bake.was_baked(obj.data) and count_own(obj.data) is not None
    return ours and any(".points[" in curve.data_path for curve in fcurves_of(obj.data))


def _unkeyed(obj: bpy.types.Object) -> Iterator[Refusal]:
    if obj.type != "CURVE" or not bake.was_baked(obj.data):
        yield _refused(obj, "'{name}' has no keys of Möbius Flow; press Relax first")


def _rekeyed(obj: bpy.types.Object) -> Iterator[Refusal]:
    if bake.is_baked(obj.data) and bake.is_edited(obj.data):
        sentence = "Keys of '{name}' were edited; undo that, or remove the keys to relax the curve as it is"
        yield _refused(obj, sentence, Remedy.COPY)


def _deformed(obj: bpy.types.Object) -> Iterator[Refusal]:
    if deformer := what_deforms(obj):
        sentence = (
            "{deformer} moves its points, so that strands may be seen to cross; remove it, or relax a copy without it"
        )
        yield _refused(obj, sentence, Remedy.COPY, deformer=deformer)


def _flat(obj: bpy.types.Object) -> Iterator[Refusal]:
    matrix = np.array(obj.matrix_world, dtype=np.float64)
    scales = np.linalg.svd(matrix[:3, :3], compute_uv=False) if np.isfinite(matrix).all() else np.zeros(3)
    if not scales[2] > 1e-6 * scales[0]:  # matrices of smaller ratios cannot be inverted in 32 bits
        yield _refused(obj, "'{name}' is scaled to nothing in some direction; give it a scale other than 0")


def _moved(obj: bpy.types.Object) -> Iterator[Refusal]:
    """What keeps curves from being relaxed together, but not one alone."""
    if mover := what_moves(obj):
        sentence = (
            "'{name}' is moved by {mover}, and curves relaxed together must keep their places; "
            "remove that, or relax each curve alone"
        )
        yield _refused(obj, sentence, Remedy.COPY, mover=mover)


def _unfit(obj: bpy.types.Object) -> Iterator[Refusal]:
    if not bevel.can_fit(obj.data):
        yield _refused(
            obj, "'{name}' has a profile, taper, extrusion, offset or point radii of its own; remove them first"
        )


def _thin(obj: bpy.types.Object) -> Iterator[Refusal]:
    if obj.type == "CURVE" and not splines.depth(obj.data):
        sentence = (
            "'{name}' has no bevel depth; set it to the rope's radius first (Object Data properties, Geometry > Bevel)"
        )
        yield _refused(obj, sentence)
    if obj.type == "MESH" and "radius" not in obj.data.attributes:
        yield _refused(obj, "'{name}' has no thickness; give its points an attribute named radius first")


def _smooth(obj: bpy.types.Object) -> Iterator[Refusal]:
    for number, spline in enumerate(obj.data.splines, 1):
        if spline.type != "POLY":
            sentence = (
                "Spline {number} of '{name}' is a {kind} spline; convert it to Poly first "
                "(Edit Mode, Curve > Set Spline Type > Poly), or set Sample Splines"
            )
            yield _refused(obj, sentence, Remedy.TO_POLY, number=number, kind=splines.kind(spline))


_RELAXABLE = (_edited, _shared, _unreadable, _keyed, _deformed, _flat, _moved)
RELAXABLE = Curves(*_RELAXABLE)
ENTERABLE = Curves(*_RELAXABLE, others=(_edited, _flat, _moved), among=relaxed_together)
READABLE = Curves(_edited, _unreadable, others=(_edited,))
FILMABLE = Curves(_edited, _unreadable, among=shown_curves)
PAINTABLE = Curves(_edited, _unreadable, _shared)
FITTABLE = Curves(_edited, _unreadable, _shared, _unfit)
TUBED = Curves(_thin, others=(_thin,), among=relaxed_together)
PINNABLE = Curves(_shared, among=curves_at_hand)
BAKED = Curves(_changed, _unkeyed, others=(_unkeyed,))
CLEARABLE = Curves(_edited_since, _unkeyed, _edited, _shared, others=(_unkeyed,))
UNEDITED = Curves(_rekeyed)
POLYGONS = Curves(_smooth, among=relaxed_together)
_POSSIBLE = Curves(*_RELAXABLE, _smooth)


def needing(objects: Sequence[bpy.types.Object], remedy: Remedy) -> Iterator[bpy.types.Object]:
    """Yield the curve objects whose first refusal has this remedy, examining each in its turn."""
    for obj in objects:
        refusal = _POSSIBLE.of([obj], several=len(objects) > 1)
        if refusal is not None and refusal.remedy is remedy:
            yield obj
