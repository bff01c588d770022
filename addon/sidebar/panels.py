"""The panels in the sidebar: what is done first, the gallery of knots, the sub-panels, and the report.

The report is the last of all, so that nothing moves when it appears.
"""

from collections.abc import Sequence
from functools import partial

import bpy

from ...core import METHODS, OptionError
from ...core.base import Message
from ...core.driver.words import named, time_left
from ..buttons.presets import VIEW3D_PT_mobius_flow_presets
from ..curves import bake, pins, surroundings
from ..curves.moving import unsteady
from ..curves.splines import length
from ..live import registry
from ..live.modal import unseen
from ..live.requirements import ENTERABLE
from ..live.run import RunState
from ..live.selection import avoided, curves_at_hand, relaxed_together, selected_curves, shown_curves
from ..pictures import staging
from ..pictures.icons import labels
from ..properties import QUALITIES, shown, timing
from ..translations import iface_
from .layout import InSidebar, SubPanel, button, column, operator, row, sentence, settings, value
from .menus import search


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
    return run.objects if run is not None else relaxed_together(context)


def _hints(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Why Relax is disabled, and what helps; what might be crossed; what can be brought back."""
    run, shown, objects = registry.current(), registry.shown(context.active_object), _concerned(context)
    if shown is not None and shown.recoverable:
        operator(layout, "recover", icon="RECOVER_LAST")
    hindered, chosen = ENTERABLE(context), relaxed_together(context)
    if hindered and (run is None or any(obj not in objects for obj in chosen)):
        box = layout.column(align=True)
        sentence(box, context, hindered.sentence)
        if hindered.remedy is not None:
            mend = operator(box, "mend", text=iface_(hindered.remedy.value), icon="TOOL_SETTINGS")
            mend.remedy = hindered.remedy.name
    if run or not hindered:
        # say what cannot be avoided, or else what might be crossed, with the button that helps
        found = avoided(context)
        if moving := unsteady(found, chosen):
            sentence(layout, context, moving, icon="ERROR")
        elif unguarded := surroundings.warning(context, objects, found):
            sentence(layout, context, unguarded, icon="ERROR")
            operator(layout, "avoid", icon="ADD")


def _qualities(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
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
    rows = (_buttons, _qualities, button("add_knot", "ADD", Message("Add Knot")), _hints)

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        VIEW3D_PT_mobius_flow_presets.draw_panel_header(self.layout)


def _gallery(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    picked = context.scene.mobius_flow_knots
    layout.prop(picked, "group")
    layout.template_icon_view(picked, "knot", show_labels=True, scale=7.0, scale_popup=4.0)
    label = labels().get(picked.knot, "")
    add = operator(layout, "pick_knot", text=iface_("Add {knot}", knot=Message(label)), icon="ADD")
    add.knot, add.mirror = label, False  # as it is pictured, whatever was added last


class VIEW3D_PT_mobius_flow_knots(InSidebar, bpy.types.Panel):
    bl_label = "Knots"
    bl_options = {"DEFAULT_CLOSED"}
    rows = (_gallery, search, button("draw_knot", "GREASEPENCIL"))


def _pin_count(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    if count := sum(pins.count(obj.data) for obj in curves_at_hand(context)):
        layout.label(text=iface_("{count} points pinned", count=count), icon="INFO", translate=False)


class VIEW3D_PT_mobius_flow_surroundings(SubPanel, bpy.types.Panel):
    bl_label = "Pins and Surroundings"
    rows = (
        row(button("pin", "PINNED"), button("unpin", "UNPINNED")),
        settings("avoid", "container", of="mobius_flow_surroundings"),
        button("pack", "CUBE"),
        row(button("separate", "MOD_PHYSICS"), button("tighten", "FORCE_CURVE")),
        _pin_count,
    )


def _hidden_from_nodes(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Say why nodes get no points where a curve has a tube."""
    for obj in selected_curves(context):
        if (obj.data.bevel_depth or obj.data.bevel_object) and any(each.type == "NODES" for each in obj.modifiers):
            said = "The nodes of '{name}' get the mesh of its tube, no curve: Curve to Points gives nothing. Set its \
bevel's Depth to 0, and let the nodes make the tube"
            sentence(layout, context, Message(said, name=obj.name))


class VIEW3D_PT_mobius_flow_shape(SubPanel, bpy.types.Panel):
    bl_label = "Shape"
    rows = (
        row(
            button("fit_tube", "MESH_CYLINDER", constant=False),
            button("fit_tube", "MESH_CAPSULE", Message("Constant"), constant=True),
        ),
        button("color_components", "COLOR"),
        column(
            button("tube_mesh", "OUTLINER_OB_MESH"),
            button("smooth_curve", "CURVE_BEZCURVE"),
            button("draw_diagram", "GREASEPENCIL"),
        ),
        column(
            button("keep_size", "FULLSCREEN_EXIT"),
            row(button("lay_flat", "AXIS_TOP"), button("face_camera", "CAMERA_DATA")),
        ),
        _hidden_from_nodes,
    )


def _stage(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    within = layout.row(align=True)
    operator(within, "set_up_stage", icon="OUTLINER_OB_LIGHT")
    if staging.own_stage(context.scene):
        operator(within, "remove_stage", text="", icon="X")


def _unfit(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Say why a film cannot have the timing that is set; until then it keeps its own."""
    try:
        wanted = timing(partial(getattr, context.scene.mobius_flow))
        for obj in shown_curves(context):
            wanted.check_keys(bake.key_count(obj.data))
    except OptionError as error:
        sentence(layout, context, str(error), icon="ERROR")


def _not_in_film(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """What the film would lack, below the buttons, which keep their places."""
    if not staging.fits(context.scene):
        sentence(layout, context, "The picture has another shape than the stage's camera; press Set Up Stage again")
    if hidden := unseen(context.scene, bake.scene_range(selected_curves(context))):
        sentence(layout, context, hidden)


class VIEW3D_PT_mobius_flow_film(SubPanel, bpy.types.Panel):
    bl_label = "Film"
    bl_options = set()
    rows = (
        settings("length", "hold_end", "loop"),
        column(row(button("continue", "FF"), button("clear", "TRASH")), button("scene_range", "PREVIEW_RANGE")),
        _stage,
        lambda layout, context: layout.prop(
            context.scene.render, "resolution_percentage", text=iface_("Size of Pictures")
        ),
        settings("look", "filepath", of="mobius_flow_film"),
        row(button("render_film", "RENDER_ANIMATION"), button("play_film", "PLAY")),
        _unfit,
        _not_in_film,
    )


def _paper(layout: bpy.types.UILayout, _context: bpy.types.Context) -> None:
    """A link to what all of this is after."""
    name = iface_("Reiter and Schumacher (2021)")
    link = layout.operator("wm.url_open", text=name, translate=False, icon="URL")
    link.url = "https://doi.org/10.1007/s00205-021-01680-1"


class VIEW3D_PT_mobius_flow_expert(SubPanel, bpy.types.Panel):
    bl_label = "Expert"
    bl_description = "Settings for those who know Sobolev Gradients for the Möbius Energy, by Reiter and Schumacher"
    rows = (
        lambda layout, context: settings(*(each.name for each in shown() if each.row))(layout, context),
        settings("timing", "start_frame", "hold_start", "keyframes", "keep_size"),
        settings("options"),
        _paper,
        _unfit,
    )


def _progress(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """What is known of the run that is going on, or of the last one."""
    run = registry.shown(context.active_object)
    assert run is not None, "poll looks for it"
    box = layout.column(align=True)
    state: Message = run.state.value
    if run.waits:
        state = Message("Waiting for the render")
    elif run.state is RunState.RUNNING and run.drag is None and (seconds := run.time_left.seconds) is not None:
        state = Message("{state}, {time}", state=state, time=time_left(seconds))
    elif run.failed and run.state is RunState.CANCELLED:
        state = Message("Failed")
    value(box, ", ".join(run.session.names), state)
    if run.last is not None:
        value(box, run.measure, f"{run.last.energy:.4f}")
        if run.target is not None:
            value(box, "At least", run.target.label)
        back = run.looked_at
        value(box, "Step", f"{run.last.index}" if back is None else f"{back:.0f} / {run.last.index}")
        proved = run.last.certified if run.report is None else run.report.certified
        whom = Message("with itself") if len(run.session.names) == 1 else Message("among themselves")
        value(box, "Free of contact", whom if proved else Message("not proved"))
        if run.avoided:
            value(box, "Avoided", named(run.avoided))
    if run.report is not None and run.report.radius is not None:
        value(box, "Tube radius", length(context.scene, run.report.radius))
    if run.message:
        sentence(box, context, run.message, icon="ERROR" if run.failed else "INFO")
    if run.trouble and run.state.over:
        operator(box, "show", icon="VIEWZOOM")
    if run.energies:
        row = box.row()
        row.use_property_split = False
        row.prop(context.scene.mobius_flow_panel, "show_plot")


class VIEW3D_PT_mobius_flow_report(InSidebar, bpy.types.Panel):
    bl_label = "Report"
    rows = (_progress,)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return registry.shown(context.active_object) is not None
