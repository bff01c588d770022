"""What is refused, as the sidebar shows it: the sentence, and below it the button that mends it."""

import bpy

from ..live.refusal import Refusal
from .labels import sentence


def refused(layout: bpy.types.UILayout, context: bpy.types.Context, refusal: Refusal) -> None:
    """Show a refusal."""
    sentence(layout, context, refusal.sentence)
    if refusal.remedy is not None:
        layout.operator(refusal.remedy.value, icon="TOOL_SETTINGS")
