"""The settings of a relaxation, all on the operator, for scripts, and those for artists on `Scene.mobius_flow`, too.

What only experts set is in one of these, a text such as ``method=flow-moebius tolerance=1e-6``: scripts and presets
may still say ``scene.mobius_flow.method = "flow-moebius"``.
"""

import math
import zlib
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum
from typing import Any

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from ..core import OptionError, RelaxOptions
from ..core.base import Message, Option, choice, declared, likeliest
from ..core.base.arguments import WORDS, is_plain
from ..core.keys.key_options import FRAMES_PER_ITERATE, LAST_FRAME, KeyOptions, Output, Pace, Timing
from ..core.keys.placement import Measure

_PROPERTIES = {bool: BoolProperty, int: IntProperty, float: FloatProperty, str: StringProperty}
_AUTOMATIC = "AUTO"  # stands for None among names, as 0 does among numbers
_OUTPUTS = {
    Output.SHAPE_KEYS: "Absolute shape keys and one F-curve on their evaluation time: small, fast, renders anywhere",
    Output.RESULT: "Move the points to the relaxed curves, without animation",
}
_MEASURES = {
    Measure.LENGTH: "The length of the curves, which is what the relaxation itself keeps",
    Measure.BOX: "The longest side of the box around the curves",
    Measure.RADIUS: "The mean distance of the curves from their center (root mean square)",
}
_PACES = {
    Pace.EVEN: "The curves set off gently, move about evenly over the whole length, and come to rest gently",
    Pace.DISTANCE: "The curves move by the same distance in every frame of the whole length",
    Pace.FLOW_TIME: "The sizes of the steps add up evenly over the whole length: the time of a gradient flow",
    Pace.ITERATE: "Every iterate gets the same number of frames; the length follows",
}


_DESCRIPTIONS = {  # of the settings that are no options of a relaxation
    "pin_tangents": "Pin the neighbours of pinned points in the refined start, and so the direction there",
    "keyframes": "What the next animation is written as",
    "timing": "What advances evenly from frame to frame",
    "start_frame": "Frame at which the animation begins",
    "length": "Number of frames of the whole animation",
    "frames_per_iterate": "Number of frames from one iterate to the next",
    "hold_start": "Frames at rest before the curves move",
    "hold_end": "Frames at rest after the curves have moved",
    "loop": "Let the curves go back to where they began, so that films can be repeated; Length counts both ways",
    "max_keys": "Thin the next animation out to this many keys, 0 for one key for every iterate, or more of few; "
    "where the straight motion between keys is not proved free of contact, more are kept",
    "fit_bevel": "Fit tubes again that were fitted before, at every key. A bevel of your own is not changed; "
    "in a script, giving this fits it too",
    "constant_radius": "Draw fitted tubes as thick at all frames as where there is least room, "
    "from the next relaxation on",
    "keep_size": "What stays as it is at the beginning while the curves move; they are scaled for that",
    "view_every": "Number of iterates between updates of the view; "
    "0: chosen so that drawing takes at most a third of the time",
}


def _enum_items(descriptions: Mapping[Enum, str]) -> list[tuple[str, str, str]]:
    return [(each.name, each.value, description) for each, description in descriptions.items()]


MEASURE_ITEMS = _enum_items(_MEASURES)
"""What can be kept while curves move."""


def shown() -> list[Option]:
    """The options of a relaxation that Blender has settings for."""
    return [each for each in declared(RelaxOptions) if not each.repeated]


