"""Where a relaxed curve rests: told, and left for a better shape or a lower energy."""

from contextlib import suppress
from typing import Any

import bpy

from ...core import MobiusFlowError, Task
from ...core.messages import Message
from ..curves.baked_keys import BakedKeys
from ..curves.pins import pinned_vertices
from ..curves.surroundings import Surroundings
from ..engine.rest import Rest
from ..engine.words import named
from ..live.avoided import avoided
from ..live.checks import edited, selected_curves
from ..live.refusal import Refusal
from ..properties import SETTINGS, relax_options
from ..translations import rpt_
from .baking import Rebaking
from .refusing import Refusing


class CURVE_OT_mobius_flow_balance(Rebaking, bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
    """Go on to the shape of the same energy that bends least for its length; new keys follow the old ones"""

    bl_idname = "curve.mobius_flow_balance"
    bl_label = "Balance"
    continues = True

    def values(self, context: bpy.types.Context) -> dict[str, Any]:
        """The settings, with balance."""
        return super().values(context) | {"balance": True}


class CURVE_OT_mobius_flow_check(Refusing, bpy.types.Operator):  # noqa: N801
    """Tell whether the selected curves have come to rest at a minimum of the energy or at a saddle; nothing changes"""

    bl_idname = "curve.mobius_flow_check"
    bl_label = "Check"
    bl_options = {"REGISTER"}  # noqa: RUF012 - nothing to undo

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """Baked curves are wanted."""
        return Rebaking.refusal(context)

    def last_refusal(self, context: bpy.types.Context) -> Refusal | None:
        """Nobody has edited their keys."""
        return edited(context)

    def act(self, context: bpy.types.Context) -> None:
        """Look at the end of the animation."""
        values = {name: getattr(context.scene.mobius_flow, name) for name in SETTINGS}
        self.report({"INFO"}, rpt_(_told(context, _rest(context, values | {"avoid": avoided(context)}))))


class CURVE_OT_mobius_flow_leave_saddle(Rebaking, bpy.types.Operator):  # noqa: N801
    """Go on downhill where the selected curves rest on a saddle of the energy; new keys follow the old ones"""

    bl_idname = "curve.mobius_flow_leave_saddle"
    bl_label = "Leave Saddle"
    continues = True

    def values(self, context: bpy.types.Context) -> dict[str, Any]:
        """The settings, with the way off saddles."""
        return super().values(context) | {"escape_saddles": True}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do the whole job, if there is anything to leave."""
        return {"CANCELLED"} if self._at_minimum(context) else super().execute(context)

    def begin(self, context: bpy.types.Context, values: dict[str, Any]) -> set[str]:
        """Start the run, if there is anything to leave."""
        return {"CANCELLED"} if self._at_minimum(context) else super().begin(context, values)

    def _at_minimum(self, context: bpy.types.Context) -> bool:
        """Whether there is no way down, which is said; what else is wrong the relaxation tells."""
        with suppress(MobiusFlowError):
            rest = _rest(context, self.values(context))
            if rest.index == 0:
                self.report({"INFO"}, rpt_(_told(context, rest)))
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


def _told(context: bpy.types.Context, rest: Rest) -> Message:
    names = named([obj.name for obj in selected_curves(context)])
    return Message("{names}: {rest}", names=names, rest=rest.words)


CLASSES = (CURVE_OT_mobius_flow_balance, CURVE_OT_mobius_flow_check, CURVE_OT_mobius_flow_leave_saddle)
