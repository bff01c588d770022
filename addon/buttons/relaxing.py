"""The operators that relax, anew or further, and those for the resulting animations."""

from contextlib import suppress
from typing import Any

import bpy
from bpy.props import BoolProperty, StringProperty

from ...core import MobiusFlowError, Task
from ...core.messages import Message
from ..curves import bake
from ..curves.baked_keys import BakedKeys
from ..curves.pins import pinned_vertices
from ..curves.session import Session
from ..curves.surroundings import Surroundings
from ..engine.rest import Rest
from ..engine.words import named
from ..live import registry
from ..live.checks import BAKED, CLEARABLE, POLYGONS, RELAXABLE, UNEDITED
from ..live.modal import Listening, report_result, unseen
from ..live.requirements import Condition, avoided, container, selected_curves, shown_curves
from ..live.run import Run
from ..live.viewing import Refresh
from ..properties import SETTINGS, relax_options, settings
from ..scripting import Relaxation, begin, implied
from ..translations import rpt_
from .button import Button, button

_ANIMATED = Condition(
    "Select a curve that was baked first", lambda context: bake.scene_range(shown_curves(context)) is None
)
_PICKED = Condition(
    "Pick a mesh as the container first", lambda context: context.scene.mobius_flow_surroundings.container is None
)
_INSIDE = Condition("Put the curves inside the container first", lambda context: container(context) is None)
_FULL = 20.0  # times its length: more than any curve reaches in a container that it is to fill
_SEVERAL = Condition(
    "Select a curve, and then the one that it is to become",
    lambda context: context.active_object not in selected_curves(context) or len(selected_curves(context)) < 2,
)


class Relaxing(Listening, Button):
    """The base of all operators that relax: the whole job in one call, or a live run in a window."""

    # For scripts; settings that are not given come from the scene, and nothing is remembered from run to run.
    __annotations__ = {
        **settings({"SKIP_SAVE", "HIDDEN"}),
        "sample_splines": BoolProperty(
            name="Sample Splines",
            description="Replace Bézier and NURBS splines by the polygons drawn for them",
            options={"SKIP_SAVE", "HIDDEN"},
        ),
        "avoid": StringProperty(
            name="Avoid",
            description="Name of the collection whose visible objects are never touched; empty for none",
            options={"SKIP_SAVE", "HIDDEN"},
        ),
    }
    needs = (RELAXABLE,)
    continues = False  # whether baked curves are relaxed on from the ends of their animations
    stays = False  # whether a live run waits for a hand where it comes to rest

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Relax the selected curves live; ask first if smooth splines have to become polygons."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        context.view_layer.update()
        if POLYGONS.of(selected_curves(context)) and not self.sample_splines:
            return set(bpy.ops.curve.mobius_flow_sample("INVOKE_DEFAULT")) and {"CANCELLED"}
        return self.begin(context)

    def begin(self, context: bpy.types.Context) -> set[str]:
        try:
            values = self.values(context)
            run = Run(self.session(context, values), Refresh(values["view_every"]), self.stays)
        except MobiusFlowError as error:
            return self.fail(error)
        registry.begin(run)
        return self.listen(context, run)

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            return super().execute(context)
        except MemoryError:
            sentence = "Memory ran out; all is as it was. Take fewer Vertices or Max Iterations"
            self.report({"ERROR"}, rpt_(sentence))
            return {"CANCELLED"}

    def act(self, context: bpy.types.Context) -> None:
        report_result(self, context.scene, self.session(context, self.values(context)).run())

    def session(self, context: bpy.types.Context, values: dict[str, Any]) -> Session:
        """Begin to relax the selected curves; raises MobiusFlowError."""
        return begin(selected_curves(context), values, self.continues, self.sample_splines)

    def values(self, context: bpy.types.Context) -> dict[str, Any]:
        """The settings: those given to the operator, and the scene's; raises MobiusFlowError."""
        scene = context.scene.mobius_flow
        given = self.properties.is_property_set
        values = {name: getattr(self if given(name) else scene, name) for name in SETTINGS}
        avoid = avoided(context, self.avoid if given("avoid") else None)
        return values | implied([name for name in SETTINGS if given(name)]) | {"avoid": avoid}


class CURVE_OT_mobius_flow_relax(Relaxing, bpy.types.Operator):
    """Relax the selected curves together, never through themselves or each other, and keep the motion as keyframes"""

    bl_label = "Relax"


class CURVE_OT_mobius_flow_morph(Relaxing, bpy.types.Operator):
    """Let the selected curve become the active one by a motion that never passes through itself, and keep it as \
keyframes; of several, the first by name moves, and becomes one after the other on its way"""

    bl_label = "Morph to Active"
    needs = (RELAXABLE, POLYGONS, _SEVERAL)

    def session(self, context: bpy.types.Context, values: dict[str, Any]) -> Session:
        active = context.active_object
        moving, *between = sorted(
            (obj for obj in selected_curves(context) if obj is not active), key=lambda obj: obj.name
        )
        return begin([moving], values, False, self.sample_splines, [*between, active])


