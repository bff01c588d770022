"""The operators that relax, anew or further, and those for the resulting animations."""

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

from ...core.base import Message
from ..curves import bake, pins
from ..curves.session import Session
from ..curves.splines import questions
from ..curves.strands import Strands
from ..live import registry
from ..live.modal import Listening, report_result, unseen
from ..live.refresh import Refresh
from ..live.requirements import BAKED, CLEARABLE, ENTERABLE, POLYGONS, RELAXABLE, TUBED, Condition
from ..live.run import LiveRun
from ..live.selection import avoided, container, relaxed_together, selected_curves, shown_curves
from ..properties import SETTINGS, settings
from ..scripting import Relaxation, begin, implied
from ..translations import rpt_
from .button import Button, LiveButton, button, offer

_ANIMATED = Condition(
    "Select a curve that was baked first", lambda context: bake.scene_range(shown_curves(context)) is None
)
_PICKED = Condition(
    "Pick a mesh as the container first", lambda context: context.scene.mobius_flow_surroundings.container is None
)
_INSIDE = Condition("Put the curves inside the container first", lambda context: container(context) is None)
_SEVERAL = Condition(
    "Select a curve, and then the one that it is to become",
    lambda context: context.active_object not in relaxed_together(context) or len(relaxed_together(context)) < 2,
)


