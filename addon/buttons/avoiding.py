"""The button that lets curves avoid what is near them."""

import bpy

from ...core.messages import Message
from ..curves import neighbours, surroundings
from ..engine.words import named
from ..live.avoided import avoided
from ..live.checks import running, selected_curves
from ..live.refusal import Refusal
from ..translations import rpt_
from .refusing import Refusing


class CURVE_OT_mobius_flow_avoid(Refusing, bpy.types.Operator):  # noqa: N801 - Blender's naming scheme
    """Let relaxed curves never touch what is near them now: put it into the collection Avoid, besides those it is in"""

    bl_idname = "curve.mobius_flow_avoid"
    bl_label = "Add to Avoid"

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """There must be something, and nothing is being relaxed."""
        if reason := running():
            return reason
        near = _near(context)
        return None if near else Refusal(Message("Nothing is near the selected curves but what they avoid"))

    def act(self, context: bpy.types.Context) -> None:
        """Add all that is near."""
        found = _near(context)
        collection = surroundings.add(context.scene, found)
        names = named([obj.name for obj in found])
        self.report({"INFO"}, rpt_("'{collection}' has {names} now", collection=collection.name, names=names))


def _near(context: bpy.types.Context) -> list[bpy.types.Object]:
    return neighbours.near(context, selected_curves(context), avoided(context))


CLASSES = (CURVE_OT_mobius_flow_avoid,)
