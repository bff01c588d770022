"""Sentences in the sidebar: labels do not wrap by themselves."""

from collections.abc import Callable

import blf
import bpy

from ..translations import iface_

_FONT = 0  # Blender's own
_MARGIN = 100  # pixels beside the text at the usual scale: tabs, padding, the frame of a box and the icon


def sentence(layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str = "INFO") -> None:
    """Write a sentence in the user's language, as wide as the sidebar is, with an icon before it."""
    scale = context.preferences.system.ui_scale
    blf.size(_FONT, context.preferences.ui_styles[0].widget.points * scale)
    room = context.region.width - _MARGIN * scale
    column = layout.column(align=True)
    for k, line in enumerate(wrapped(iface_(text), lambda line: blf.dimensions(_FONT, line)[0] <= room)):
        column.label(text=line, icon="BLANK1" if k else icon, translate=False)


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
