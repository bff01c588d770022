"""What operators that may be refused have in common: the tooltip and scripts are told why, and nothing has happened."""

from collections.abc import Callable

import bpy

from ...core import MobiusFlowError
from ..live.modal import redraw_views
from ..live.refusal import Refusal
from ..translations import rpt_, tip_


class Refusing:
    """An operator that says why it cannot be used, and otherwise acts."""

    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - read by Blender
    poll_message_set: Callable[[str], None]
    report: Callable[[set[str], str], None]

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        """Say why it cannot be used, or return None if it can; asked at every redraw."""
        raise NotImplementedError

    def last_refusal(self, _context: bpy.types.Context) -> Refusal | None:
        """The same, asked just before it acts."""
        return None

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether it can be used; the tooltip says why not."""
        refused = cls.refusal(context)
        if refused:
            cls.poll_message_set(tip_(refused.sentence))
        return refused is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Act, if nothing is against it."""
        context.view_layer.update()  # a script may have moved an object just before
        try:
            if refused := self.refusal(context) or self.last_refusal(context):
                raise MobiusFlowError(refused.sentence)
            self.act(context)
        except MobiusFlowError as error:
            self.report({"ERROR"}, rpt_(str(error)))
            return {"CANCELLED"}
        redraw_views(context.window_manager)  # which they are not by themselves where keys were changed
        return {"FINISHED"}

    def act(self, context: bpy.types.Context) -> None:
        """Do what it is for; raises MobiusFlowError before anything has changed."""
        raise NotImplementedError
