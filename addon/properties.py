"""The settings, on `Scene.mobius_flow` and, for scripts, on the operator too."""

import math
import zlib
from collections.abc import Collection, Mapping
from enum import Enum
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from ..core import RelaxOptions
from ..core.arguments import Option, declared
from .engine.key_options import FRAMES_PER_ITERATE, LAST_FRAME, KeyOptions, Output, Pace, Timing
from .engine.size import Measure

_TINY = 1e-37  # just above the smallest of 32-bit numbers that are computed with
_Item = tuple[str, str, str, str, int]
_PROPERTIES = {bool: BoolProperty, int: IntProperty, float: FloatProperty, str: StringProperty}
_AUTOMATIC = "AUTO"  # stands for None among names, as 0 does among numbers
_OUTPUTS = {
    Output.SHAPE_KEYS: "Absolute shape keys and one F-curve on their evaluation time: small, fast, renders anywhere",
    Output.FCURVES: "An F-curve for every coordinate of every point, for exporters that know no shape keys",
    Output.RESULT: "Move the points to the relaxed curves, without animation",
}
_TIMES = ("start_frame", "length", "frames_per_iterate", "hold_start", "hold_end", "loop")
_MEASURES = {
    Measure.LENGTH: "The length of the curves, which is what the relaxation itself keeps",
    Measure.BOX: "The longest side of the box around the curves",
    Measure.RADIUS: "The mean distance of the curves from their center (root mean square)",
}
_KEPT = "The radius, or the length where something is pinned or avoided, or grows"
_PACES = {
    Pace.EVEN: "The curves set off gently, move about evenly over the whole length, and come to rest gently",
    Pace.DISTANCE: "The curves move by the same distance in every frame of the whole length",
    Pace.FLOW_TIME: "The sizes of the steps add up evenly over the whole length: the time of a gradient flow",
    Pace.ITERATE: "Every iterate gets the same number of frames; the length follows",
}


def _enum_items(descriptions: Mapping[Enum, str]) -> list[tuple[str, str, str]]:
    return [(each.name, each.value, description) for each, description in descriptions.items()]


MEASURE_ITEMS = _enum_items(_MEASURES)
"""What can be kept while curves move."""


def shown() -> list[Option]:
    """The options of a relaxation that Blender has settings for."""
    return [each for each in declared(RelaxOptions) if each.is_setting]


def _property(option: Option, options: set[str]) -> Any:
    automatic = option.default is None
    words: dict[str, Any] = {"name": option.label, "options": options}
    if option.choices is None:
        words |= {
            "description": option.sentence("Empty" if option.kind is str else "0"),
            "default": option.default or option.kind(),
        }
        low = option.low + (_TINY if option.kind is float else 0)  # floats leave the bound itself out
        interval = {"min": low if option.default is not None else min(low, 0), "max": option.high}
        bounds = {name: option.kind(bound) for name, bound in interval.items() if math.isfinite(bound)}
        return _PROPERTIES[option.kind](**words, **(bounds | ({"precision": 6} if option.kind is float else {})))
    items = [(_AUTOMATIC, "Automatic", option.automatic, "NONE", 0)] if automatic else []
    items += _items(option.choices)
    return EnumProperty(**words, description=option.sentence(), items=items, default=option.default or _AUTOMATIC)


def _items(choices: Collection[str]) -> list[_Item]:
    """The names to choose from; those that are only for comparison have a heading of their own."""
    entries = choices if isinstance(choices, Mapping) else dict.fromkeys(choices)
    apart = [name for name in choices if getattr(entries[name], "comparison", False)]
    items = {name: _item(name, entries[name]) for name in choices}
    usual = [item for name, item in items.items() if name not in apart]
    if not apart:
        return usual
    return [_heading("Recommended"), *usual, _heading("For Comparison"), *(items[name] for name in apart)]


def _item(name: str, entry: Any) -> _Item:
    """A name to choose, whose number in files stays the same when others are added."""
    title = name.replace("moebius", "möbius").replace("-", " ").title()
    label, description = getattr(entry, "label", title), getattr(entry, "description", "")
    number = zlib.crc32(name.encode()) & 0x7FFFFFFF
    return name, label, description[:1].upper() + description[1:], "NONE", number


def _heading(text: str) -> _Item:
    return "", text, "", "NONE", 0


