"""What buttons that act at once have in common: they look, act, and say why they cannot."""

from typing import Any

import bpy

from ...core import MobiusFlowError
from ..live.modal import redraw_views


class Acting:
    """An operator that does all it does in one call, or nothing."""

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - read by Blender
    report: Any
    poll_message_set: Any

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str | None:
        """Say why it cannot be done, cheaply enough for every redraw, or return None if it can."""
        raise NotImplementedError

    def act(self, context: bpy.types.Context) -> None:
        """Do it; raises MobiusFlowError, and has changed nothing then."""
        raise NotImplementedError

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether it can be done; the tooltip says why not."""
        reason = cls.refusal(context)
        if reason:
            cls.poll_message_set(reason)
        return reason is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do it."""
        context.view_layer.update()  # a script may have moved an object just before
        try:
            if reason := self.refusal(context):
                raise MobiusFlowError(reason)
            self.act(context)
        except MobiusFlowError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        redraw_views(context.window_manager)
        return {"FINISHED"}

    def tell(self, what: str, unproved: int) -> None:
        """Say what was done, and whether the animation is proved still."""
        if unproved:
            self.report({"WARNING"}, f"{what}; {unproved} motions between keys are NOT proved free of contact")
        else:
            self.report({"INFO"}, f"{what}, proved free of contact")
