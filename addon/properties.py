"""The settings, on `Scene.mobius_flow` and, for scripts, on the operator too."""

import zlib
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from ..core import METHODS, RelaxOptions
from .key_options import FRAMES_PER_ITERATE, LAST_FRAME, KeyOptions, Output

_DEFAULTS = RelaxOptions()
_KEY_DEFAULTS = KeyOptions()
_OUTPUT_DESCRIPTIONS = {
    Output.SHAPE_KEYS: "Absolute shape keys and one F-curve on their evaluation time: small, fast, renders anywhere",
    Output.FCURVES: "An F-curve for every coordinate of every point, for exporters that know no shape keys",
    Output.RESULT: "Move the points to the relaxed curves, without animation",
}


def _method_items() -> list[tuple[str, str, str, str, int]]:
    """The methods of the core; each keeps its number in files when others are added."""
    return [
        (name, name, method.description, "NONE", zlib.crc32(name.encode()) & 0x7FFFFFFF)
        for name, method in METHODS.items()
    ]


def _output_items() -> list[tuple[str, str, str]]:
    return [(output.name, output.value, _OUTPUT_DESCRIPTIONS[output]) for output in Output]


def settings(options: set[str]) -> dict[str, Any]:
    """Declare the settings as properties with the given options."""
    return {
        "method": EnumProperty(
            name="Method",
            description="How the energy is minimised",
            items=_method_items(),
            default=_DEFAULTS.method,
            options=options,
        ),
        "tolerance": FloatProperty(
            name="Tolerance",
            description="Stop when the projected gradient is this small, relative to the root of the energy",
            default=_DEFAULTS.tolerance,
            min=1e-12,
            max=1.0,
            precision=6,
            options=options,
        ),
        "max_iterations": IntProperty(
            name="Max Iterations",
            description="Stop after this many iterations",
            default=_DEFAULTS.max_iterations,
            min=0,
            options=options,
        ),
        "vertices": IntProperty(
            name="Vertices",
            description="Points to refine the curves to, all together; 0 chooses it by the distance between strands",
            default=0,
            min=0,
            options=options,
        ),
        "keyframes": EnumProperty(
            name="Keyframes",
            description="What the animation is written as",
            items=_output_items(),
            default=_KEY_DEFAULTS.output.name,
            options=options,
        ),
        "start_frame": IntProperty(
            name="Start Frame",
            description="Frame at which the curves begin to move",
            default=int(_KEY_DEFAULTS.start_frame),
            soft_min=-LAST_FRAME,
            soft_max=LAST_FRAME,
            options=options,
        ),
        "frames_per_iterate": FloatProperty(
            name="Frames/Iterate",
            description="Number of frames from one iterate to the next",
            default=_KEY_DEFAULTS.frames_per_iterate,
            min=FRAMES_PER_ITERATE[0],
            soft_max=100.0,
            max=FRAMES_PER_ITERATE[1],
            options=options,
        ),
        "max_keys": IntProperty(
            name="Max Keys",
            description=(
                "Thin the animation out to this many keys, 0 for one key for every iterate; "
                "where the straight motion between keys is not proved free of contact, more are kept"
            ),
            default=0,
            min=0,
            options=options,
        ),
        "fit_bevel": BoolProperty(
            name="Fit Tube",
            description="Draw the curves as the thickest round tubes that do not touch, where they have a round bevel",
            default=True,
            options=options,
        ),
    }


SETTINGS = tuple(settings(set()))


class MobiusFlowSettings(bpy.types.PropertyGroup):
    """What to relax with and how to key it."""

    __annotations__ = settings(set())


def relax_options(values: dict[str, Any]) -> RelaxOptions:
    """The core's options from the values of the settings; raises OptionError."""
    return RelaxOptions(
        method=values["method"],
        max_iterations=values["max_iterations"],
        tolerance=values["tolerance"],
        vertices=values["vertices"] or None,
    )


def key_options(values: dict[str, Any]) -> KeyOptions:
    """The animation's options from the values of the settings; raises OptionError."""
    return KeyOptions(
        output=Output[values["keyframes"]],
        start_frame=values["start_frame"],
        frames_per_iterate=values["frames_per_iterate"],
        max_keys=values["max_keys"] or None,
        fit_bevel=values["fit_bevel"],
    )
