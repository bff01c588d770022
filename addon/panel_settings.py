"""What the panel shows: the quality that the options amount to, and whether there is a plot."""

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, PointerProperty

from .engine.quality import QUALITIES, quality_of
from .live.modal import redraw_views

_LEVELS = [*QUALITIES, "CUSTOM"]


def _items() -> list[tuple[str, str, str, str, int]]:
    items = [(name, each.label, each.description, "NONE", k) for k, (name, each) in enumerate(QUALITIES.items())]
    return [*items, ("CUSTOM", "Custom", "Options as they are set in Expert", "NONE", len(items))]


def _quality(panel: Any) -> int:
    """The level is what the options make it: whatever sets them, it is never out of date."""
    return _LEVELS.index(quality_of(panel.id_data.mobius_flow) or "CUSTOM")


def _set_quality(panel: Any, number: int) -> None:
    quality = QUALITIES.get(_LEVELS[number])
    for name, value in quality.values.items() if quality is not None else ():
        setattr(panel.id_data.mobius_flow, name, value)


class MobiusFlowPanelSettings(bpy.types.PropertyGroup):
    """What the panel shows."""

    __annotations__ = {
        "quality": EnumProperty(
            name="Quality",
            description="How near to the least energy the shape comes; sets some of the options in Expert",
            items=_items(),
            get=_quality,
            set=_set_quality,
        ),
        "show_plot": BoolProperty(
            name="Energy Plot",
            description="Draw the energy against the iterations in the 3D view",
            default=True,
            update=lambda _panel, context: redraw_views(context.window_manager),
        ),
    }


def register() -> None:
    """Give the scene the settings."""
    bpy.types.Scene.mobius_flow_panel = PointerProperty(type=MobiusFlowPanelSettings)


def unregister() -> None:
    """Take them away."""
    del bpy.types.Scene.mobius_flow_panel


CLASSES = (MobiusFlowPanelSettings,)
