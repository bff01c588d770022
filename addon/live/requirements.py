"""Requirements of operators on curves and scenes: a failed one gives a sentence, and a remedy if there is one."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

import bpy

from ...core import MobiusFlowError
from ...core.messages import Message
from ..curves.exchange import box
from ..curves.surroundings import TUBE_OF, avoidable
from . import registry


class Remedy(Enum):
    """A remedy for a refusal; the values are operators of `buttons.mending`."""

    OBJECT_MODE = "curve.mobius_flow_object_mode"
    MAKE_LOCAL = "curve.mobius_flow_make_local"
    SINGLE_USER = "curve.mobius_flow_single_user"
    TO_CURVE = "curve.mobius_flow_to_curve"
    TO_POLY = "curve.mobius_flow_to_poly"
    MAKE_3D = "curve.mobius_flow_make_3d"
    COPY = "curve.mobius_flow_copy"


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
    what is required only of curves that are relaxed together.
    """

    sentence: str
    failure: Callable[[bpy.types.Object], Any]
    remedy: Remedy | None = None
    field: str = ""
    together: bool = False

    def refusal(self, obj: bpy.types.Object) -> Refusal | None:
        if not (found := self.failure(obj)):
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


def selected_curves(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The curve objects that are relaxed together: all that are selected, whichever is active."""
    return [obj for obj in context.selected_objects if obj.type == "CURVE"]


def shown_curves(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The curve objects whose motion is seen: those selected, and those that selected tubes' meshes were made of."""
    made_of = (obj.get(TUBE_OF, obj) for obj in context.selected_objects)
    there = (obj for obj in made_of if obj is not None and obj.name in context.scene.objects)
    return [obj for obj in dict.fromkeys(there) if obj.type == "CURVE"]


def curves_at_hand(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The curve objects that are being edited, or the selected ones where none is."""
    return list(context.objects_in_mode) if context.mode == "EDIT_CURVE" else selected_curves(context)


class Curves:
    """The requirement that there are curve objects, all of which pass some checks, while nothing is being relaxed."""

    def __init__(self, *checks: Check, among: _Choice = selected_curves) -> None:
        self.checks, self._among = checks, among

    def __call__(self, context: bpy.types.Context) -> Refusal | None:
        objects = self._among(context)
        return idle(context) or (self.of(objects) if objects else _no_curve(context))

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


def _no_curve(context: bpy.types.Context) -> Refusal:
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


def convertible(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected objects of this file that lines can be made of: texts, and meshes of edges alone."""
    own = (obj for obj in context.selected_objects if not (obj.library or obj.override_library))
    texts_and_meshes = (obj for obj in own if obj.type in ("FONT", "MESH"))
    return [obj for obj in texts_and_meshes if obj.type == "FONT" or (obj.data.edges and not obj.data.polygons)]


def avoided(context: bpy.types.Context, name: str | None = None) -> list[bpy.types.Object]:
    """What the selected curves must not touch: visible objects of a collection, and the container they lie in.

    The collection is the scene's, or one given by name, and then there is no container. An empty name means to avoid
    nothing; raises MobiusFlowError if there is no collection of that name.
    """
    collection = context.scene.mobius_flow_surroundings.avoid if name is None else bpy.data.collections.get(name)
    if name and collection is None:
        raise MobiusFlowError(Message("There is no collection '{name}' to avoid", name=name))
    found = list(avoidable(collection, selected_curves(context)))
    outer = container(context) if name is None else None
    return found if outer is None or outer in found or not outer.visible_get() else [*found, outer]


def container(context: bpy.types.Context) -> bpy.types.Object | None:
    """The mesh that was picked as a container, if the boxes of all selected curves lie in its own."""
    outer, curves = context.scene.mobius_flow_surroundings.container, selected_curves(context)
    if outer is None or not curves:
        return None
    (low, high), boxes = box(outer), map(box, curves)
    return outer if all((low <= least).all() and (most <= high).all() for least, most in boxes) else None
