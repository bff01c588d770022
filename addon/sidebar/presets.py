"""The menu of presets, in the head of the panel."""

from collections.abc import Sequence
from typing import Any

import bpy
from bl_ui.utils import PresetPanel

from ..buttons.presets import (
    PANEL,
    SHIPPED,
    SUBDIRECTORY,
    CURVE_OT_mobius_flow_preset,
    CURVE_OT_mobius_flow_preset_add,
)


class VIEW3D_PT_mobius_flow_presets(PresetPanel, bpy.types.Panel):  # noqa: N801 - Blender's naming scheme
    """Presets of the extension and the user's own."""

    bl_idname = PANEL
    bl_label = "Möbius Flow Presets"
    preset_subdir = SUBDIRECTORY
    preset_operator = CURVE_OT_mobius_flow_preset.bl_idname
    preset_add_operator = CURVE_OT_mobius_flow_preset_add.bl_idname

    def path_menu(self, places: Sequence[str], operator: str, **more: Any) -> None:
        """List the presets; those of the extension also where Blender (4.2.0) could not be told of their place."""
        ours = [] if str(SHIPPED) in places else [str(SHIPPED)]
        PresetPanel.path_menu(self, [*ours, *places], operator, **more)


CLASSES = (VIEW3D_PT_mobius_flow_presets,)
