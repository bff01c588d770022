"""What scenes keep besides options: what the panel shows, what the film is, what is avoided, which knot is picked."""

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, PointerProperty, StringProperty

from .engine.knot_list import GROUPS, group, labels
from .engine.quality import QUALITIES, quality_of
from .live.modal import redraw_views
from .pictures import icons, staging
from .pictures.movie import CHOICES
from .properties import MobiusFlowSettings

# since 5.0 Blender marks relative paths as wrong unless a property declares that it supports them
_RELATIVE = {"PATH_SUPPORTS_BLEND_RELATIVE"} if bpy.app.version >= (5, 0) else set()
_LEVELS = [*QUALITIES, "CUSTOM"]
_LEVEL_ITEMS = [
    *((name, each.label, each.description, "NONE", k) for k, (name, each) in enumerate(QUALITIES.items())),
    ("CUSTOM", "Custom", "Options as they are set in Expert", "NONE", len(QUALITIES)),
]
_TREFOIL = list(labels()).index("3_1")  # where items are made by a function, the default is a number
_knot_items: dict[str, list[tuple[str, str, str, int, int]]] = {}  # Blender needs the strings to stay alive


def _quality(panel: Any) -> int:
    """The level follows from the options: whatever sets them, it is never out of date."""
    return _LEVELS.index(quality_of(panel.id_data.mobius_flow) or "CUSTOM")


def _set_quality(panel: Any, number: int) -> None:
    quality = QUALITIES.get(_LEVELS[number])
    for name, value in quality.values.items() if quality is not None else ():
        setattr(panel.id_data.mobius_flow, name, value)


class MobiusFlowPanelSettings(bpy.types.PropertyGroup):
    quality: EnumProperty(
        name="Quality",
        description="How near to the least energy the shape comes; sets some of the options in Expert",
        items=_LEVEL_ITEMS,
        get=_quality,
        set=_set_quality,
    )
    show_plot: BoolProperty(
        name="Energy Plot",
        description="Draw the energy against the iterations in the 3D view",
        default=True,
        update=lambda _panel, context: redraw_views(context.window_manager),
    )


class MobiusFlowFilmSettings(bpy.types.PropertyGroup):
    filepath: StringProperty(
        name="File",
        description="Where the film goes, an MP4; // is the directory of the open file",
        default="//film.mp4",
        subtype="FILE_PATH",
        options=_RELATIVE,
    )
    look: EnumProperty(
        name="Look",
        description="What the stage and the curves on it are made of, and how frames are rendered",
        items=[(name, *words) for name, words in CHOICES.items()],
        update=lambda film, context: staging.restyle(context.scene, film.look),
    )


class MobiusFlowSurroundings(bpy.types.PropertyGroup):
    avoid: PointerProperty(
        name="Avoid",
        description="Collection whose visible objects are never touched by curves that are relaxed",
        type=bpy.types.Collection,
    )
    container: PointerProperty(
        name="Container",
        description="Mesh in which Pack lets curves grow; what lies in it never touches it",
        type=bpy.types.Object,
        poll=lambda _surroundings, obj: obj.type == "MESH",
    )


def _knots(settings: bpy.types.PropertyGroup, _context: bpy.types.Context) -> list[tuple[str, str, str, int, int]]:
    """The knots of the chosen group, with icons; each keeps its number in files."""
    chosen = settings.group
    if chosen not in _knot_items:
        _knot_items[chosen] = [
            (name, label, f"Knot {label}" if chosen != "LINKS" else f"Link {label}", icons.icon(name), number)
            for number, (name, label) in enumerate(labels().items())
            if group(name) == chosen
        ]
    return _knot_items[chosen]


def _show_first(settings: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    """Pick the first knot of another group: the one that was picked is not shown there."""
    settings.knot = next(name for name in labels() if group(name) == settings.group)


class MobiusFlowKnots(bpy.types.PropertyGroup):
    group: EnumProperty(
        name="Group",
        description="Which knots are shown",
        items=[(key, title, description) for key, (title, description) in GROUPS.items()],
        default="FEW",
        update=_show_first,
    )
    knot: EnumProperty(name="Knot", description="Knot to add", items=_knots, default=_TREFOIL)


GROUPS_OF_SCENE = {
    "mobius_flow": MobiusFlowSettings,
    "mobius_flow_panel": MobiusFlowPanelSettings,
    "mobius_flow_film": MobiusFlowFilmSettings,
    "mobius_flow_surroundings": MobiusFlowSurroundings,
    "mobius_flow_knots": MobiusFlowKnots,
}


def register() -> None:
    for name, cls in GROUPS_OF_SCENE.items():
        setattr(bpy.types.Scene, name, PointerProperty(type=cls))


def unregister() -> None:
    """Take them away, and forget icons and what refers to them."""
    for name in GROUPS_OF_SCENE:
        delattr(bpy.types.Scene, name)
    _knot_items.clear()
    icons.forget()