def settings(options: set[str]) -> dict[str, Any]:
    """Declare the settings as properties with the given options."""

    def declare(kind: Any, name: str, description: str, default: Any, **more: Any) -> Any:
        return kind(name=name, description=description, default=default, options=options, **more)

    def choice(name: str, description: str, default: Enum, descriptions: Mapping[Enum, str]) -> Any:
        return declare(EnumProperty, name, description, default.name, items=_enum_items(descriptions))

    def frames(name: str, description: str, default: int, low: int) -> Any:
        return declare(IntProperty, name, description, default, min=low, max=LAST_FRAME, soft_max=1000)

    keys, timing = KeyOptions(), Timing()
    return {option.name: _property(option, options) for option in shown()} | {
        "pin_tangents": declare(
            BoolProperty,
            "Pin Tangents",
            "Pin the neighbours of pinned points in the refined start, and so the direction there",
            default=False,
        ),
        "keyframes": choice("Keyframes", "What the animation is written as", keys.output, _OUTPUTS),
        "timing": choice("Timing", "What advances evenly from frame to frame", timing.pace, _PACES),
        "start_frame": declare(
            IntProperty,
            "Start Frame",
            "Frame at which the animation begins",
            int(timing.start_frame),
            soft_min=-LAST_FRAME,
            soft_max=LAST_FRAME,
        ),
        "length": frames("Length", "Number of frames of the whole animation", timing.length, 2),
        "frames_per_iterate": declare(
            FloatProperty,
            "Frames/Iterate",
            "Number of frames from one iterate to the next",
            timing.frames_per_iterate,
            min=FRAMES_PER_ITERATE[0],
            soft_max=100.0,
            max=FRAMES_PER_ITERATE[1],
        ),
        "hold_start": frames("Hold at Start", "Frames at rest before the curves move", 0, 0),
        "hold_end": frames("Hold at End", "Frames at rest after the curves have moved", 0, 0),
        "loop": declare(
            BoolProperty,
            "Loop",
            "Let the curves go back to where they began, so that films can be repeated; Length counts both ways",
            timing.loop,
        ),
        "max_keys": declare(
            IntProperty,
            "Max Keys",
            "Thin the animation out to this many keys, 0 for one key for every iterate, or more of few; "
            "where the straight motion between keys is not proved free of contact, more are kept",
            default=0,
            min=0,
        ),
        "fit_bevel": declare(
            BoolProperty,
            "Keep Tubes Fitted",
            "Fit tubes again that were fitted before, at every key. A bevel of your own is not changed; "
            "in a script, giving this fits it too",
            default=True,
        ),
        "constant_radius": declare(
            BoolProperty,
            "Constant Thickness",
            "Draw fitted tubes as thick at all frames as at the one where there is least room",
            keys.constant_radius,
        ),
        "keep_size": declare(
            EnumProperty,
            "Keep",
            "What stays as it is at the beginning while the curves move; they are scaled for that",
            _AUTOMATIC,
            items=[(_AUTOMATIC, "Automatic", _KEPT), *MEASURE_ITEMS],
        ),
        "view_every": declare(
            IntProperty,
            "Update View Every",
            "Number of iterates between updates of the view; "
            "0: chosen so that drawing takes at most a third of the time",
            default=0,
            min=0,
        ),
    }


SETTINGS = tuple(settings(set()))


class MobiusFlowSettings(bpy.types.PropertyGroup):
    __annotations__ = settings(set())


def relax_options(values: Mapping[str, Any]) -> RelaxOptions:
    """The core's options from the values of the settings; raises OptionError."""
    wanted = {option.name: values[option.name] for option in shown()}
    optional = [option.name for option in shown() if option.default is None]
    return RelaxOptions(**wanted | dict.fromkeys(name for name in optional if wanted[name] in (0, "", _AUTOMATIC)))


def key_options(values: Mapping[str, Any]) -> KeyOptions:
    """The animation's options from the values of the settings; raises OptionError."""
    timing = Timing(
        pace=Pace[values["timing"]],
        **{name: values[name] for name in _TIMES},
    )
    return KeyOptions(
        output=Output[values["keyframes"]],
        timing=timing,
        max_keys=values["max_keys"] or None,
        fit_bevel=values["fit_bevel"],
        constant_radius=values["constant_radius"],
        any_bevel=values["fit_bevel"] and values.get("any_bevel", False),
        keep_size=None if values["keep_size"] == _AUTOMATIC else Measure[values["keep_size"]],
    )
