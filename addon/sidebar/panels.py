"""The gallery of knots, and the sub-panels: each is a table of rows."""

import bpy

from ...core.messages import Message
from ..curves import bake, bevel, pins
from ..curves.exchange import length, stretch
from ..curves.moving import unsteady
from ..engine.knot_list import labels
from ..engine.words import named
from ..live.modal import unseen
from ..live.requirements import avoided, curves_at_hand, selected_curves
from ..pictures import staging
from ..properties import shown
from ..translations import iface_
from .layout import InSidebar, SubPanel, button, column, operator, row, sentence, settings, value
from .menus import search


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


def _avoided(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    found = avoided(context)
    if not found and context.scene.mobius_flow_surroundings.avoid is not None:
        sentence(layout, context, Message("Nothing in it is visible"))
    elif found and not unsteady(found, selected_curves(context)):
        names = named([obj.name for obj in found])
        sentence(layout, context, Message("Curves never touch {names}", names=names))


class VIEW3D_PT_mobius_flow_surroundings(SubPanel, bpy.types.Panel):
    bl_label = "Pins and Surroundings"
    rows = (
        column(button("pin", "PINNED"), row(button("pin_ends", "PINNED"), button("unpin", "UNPINNED"))),
        settings("avoid", "container", of="mobius_flow_surroundings"),
        button("pack", "CUBE"),
        _pin_count,
        _avoided,
    )


def _radius(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Show how thick the first curve is drawn, and whose choice that is."""
    for obj in selected_curves(context)[:1]:
        text = Message("None")
        if depth := obj.data.bevel_depth:
            radius = length(context.scene, depth * stretch(obj))
            fitted = bevel.is_fitted(obj.data)
            text = Message("{radius} (fitted)" if fitted else "{radius} (your own)", radius=radius)
        value(layout, "Radius", text)


class VIEW3D_PT_mobius_flow_shape(SubPanel, bpy.types.Panel):
    bl_label = "Shape"
    rows = (
        column(button("fit_tube", "MESH_CYLINDER"), button("color_components", "COLOR")),
        settings("fit_bevel", "constant_radius"),
        column(button("tube_mesh", "OUTLINER_OB_MESH"), button("smooth_curve", "CURVE_BEZCURVE")),
        column(
            button("keep_size", "FULLSCREEN_EXIT"),
            row(button("lay_flat", "AXIS_TOP"), button("face_camera", "CAMERA_DATA")),
        ),
        column(button("balance", "MOD_CURVE"), row(button("check", "VIEWZOOM"), button("leave_saddle", "SORT_ASC"))),
        button("close", "CURVE_BEZCIRCLE"),
        _radius,
    )


def _stage(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    within = layout.row(align=True)
    operator(within, "set_up_stage", icon="OUTLINER_OB_LIGHT")
    if staging.own_stage(context.scene):
        operator(within, "remove_stage", text="", icon="X")


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
        _not_in_film,
    )


class VIEW3D_PT_mobius_flow_expert(SubPanel, bpy.types.Panel):
    bl_label = "Expert"
    rows = (lambda layout, context: settings(*(each.name for each in shown() if each.row))(layout, context),)