class CURVE_OT_mobius_flow_grab(Relaxing, bpy.types.Operator):
    """Relax the selected curves, and wait for strands to be dragged in the view until the shape is kept; curves with \
keys go on from the end of their animation"""

    bl_label = "Grab"
    stays = True

    @property
    def continues(self) -> bool:
        return BAKED.of(selected_curves(bpy.context)) is None

    def values(self, context: bpy.types.Context) -> dict[str, Any]:
        """The settings of Relax, but lengths stay unless another size is asked for: pins are to stay where they are."""
        values = super().values(context)
        return values | ({"keep_size": "LENGTH"} if values["keep_size"] == "AUTO" else {})


class CURVE_OT_mobius_flow_pack(Relaxing, bpy.types.Operator):
    """Let the selected curves grow inside the container, which they never touch, until it is full or you press Keep"""

    bl_label = "Pack"
    needs = (RELAXABLE, _PICKED, _INSIDE)

    def values(self, context: bpy.types.Context) -> dict[str, Any]:
        """The settings of Relax, but curves grow, and always avoid the container."""
        values = super().values(context)
        if not self.properties.is_property_set("grow"):
            values["grow"] = _FULL
        return values | {"avoid": [*values["avoid"], container(context)]}


class CURVE_OT_mobius_flow_bake_again(Relaxing, bpy.types.Operator):
    """Relax the selected curves anew from how they were before they were baked; new keys replace the old ones"""

    bl_label = "Bake Again"
    needs = (RELAXABLE, BAKED)


class CURVE_OT_mobius_flow_continue(Relaxing, bpy.types.Operator):
    """Relax the selected curves on from the end of their animation, with the points that they have, whatever \
Vertices says; new keys follow the old ones"""

    bl_label = "Continue"
    needs = (RELAXABLE, BAKED)
    continues = True


@button("Clear", CLEARABLE)
def clear(_operator: Button, context: bpy.types.Context) -> None:
    """Take the keys away and give the selected curves back as they were before they were baked"""
    Relaxation(*selected_curves(context)).clear()


@button("Set Scene Range", _ANIMATED)
def scene_range(operator: Button, context: bpy.types.Context) -> None:
    """Let the scene play all frames of the selected curves' animation, and no others"""
    scene, animation = context.scene, bake.scene_range(shown_curves(context))
    scene.frame_start, scene.frame_end = animation
    if hidden := unseen(scene, animation):
        operator.report({"WARNING"}, rpt_(hidden))


class CURVE_OT_mobius_flow_balance(Relaxing, bpy.types.Operator):
    """Go on to the shape of the same energy that bends least for its length; new keys follow the old ones"""

    bl_label = "Balance"
    needs = (RELAXABLE, BAKED)
    continues = True

    def values(self, context: bpy.types.Context) -> dict[str, Any]:
        return super().values(context) | {"balance": True}


@button("Check", RELAXABLE, BAKED, needs_at_last=(UNEDITED,), bl_options={"REGISTER"})  # nothing to undo
def check(operator: Button, context: bpy.types.Context) -> None:
    """Tell whether the selected curves have come to rest at a minimum of the energy or at a saddle; nothing changes"""
    values = {name: getattr(context.scene.mobius_flow, name) for name in SETTINGS}
    operator.report({"INFO"}, rpt_(_described(context, _rest(context, values | {"avoid": avoided(context)}))))


class CURVE_OT_mobius_flow_leave_saddle(Relaxing, bpy.types.Operator):
    """Go on downhill where the selected curves rest on a saddle of the energy; new keys follow the old ones"""

    bl_label = "Leave Saddle"
    needs = (RELAXABLE, BAKED)
    continues = True

    def values(self, context: bpy.types.Context) -> dict[str, Any]:
        return super().values(context) | {"escape_saddles": True}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do the whole job, if there is a saddle to leave."""
        return {"CANCELLED"} if self._at_minimum(context) else super().execute(context)

    def begin(self, context: bpy.types.Context) -> set[str]:
        return {"CANCELLED"} if self._at_minimum(context) else super().begin(context)

    def _at_minimum(self, context: bpy.types.Context) -> bool:
        """Whether the curves rest at a minimum, which is reported; other errors are left to the relaxation."""
        with suppress(MobiusFlowError):
            rest = _rest(context, self.values(context))
            if rest.index == 0:
                self.report({"INFO"}, rpt_(_described(context, rest)))
                return True
        return False


def _rest(context: bpy.types.Context, values: dict[str, Any]) -> Rest:
    """Where the selected curves rest; raises MobiusFlowError."""
    context.view_layer.update()
    objects = selected_curves(context)
    keys = BakedKeys(objects)
    task = Task(
        curve=keys.curves[-1],
        obstacles=Surroundings.of(values["avoid"], objects).obstacles,
        pins=pinned_vertices(objects, keys.mesh),
    )
    return Rest.of(task, relax_options({**values, "balance": False}))


def _described(context: bpy.types.Context, rest: Rest) -> Message:
    names = named([obj.name for obj in selected_curves(context)])
    return Message("{names}: {rest}", names=names, rest=rest.words)