def _property(option: Option, options: set[str]) -> Any:
    automatic = option.default is None
    words: dict[str, Any] = {"name": option.label, "options": options}
    if option.choices is None or option.read is not str:  # what a word is read as may be no name
        words |= {
            "description": option.sentence("Empty" if option.kind is str else "0"),
            "default": option.default or option.kind(),
        }
        # floats leave the bound itself out: just above the smallest of 32-bit numbers that are computed with
        low = option.low + (1e-37 if option.kind is float else 0)
        interval = {"min": low if option.default is not None else min(low, 0), "max": option.high}
        bounds = {name: option.kind(bound) for name, bound in interval.items() if math.isfinite(bound)}
        return _PROPERTIES[option.kind](**words, **(bounds | ({"precision": 6} if option.kind is float else {})))
    items = [(_AUTOMATIC, "Automatic", option.automatic, "NONE", 0)] if automatic else []
    entries = option.choices if isinstance(option.choices, Mapping) else dict.fromkeys(option.choices)
    for name, entry in entries.items():
        title = name.replace("moebius", "möbius").replace("-", " ").title()
        label, description = getattr(entry, "label", title), getattr(entry, "description", "")
        number = zlib.crc32(name.encode()) & 0x7FFFFFFF  # in files; it stays the same when others are added
        items.append((name, label, description[:1].upper() + description[1:], "NONE", number))
    return EnumProperty(**words, description=option.sentence(), items=items, default=option.default or _AUTOMATIC)


def settings(options: set[str], retime: Callable[[Any, Any], None] | None = None) -> dict[str, Any]:
    """Declare the settings as properties with the given options; ``retime``: called when one of the timing changes."""
    at_once = {} if retime is None else {"update": retime}

    keys, times, (slow, fast) = KeyOptions(), Timing(), FRAMES_PER_ITERATE
    outputs = [(*item, "NONE", 2 * k) for k, item in enumerate(_enum_items(_OUTPUTS))]  # as in files; 1 is gone
    whole = {"max": LAST_FRAME, "soft_max": 1000, **at_once}
    kept = [(_AUTOMATIC, "Automatic", "The radius, or the length where something is pinned or avoided, or grows")]
    more: dict[str, tuple[Any, str, Any, dict[str, Any]]] = {
        "pin_tangents": (BoolProperty, "Pin Tangents", False, {}),
        "keyframes": (EnumProperty, "Keyframes", keys.output.name, {"items": outputs}),
        "timing": (EnumProperty, "Timing", times.pace.name, {"items": _enum_items(_PACES), **at_once}),
        "start_frame": (
            IntProperty,
            "Start Frame",
            int(times.start_frame),
            {"soft_min": -LAST_FRAME, "soft_max": LAST_FRAME, **at_once},
        ),
        "length": (IntProperty, "Length", times.length, {"min": 2, **whole}),
        "frames_per_iterate": (
            FloatProperty,
            "Frames/Iterate",
            times.frames_per_iterate,
            {"min": slow, "soft_max": 100.0, "max": fast, **at_once},
        ),
        "hold_start": (IntProperty, "Hold at Start", 0, {"min": 0, **whole}),
        "hold_end": (IntProperty, "Hold at End", 0, {"min": 0, **whole}),
        "loop": (BoolProperty, "Loop", times.loop, at_once),
        "max_keys": (IntProperty, "Max Keys", 0, {"min": 0}),
        "fit_bevel": (BoolProperty, "Keep Tubes Fitted", True, {}),
        "constant_radius": (BoolProperty, "Constant Thickness", keys.constant_radius, {}),
        "keep_size": (EnumProperty, "Keep", _AUTOMATIC, {"items": [*kept, *MEASURE_ITEMS]}),
        "view_every": (IntProperty, "Update View Every", 0, {"min": 0}),
    }
    return {option.name: _property(option, options) for option in shown()} | {
        name: kind(name=label, description=_DESCRIPTIONS[name], default=default, options=options, **words)
        for name, (kind, label, default, words) in more.items()
    }


_DECLARED = {name: each.keywords for name, each in settings(set()).items()}
DEFAULTS = {name: keywords["default"] for name, keywords in _DECLARED.items()}
SETTINGS = tuple(_DECLARED)
FURTHER = (
    *(option.name for option in shown() if not option.row),
    *("pin_tangents", "max_keys", "fit_bevel", "constant_radius", "view_every"),
)
"""The settings that experts write into one text; the others are settings of the scene."""


