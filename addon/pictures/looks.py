"""What the frames of a film look like: as the scene is rendered, or in one of two ways that need no settings."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from . import rendering, stage, staging

if TYPE_CHECKING:
    import bpy

_SAMPLES = 32


def _as_it_is(_scene: "bpy.types.Scene") -> None:
    """Leave everything as the artist has it."""


def _quick(scene: "bpy.types.Scene") -> None:
    rendering.look_plain(scene)
    if direction := staging.key_direction(scene):
        stage.light_workbench(scene, direction)


def _fine(scene: "bpy.types.Scene") -> None:
    rendering.look_fine(scene, _SAMPLES)


@dataclass(frozen=True)
class Look:
    """A look: what people call it, what they are told of it, and what sets a scene up for it."""

    label: str
    description: str
    set_up: "Callable[[bpy.types.Scene], None]"


LOOKS = {
    "SCENE": Look("As the Scene", "With the render engine and the settings that the scene has", _as_it_is),
    "QUICK": Look("Quick", "Plain shading by Workbench: many frames in little time", _quick),
    "FINE": Look("Fine", "Soft light and shadows by Cycles: seconds or minutes for each frame", _fine),
}
