"""What can be done with curves that were baked before: bake again, continue, clear, and fit the scene's frames."""

import bpy

from ..curves import bake
from ..live.checks import refusal, selected_curves, unbaked, unclearable
from ..live.refusal import Refusal
from ..live.start import unseen
from ..scripting import Relaxation
from ..translations import rpt_, tip_
from .refusing import Refusing
from .relaxing import Relaxing


class Rebaking(Relaxing):
    """What operators that relax baked curves have in common."""

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """Say why the selected curves cannot be relaxed again, or return None if they can."""
        return refusal(context) or unbaked(context)


class CURVE_OT_mobius_flow_bake_again(Rebaking, bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
    """Relax the selected curves anew from how they were before they were baked; new keys replace the old ones"""

    bl_idname = "curve.mobius_flow_bake_again"
    bl_label = "Bake Again"


class CURVE_OT_mobius_flow_continue(Rebaking, bpy.types.Operator):  # noqa: N801
    """Relax the selected curves on from the end of their animation, with the points that they have, whatever \
Vertices says; new keys follow the old ones"""

    bl_idname = "curve.mobius_flow_continue"
    bl_label = "Continue"
    continues = True


class CURVE_OT_mobius_flow_clear(Refusing, bpy.types.Operator):  # noqa: N801
    """Take the keys away and give the selected curves back as they were before they were baked"""

    bl_idname = "curve.mobius_flow_clear"
    bl_label = "Clear"

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """Baked curves are wanted."""
        return unclearable(context)

    def act(self, context: bpy.types.Context) -> None:
        """Clear all of them."""
        Relaxation(*selected_curves(context)).clear()


class CURVE_OT_mobius_flow_scene_range(bpy.types.Operator):  # noqa: N801
    """Let the scene play all frames of the selected curves' animation, and no others"""

    bl_idname = "curve.mobius_flow_scene_range"
    bl_label = "Set Scene Range"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether a baked curve is selected."""
        cls.poll_message_set(tip_("Select a curve that was baked first"))
        return bake.scene_range(selected_curves(context)) is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Set the range."""
        scene, animation = context.scene, bake.scene_range(selected_curves(context))
        scene.frame_start, scene.frame_end = animation
        if hidden := unseen(scene, animation):
            self.report({"WARNING"}, rpt_(hidden))
        return {"FINISHED"}


CLASSES = (
    CURVE_OT_mobius_flow_bake_again,
    CURVE_OT_mobius_flow_continue,
    CURVE_OT_mobius_flow_clear,
    CURVE_OT_mobius_flow_scene_range,
)
