"""The base of operators: if one cannot be used, tooltips and scripts get the reason, and nothing changes."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import bpy

from ...core.base import Message, MobiusFlowError
from ..live.modal import redraw_views
from ..live.requirements import Refusal, Requirement, first, require
from ..translations import iface_, rpt_, tip_

_Act = Callable[[Any, Any], object]
_Given = Mapping[str, Any]
_PREFIX = "CURVE_OT_"


class Button:
    """An operator that acts if all that it needs is there, and otherwise reports what is missing."""

    bl_options = {"REGISTER", "UNDO"}
    needs: Sequence[Requirement] = ()
    needs_at_last: Sequence[Requirement] = ()  # requirements that take too long to check on every redraw
    poll_message_set: Callable[[str], None]
    report: Callable[[set[str], str], None]

    def __init_subclass__(cls, **more: Any) -> None:
        super().__init_subclass__(**more)
        if cls.__name__.startswith(_PREFIX):
            cls.bl_idname = f"curve.{cls.__name__.removeprefix(_PREFIX)}"

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> Refusal | None:
        return first(context, cls.needs)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        refused = cls.refusal(context)
        if refused:
            cls.poll_message_set(tip_(refused.sentence))
        return refused is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        context.view_layer.update()  # a script may have moved an object just before
        try:
            require(self.refusal(context) or first(context, self.needs_at_last))
            self.act(context)
        except MobiusFlowError as error:
            return self.fail(error)
        redraw_views(context.window_manager)  # changed keys alone do not cause a redraw
        return {"FINISHED"}

    def fail(self, error: MobiusFlowError) -> set[str]:
        """Say what went wrong, without an undo step."""
        self.report({"ERROR"}, rpt_(str(error)))
        return {"CANCELLED"}

    def act(self, context: bpy.types.Context) -> None:
        """Do the operator's work; raises MobiusFlowError before anything has changed."""
        raise NotImplementedError


class LiveButton(Button):
    """A button whose job goes on while Blender stays usable; scripts, which have no window, wait for its end."""

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if bpy.app.background or context.window is None:
            return self.execute(context)
        try:
            return {"CANCELLED"} if self.asks(context) else self.begin(context)
        except MobiusFlowError as error:
            return self.fail(error)

    def asks(self, _context: bpy.types.Context) -> bool:
        """Offer something else first, if need be."""
        return False

    def begin(self, context: bpy.types.Context) -> set[str]:
        """Begin the job; raises MobiusFlowError."""
        raise NotImplementedError


def offer(
    context: bpy.types.Context, title: Message, choices: Mapping[Message, tuple[str, _Given]], told: Sequence[str] = ()
) -> bool:
    """Show a menu of operators to press instead, with what they are given, below what is to be known of them."""

    def draw(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
        menu.layout.operator_context = "INVOKE_DEFAULT"
        for line in told:
            menu.layout.label(text=iface_(line), translate=False)
        for text, (name, given) in choices.items():
            pressed = menu.layout.operator(name, text=iface_(text), translate=False)
            for key, value in given.items():
                setattr(pressed, key, value)

    context.window_manager.popup_menu(draw, title=iface_(title), icon="QUESTION")
    return True


def button(label: str, *needs: Requirement, **more: Any) -> Callable[[_Act], type]:
    """Turn a function into an operator without settings: its name is the identifier, its docstring the tooltip."""

    def operator(act: _Act) -> type:
        body = {"__doc__": act.__doc__, "__module__": act.__module__, "bl_label": label, "needs": needs, "act": act}
        return type(f"{_PREFIX}mobius_flow_{act.__name__}", (Button, bpy.types.Operator), body | more)

    return operator
