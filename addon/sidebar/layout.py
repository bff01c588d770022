"""Building blocks of the sidebar's panels: rows that draw themselves, and sentences, which Blender does not wrap."""

from collections.abc import Callable, Sequence
from typing import Any

import blf
import bpy

from ..translations import iface_

Draw = Callable[[bpy.types.UILayout, bpy.types.Context], object]


class InSidebar:
    """A panel in our tab of the sidebar, with the names of settings before them."""

    bl_category = "Möbius Flow"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"

    layout: bpy.types.UILayout
    rows: Sequence[Draw] = ()

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        _fill(self.layout, context, self.rows)


class SubPanel(InSidebar):
    bl_parent_id = "VIEW3D_PT_mobius_flow"
    bl_options = {"DEFAULT_CLOSED"}


def operator(layout: bpy.types.UILayout, name: str, **look: Any) -> Any:
    """Show the button of one of our operators, and return what sets its properties."""
    return layout.operator(f"curve.mobius_flow_{name}", **look)


def button(name: str, icon: str, text: str | None = None, **given: Any) -> Draw:
    """A button of one of our operators, with its own words or others, and the properties that it is given."""

    def draw(layout: bpy.types.UILayout, _context: bpy.types.Context) -> None:
        shown = operator(
            layout, name, icon=icon, **({} if text is None else {"text": iface_(text), "translate": False})
        )
        for key, value in given.items():
            setattr(shown, key, value)

    return draw


def row(*parts: Draw) -> Draw:
    return lambda layout, context: _fill(layout.row(align=True), context, parts)


def column(*parts: Draw) -> Draw:
    return lambda layout, context: _fill(layout.column(align=True), context, parts)


def _fill(layout: bpy.types.UILayout, context: bpy.types.Context, parts: Sequence[Draw]) -> None:
    for draw in parts:
        draw(layout, context)


def settings(*names: str, of: str = "mobius_flow") -> Draw:
    """A column of settings of the scene."""

    def draw(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
        within = layout.column(align=True)
        for name in names:
            within.prop(getattr(context.scene, of), name)

    return draw


def value(layout: bpy.types.UILayout, name: str, text: str) -> None:
    split = layout.split(factor=0.4)
    left = split.row()
    left.alignment = "RIGHT"
    left.label(text=iface_(name), translate=False)
    split.label(text=iface_(text), translate=False)


def sentence(layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str = "INFO") -> None:
    """Write a sentence in the user's language, as wide as the sidebar is, with an icon before it."""
    scale = context.preferences.system.ui_scale
    font = 0  # Blender's own
    blf.size(font, context.preferences.ui_styles[0].widget.points * scale)
    # beside the text there are tabs, padding, the frame of a box and the icon
    room = context.region.width - 100 * scale
    lines = layout.column(align=True)
    for k, line in enumerate(wrapped(iface_(text), lambda line: blf.dimensions(font, line)[0] <= room)):
        lines.label(text=line, icon="BLANK1" if k else icon, translate=False)


def wrapped(text: str, fits: Callable[[str], bool]) -> list[str]:
    """Break a text between words into lines that fit; a word that is too long gets a line of its own."""
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and fits(longer):
            lines[-1] = longer
        else:
            lines.append(word)
    return lines