class Relaxing(Listening, LiveButton):
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
        "again": BoolProperty(
            name="Start Again",
            description="Replace the keys of curves that have some without asking",
            options={"SKIP_SAVE", "HIDDEN"},
        ),
    }
    needs = (ENTERABLE,)
    continues = False  # whether baked curves are relaxed on from the ends of their animations
    stays = False  # whether a live run waits for a hand where it comes to rest

    def asks(self, context: bpy.types.Context) -> bool:
        """Ask if keys are replaced, or smooth splines have to become polygons."""
        name, relax = type(self).bl_idname, CURVE_OT_mobius_flow_relax.bl_idname
        keyed = (obj for obj in self.moving(context) if obj.type == "CURVE" and bake.is_baked(obj.data))
        if not (self.again or self.continues) and any(keyed):
            further = {Message("Continue from the Last Key"): ("curve.mobius_flow_continue", {})}
            anew = {Message("Start Again, and Replace the Keys"): (name, {"again": True})}
            return offer(context, Message("Already Animated"), (further if name == relax else {}) | anew)
        context.view_layer.update()
        if self.sample_splines or not POLYGONS.of(selected_curves(context)):
            return False
        sample = {Message("Sample and Relax"): (name, {"sample_splines": True, "again": True})}
        more = Message("For more or fewer points change the curve's Resolution Preview U.")
        return offer(context, Message("Smooth Splines"), sample, [*questions(selected_curves(context)), more])

    def begin(self, context: bpy.types.Context) -> set[str]:
        values = self.values(context)
        run = LiveRun(self.session(context, values), Refresh(values["view_every"]), self.stays)
        registry.begin(run)
        return self.listen(context, run)

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            return super().execute(context)
        except MemoryError:
            sentence = "Memory ran out; all is as it was. Write fewer vertices or max_iterations into Further Options"
            self.report({"ERROR"}, rpt_(sentence))
            return {"CANCELLED"}

    def act(self, context: bpy.types.Context) -> None:
        report_result(self, context.scene, self.session(context, self.values(context)).run())

    def moving(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        """The objects that get keys."""
        return relaxed_together(context)

    def more(self, _context: bpy.types.Context) -> dict[str, Any]:
        """What `begin` is told besides."""
        return {}

    def session(self, context: bpy.types.Context, values: dict[str, Any]) -> Session:
        """Begin to relax the selected curves; raises MobiusFlowError."""
        return begin(self.moving(context), values, self.continues, self.sample_splines, **self.more(context))

    def values(self, context: bpy.types.Context) -> dict[str, Any]:
        """The settings: those given to the operator, and the scene's; raises MobiusFlowError."""
        scene = context.scene.mobius_flow
        given = self.properties.is_property_set
        values = {name: getattr(self if given(name) else scene, name) for name in SETTINGS}
        avoid = avoided(context, self.avoid if given("avoid") else None)
        return values | implied([name for name in SETTINGS if given(name)]) | {"avoid": avoid}


class CURVE_OT_mobius_flow_relax(Relaxing, bpy.types.Operator):
    """Relax the selected curves together, never through themselves or each other, and keep the motion as keyframes. \
Asks first whether curves that have keys go on from their end; in a script they begin anew"""

    bl_label = "Relax"


def _in_turn(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The curve that morphs, and what it becomes before it is the active one."""
    return sorted((obj for obj in relaxed_together(context) if obj != context.active_object), key=lambda obj: obj.name)


class CURVE_OT_mobius_flow_morph(Relaxing, bpy.types.Operator):
    """Let the selected curve become the active one by a motion that never passes through itself, and keep it as \
keyframes; of several, the first by name moves, and becomes one after the other on its way. At the end the others are \
hidden, which would be in the same place (Alt H)"""

    bl_label = "Morph to Active"
    needs = (ENTERABLE, POLYGONS, _SEVERAL)

    def moving(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        return _in_turn(context)[:1]

    def more(self, context: bpy.types.Context) -> dict[str, Any]:
        return {"goals": [*_in_turn(context)[1:], context.active_object]}


class CURVE_OT_mobius_flow_grab(Relaxing, bpy.types.Operator):
    """Relax the selected curves, and wait for strands to be dragged in the view until the shape is kept; curves with \
keys go on from the end of their animation. Of all shapes of one energy they come to the one that bends least"""

    bl_label = "Grab"
    stays = True

    @property
    def continues(self) -> bool:
        objects = relaxed_together(bpy.context)
        return all(obj.type == "CURVE" for obj in objects) and BAKED.of(objects) is None

    def values(self, context: bpy.types.Context) -> dict[str, Any]:
        """The settings of Relax, but lengths stay, for pins, and shapes are balanced, or knots would stay tiny."""
        values, pinned = super().values(context), sum(pins.count(obj.data) for obj in selected_curves(context))
        free = values["energy"] == "moebius" and not values["avoid"] and not pinned
        closed = free and all(all(Strands.of(obj).closed) for obj in relaxed_together(context))
        return values | {
            "keep_size": "LENGTH" if values["keep_size"] == "AUTO" else values["keep_size"],
            "balance": values["balance"] or closed,
        }


class CURVE_OT_mobius_flow_separate(Relaxing, bpy.types.Operator):
    """Make ropes of the selected curves, as thick as their bevels, that keep clear of themselves and each other, \
moved as little as that allows; ends and pins stay in place. Where two curves meet, the later one goes over"""

    bl_label = "Separate"
    needs = (ENTERABLE, POLYGONS, TUBED)

    over: EnumProperty(
        name="Over",
        description="Axis on whose side the later of two curves that meet goes over",
        items=[
            ("AUTO", "Automatic", "The direction in which curves extend least where they meet"),
            *((axis, axis, "") for axis in ("X", "Y", "Z", "-X", "-Y", "-Z")),
        ],
        options={"SKIP_SAVE"},
    )
    keep_lengths: BoolProperty(
        name="Keep Lengths", description="Let no segment change its length", options={"SKIP_SAVE"}
    )
    free_ends: BoolProperty(name="Free Ends", description="Hold ends only if they are pinned", options={"SKIP_SAVE"})

    def more(self, _context: bpy.types.Context) -> dict[str, Any]:
        over, lengths = None if self.over == "AUTO" else self.over.lower(), "keep" if self.keep_lengths else "free"
        return {"ropes": {"over": over, "lengths": lengths, "free_ends": self.free_ends}}


class CURVE_OT_mobius_flow_tighten(Relaxing, bpy.types.Operator):
    """Pull the selected knots tight, open ones by their ends, as ropes as thick as their bevels, and keep the motion \
as keyframes. Tube Mesh then shows where they press on each other"""

    bl_label = "Tighten"
    needs = (ENTERABLE, POLYGONS)

    starts: IntProperty(
        name="Starts",
        description="Starts on few vertices, all but the first drawn anew; the shortest go on to the end. \
Nothing is seen before; Keep then shows the shortest so far",
        default=1,
        min=1,
        options={"SKIP_SAVE"},
    )

    def more(self, _context: bpy.types.Context) -> dict[str, Any]:
        return {"starts": self.starts}


class CURVE_OT_mobius_flow_pack(Relaxing, bpy.types.Operator):
    """Let the selected curves grow inside the container, which they never touch, until it is full or you press Keep"""

    bl_label = "Pack"
    needs = (ENTERABLE, _PICKED, _INSIDE)

    def values(self, context: bpy.types.Context) -> dict[str, Any]:
        """The settings of Relax, but curves grow, and always avoid the container."""
        values = super().values(context)
        if not self.properties.is_property_set("grow"):
            values["grow"] = 20.0  # times its length: more than any curve reaches in a container that it is to fill
        return values | {"avoid": [*values["avoid"], container(context)]}


class CURVE_OT_mobius_flow_bake_again(Relaxing, bpy.types.Operator):
    """Relax the selected curves anew from how they were before they were baked; new keys replace the old ones"""

    bl_label = "Bake Again"
    needs = (RELAXABLE, BAKED)


class CURVE_OT_mobius_flow_continue(Relaxing, bpy.types.Operator):
    """Relax the selected curves on from the end of their animation, with the points that they have; new keys follow \
the old ones"""

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