def check(name: str, value: Any) -> None:
    """Raise an OptionError if there is no such setting, or it cannot have that value."""
    if name not in _DECLARED:
        raise OptionError(f"there is no setting {name!r}; {likeliest(name, _DECLARED)}see curve.mobius_flow_relax")
    kind = type(DEFAULTS[name])
    if not is_plain(value, kind):
        raise OptionError(f"{name} is {value!r}; it must be {'a name' if kind is str else WORDS[kind]}")
    if name in ("max_keys", "view_every") and value < 0:
        raise OptionError(f"{name} is {value}; it must be 0 or more")
    names = [item[0] for item in _DECLARED[name].get("items", ())]
    if names and value not in names:
        raise OptionError(f"{name} is {value!r}; {choice(value, names)}")


def further(text: str) -> dict[str, Any]:
    """The settings in a text such as ``method=flow-moebius vertices=300``; raises OptionError."""
    found: dict[str, Any] = {}
    for word in text.split():
        name, _, value = word.partition("=")
        if name not in FURTHER or not value:
            sentence = "Further Options have '{word}'; write NAME=VALUE, with one of the names {names}"
            raise OptionError(Message(sentence, word=word, names=", ".join(FURTHER)))
        kind, found[name] = type(DEFAULTS[name]), value
        with suppress(KeyError, ValueError):
            found[name] = {"true": True, "false": False}[value.lower()] if kind is bool else kind(value)
        check(name, found[name])
    return found


class Further:
    """A setting that is kept in the scene's text, where it differs from its default."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, scene: Any, _owner: type) -> Any:
        return self if scene is None else further(scene.options).get(self._name, DEFAULTS[self._name])

    def __set__(self, scene: Any, value: Any) -> None:
        check(self._name, value)
        values = further(scene.options) | {self._name: value}
        scene.options = " ".join(f"{name}={each}" for name, each in values.items() if each != DEFAULTS[name])


def relax_options(values: Mapping[str, Any]) -> RelaxOptions:
    """The core's options from the values of the settings; raises OptionError."""
    given = ((option, values[option.name]) for option in shown())
    wanted = {option.name: option.read(value) if isinstance(value, str) else value for option, value in given}
    optional = [option.name for option in shown() if option.default is None]
    return RelaxOptions(**wanted | dict.fromkeys(name for name in optional if wanted[name] in (0, "", _AUTOMATIC)))


def timing(value: Callable[[str], Any]) -> Timing:
    """The timing from what gives the values of settings by their names; raises OptionError."""
    names = ("start_frame", "length", "frames_per_iterate", "hold_start", "hold_end", "loop")
    return Timing(pace=Pace[value("timing")], **{name: value(name) for name in names})


def key_options(values: Mapping[str, Any]) -> KeyOptions:
    """The animation's options from the values of the settings; raises OptionError."""
    return KeyOptions(
        output=Output[values["keyframes"] or KeyOptions.output.name],
        timing=timing(values.__getitem__),
        max_keys=values["max_keys"] or None,
        fit_bevel=values["fit_bevel"],
        constant_radius=values["constant_radius"],
        any_bevel=values["fit_bevel"] and values.get("any_bevel", False),
        keep_size=None if values["keep_size"] == _AUTOMATIC else Measure[values["keep_size"]],
    )


@dataclass(frozen=True)
class Quality:
    """A level of quality: its title, what it is for, and options of a relaxation."""

    label: str
    description: str
    values: Mapping[str, Any]  # 0 vertices leaves the number to the core


def _options(method: str, tolerance: float, max_iterations: int) -> Mapping[str, Any]:
    return {"method": method, "tolerance": tolerance, "max_iterations": max_iterations, "vertices": 0}


_EXACT = "The shape of least energy to many digits, in two or three times the time"
QUALITIES: Mapping[str, Quality] = {
    "PREVIEW": Quality("Preview", "Untangled and nearly at rest, to look at", _options("lbfgs", 1e-2, 300)),
    "GOOD": Quality("Good", "At rest as far as the eye can tell", _options("lbfgs", 1e-4, 2000)),
    "EXACT": Quality("Exact", _EXACT, _options("trust-region", 1e-8, 2000)),
}
"""The levels by their identifiers, which are in files."""
