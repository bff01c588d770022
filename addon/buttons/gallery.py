"""What is picked in the gallery of knots: settings of the scene."""

import bpy
from bpy.props import BoolProperty, EnumProperty, PointerProperty

from ..engine.knot_list import GROUPS, group, labels
from ..pictures import icons

_TREFOIL = list(labels()).index("3_1")  # where items are made by a function, the default is a number

_items: dict[str, list[tuple[str, str, str, int, int]]] = {}  # Blender needs the strings to stay alive


def _knots(settings: bpy.types.PropertyGroup, _context: bpy.types.Context) -> list[tuple[str, str, str, int, int]]:
    """The knots of the chosen group, with icons; each keeps its number in files."""
    chosen = settings.group
    if chosen not in _items:
        _items[chosen] = [
            (name, label, f"Knot {label}" if chosen != "LINKS" else f"Link {label}", icons.icon(name), number)
            for number, (name, label) in enumerate(labels().items())
            if group(name) == chosen
        ]
    return _items[chosen]


def _show_first(settings: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    """Pick the first knot of another group: the one that was picked is not shown there."""
    settings.knot = next(name for name in labels() if group(name) == settings.group)


class MobiusFlowKnots(bpy.types.PropertyGroup):
    """Which knot is picked."""

    group: EnumProperty(
        name="Group",
        description="Which knots are shown",
        items=[(key, title, description) for key, (title, description) in GROUPS.items()],
        default="FEW",
        update=_show_first,
    )
    knot: EnumProperty(name="Knot", description="Knot to add", items=_knots, default=_TREFOIL)
    mirror: BoolProperty(name="Mirror", description="Add the mirror image", default=False)


def register() -> None:
    """Give the scene the choice."""
    bpy.types.Scene.mobius_flow_knots = PointerProperty(type=MobiusFlowKnots)


def unregister() -> None:
    """Take it away, and forget icons and what refers to them."""
    del bpy.types.Scene.mobius_flow_knots
    _items.clear()
    icons.forget()


CLASSES = (MobiusFlowKnots,)
