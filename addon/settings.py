"""What scenes keep besides options: what the panel shows, what the film is, what is avoided, which knot is picked."""

from collections.abc import Sequence
from contextlib import suppress
from functools import cache, partial
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, PointerProperty, StringProperty

from ..core import OptionError
from .curves import bake
from .live import registry
from .live.modal import redraw_views
from .live.requirements import shown_curves
from .pictures import icons, staging
from .pictures.icons import GROUPS, group, labels
from .pictures.looks import LOOKS
from .pictures.movie import CHOICES
from .properties import FURTHER, QUALITIES, Further, Quality, settings, timing

# since 5.0 Blender marks relative paths as wrong unless a property declares that it supports them
_RELATIVE = {"PATH_SUPPORTS_BLEND_RELATIVE"} if bpy.app.version >= (5, 0) else set()
_LEVELS = {**QUALITIES, "CUSTOM": Quality("Custom", "Options as they are set in Expert", {})}  # which all options match


def _quality(panel: Any) -> int:
    """The level follows from the options: whatever sets them, it is never out of date."""
    options = panel.id_data.mobius_flow
    with suppress(OptionError):  # what is written among the further options is wrong: the panel says what
        for number, each in enumerate(_LEVELS.values()):
            if all(getattr(options, name) == value for name, value in each.values.items()):
                return number
    return len(_LEVELS) - 1


def _set_quality(panel: Any, number: int) -> None:
    with suppress(OptionError):
        for name, value in list(_LEVELS.values())[number].values.items():
            setattr(panel.id_data.mobius_flow, name, value)


def _retime(changed: Any, context: bpy.types.Context) -> None:
    """Let the selected curves' film follow the settings at once, with the stage and the frames that the scene plays.

    Values that do not go together may be on the way to others: the film stays, and the panel says what is wrong.
    """
    scene, objects = changed.id_data, [obj for obj in shown_curves(context) if bake.is_baked(obj.data)]
    if registry.current() is not None or scene != context.scene or not objects:
        return
    before = _played(objects)
    with suppress(OptionError):
        wanted = timing(partial(getattr, changed))
        followed = [bake.retime(obj.data, wanted) for obj in objects]
        if any(followed):
            if (scene.frame_start, scene.frame_end) == before:
                scene.frame_start, scene.frame_end = _played(objects)
            staging.renew(scene)


def _played(objects: Sequence[bpy.types.Object]) -> tuple[int, int]:
    """First and last frame of baked objects' film that a scene can play, which are not negative."""
    first, last = bake.scene_range(objects) or (0, 0)
    return max(first, 0), max(last, 0)


class MobiusFlowSettings(bpy.types.PropertyGroup):
    __annotations__ = {name: each for name, each in settings(set(), _retime).items() if name not in FURTHER} | {
        "options": StringProperty(
            name="Further Options",
            description="Options as scripts and the command line have them, such as method=flow-moebius "
            "tolerance=1e-6; the manual lists them all",
        )
    }


for _name in FURTHER:
    setattr(MobiusFlowSettings, _name, Further(_name))


class MobiusFlowPanelSettings(bpy.types.PropertyGroup):
    quality: EnumProperty(
        name="Quality",
        description="How near to the least energy the shape comes; sets some of the options in Expert",
        items=[(name, each.label, each.description, "NONE", k) for k, (name, each) in enumerate(_LEVELS.items())],
        get=_quality,
        set=_set_quality,
    )
    show_plot: BoolProperty(
        name="Energy Plot",
        description="Draw the energy step by step in the 3D view",
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
        update=lambda film, context: staging.renew(context.scene, film.look) if film.look in LOOKS else None,
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


@cache  # Blender needs the strings to stay alive
def _knots(chosen: str) -> list[tuple[str, str, str, int, int]]:
    """The knots of a group, with icons; each keeps its number in files."""
    return [
        (name, label, f"Knot {label}" if chosen != "LINKS" else f"Link {label}", icons.icon(name), number)
        for number, (name, label) in enumerate(labels().items())
        if group(name) == chosen
    ]


class MobiusFlowKnots(bpy.types.PropertyGroup):
    group: EnumProperty(
        name="Group",
        description="Which knots are shown",
        items=[(key, title, description) for key, (title, description) in GROUPS.items()],
        default="FEW",
        # the one that was picked is not shown there
        update=lambda knots, _: setattr(knots, "knot", next(each for each in labels() if group(each) == knots.group)),
    )
    knot: EnumProperty(
        name="Knot",
        description="Knot to add",
        items=lambda knots, _: _knots(knots.group),
        default=list(labels()).index("3_1"),  # where items are made by a function, the default is a number
    )


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
    _knots.cache_clear()
    icons.forget()
