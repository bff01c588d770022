"""Lengths in the units that a scene shows."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy


def length(scene: "bpy.types.Scene", value: float) -> str:
    """Write a length with its unit, in four digits or so."""
    import bpy

    units = scene.unit_settings
    text = bpy.utils.units.to_string(
        units.system, "LENGTH", value * units.scale_length, precision=4, split_unit=units.use_separate
    )
    return str(text).strip()
