"""The operator that relaxes: it checks, starts a session, and says what happened."""

from typing import Any

import bpy
from bpy.props import BoolProperty, StringProperty

from ...core import MobiusFlowError
from ..live.avoided import avoided
from ..live.checks import refusal, selected_curves
from ..live.refusal import Refusal
from ..live.start import LiveRelax, tell
from ..properties import SETTINGS, settings
from ..scripting import Relaxation
from ..scripting.settings import implied
from ..translations import rpt_
from .refusing import Refusing


class Relaxing(LiveRelax, Refusing):
    """What all operators that relax have in common: their settings, and the whole job in one call."""

    # For scripts; what is not given comes from the scene's settings, and nothing is remembered from run to run.
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

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """Say why the selected curves cannot be relaxed in this way, or return None if they can."""
        return refusal(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do the whole job."""
        context.view_layer.update()  # a script may have moved the object just before
        try:
            values = self.values(context)
            if refused := self.refusal(context):
                raise MobiusFlowError(refused.sentence)
            relaxation = Relaxation(*selected_curves(context), sample_splines=self.sample_splines)
            report = (relaxation.relax_further if self.continues else relaxation.relax)(**values)
        except MobiusFlowError as error:
            self.report({"ERROR"}, rpt_(str(error)))
            return {"CANCELLED"}
        except MemoryError:
            sentence = "Memory ran out; all is as it was. Take fewer Vertices or Max Iterations"
            self.report({"ERROR"}, rpt_(sentence))
            return {"CANCELLED"}
        tell(self, context.scene, report)
        return {"FINISHED"}

    def values(self, context: bpy.types.Context) -> dict[str, Any]:
        """The settings: those given to the operator, and the scene's; raises MobiusFlowError."""
        scene = context.scene.mobius_flow
        given = self.properties.is_property_set
        values = {name: getattr(self if given(name) else scene, name) for name in SETTINGS}
        avoid = avoided(context, self.avoid if given("avoid") else None)
        return values | implied([name for name in SETTINGS if given(name)]) | {"avoid": avoid}


class CURVE_OT_mobius_flow_relax(Relaxing, bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
    """Relax the selected curves together, never through themselves or each other, and keep the motion as keyframes"""

    bl_idname = "curve.mobius_flow_relax"
    bl_label = "Relax"


CLASSES = (CURVE_OT_mobius_flow_relax,)
