"""The panel in the sidebar: what is done first."""

from collections.abc import Sequence

import bpy

from ...core import METHODS, OptionError
from ...core.base.messages import Message
from ..buttons.presets import VIEW3D_PT_mobius_flow_presets
from ..curves import surroundings
from ..curves.moving import unsteady
from ..live import registry
from ..live.requirements import RELAXABLE, avoided, selected_curves
from ..live.run import RunState
from ..properties import QUALITIES
from ..translations import iface_
from .layout import InSidebar, button, operator, refused, sentence


def _buttons(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """The large buttons; they and the rows below them keep their places whatever is said."""
    run, objects = registry.current(), _concerned(context)
    several = iface_("Relax {count} Curves Together", count=len(objects))
    text = several if len(objects) > 1 else iface_("Relax")
    large = layout.row(align=True)
    large.scale_y = 1.8
    if run is None:
        operator(large, "relax", text=text, icon="PLAY")
        operator(large, "morph", text="", icon="MOD_SIMPLEDEFORM")
        operator(large, "grab", text="", icon="VIEW_PAN")
    else:
        text, icon = (iface_("Resume"), "PLAY") if run.state is RunState.PAUSED else (iface_("Pause"), "PAUSE")
        operator(large, "pause", text=text, icon=icon)
        operator(large, "stop", icon="CHECKMARK")
        operator(large, "cancel", icon="X")


def _concerned(context: bpy.types.Context) -> Sequence[bpy.types.Object]:
    run = registry.current()
    return run.objects if run is not None else selected_curves(context)


def _hints(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Why Relax is disabled, and what helps; what might be crossed; what can be brought back."""
    run, shown, objects = registry.current(), registry.shown(context.active_object), _concerned(context)
    if shown is not None and shown.recoverable:
        operator(layout, "recover", icon="RECOVER_LAST")
    hindered = RELAXABLE(context)
    if hindered and (run is None or any(obj not in objects for obj in selected_curves(context))):
        refused(layout.column(align=True), context, hindered)
    if run or not hindered:
        # say what cannot be avoided, or else what might be crossed, with the button that helps
        found = avoided(context)
        if moving := unsteady(found, selected_curves(context)):
            sentence(layout, context, moving, icon="ERROR")
        elif unguarded := surroundings.warning(context, objects, found):
            sentence(layout, context, unguarded, icon="ERROR")
            operator(layout, "avoid", icon="ADD")


def _quality(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """The levels of quality; where options are other than theirs, what the curves are relaxed by."""
    panel = context.scene.mobius_flow_panel
    row = layout.row(align=True)
    row.use_property_split = False
    for name in QUALITIES:
        row.prop_enum(panel, "quality", name)
    if panel.quality == "CUSTOM":
        try:
            method = METHODS[context.scene.mobius_flow.method]
        except OptionError as error:
            sentence(layout, context, str(error), icon="ERROR")
            return
        after = Message("{method}, after Reiter and Schumacher (2021)", method=iface_(method.label))
        sentence(layout, context, method.label if method.comparison else after)


class VIEW3D_PT_mobius_flow(InSidebar, bpy.types.Panel):
    bl_label = "Möbius Flow"
    rows = (_buttons, _quality, button("add_knot", "ADD", Message("Add Knot")), _hints)

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        VIEW3D_PT_mobius_flow_presets.draw_panel_header(self.layout)
