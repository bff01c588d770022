"""Presets: named settings, in files of Blender's own kind; some come with the extension."""

from pathlib import Path

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel
from bpy.props import StringProperty

from ...core.base import Message, MobiusFlowError
from ..properties import FURTHER, SETTINGS, shown
from ..translations import rpt_
from .button import Button

PANEL = "VIEW3D_PT_mobius_flow_presets"
SUBDIRECTORY = "mobius_flow"
ROOM = Path(__file__).parents[1]  # Blender looks for presets in its "presets"
SHIPPED = ROOM / "presets" / SUBDIRECTORY
_KEPT = ("options", *(name for name in SETTINGS if name not in FURTHER))


class CURVE_OT_mobius_flow_preset(Button, bpy.types.Operator):
    """Set the options of this preset; options that it does not name get their defaults"""

    bl_label = "Use Preset"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    filepath: StringProperty(subtype="FILE_PATH", options={"SKIP_SAVE", "HIDDEN"})

    def act(self, context: bpy.types.Context) -> None:
        """Run the preset; only presets that say so change how a motion is kept."""
        path = Path(self.filepath)
        if not path.is_file():
            raise MobiusFlowError(Message("The preset {name} no longer exists; choose another one", name=path.name))
        settings = context.scene.mobius_flow
        before = {name: getattr(settings, name) for name in _KEPT}
        for name in ("options", *(option.name for option in shown() if option.row)):
            settings.property_unset(name)
        try:
            bpy.utils.execfile(self.filepath)
        except Exception as error:  # whatever its Python may raise
            for name, value in before.items():
                setattr(settings, name, value)
            sentence = "The preset {name} cannot be used here: {reason}"
            raise MobiusFlowError(Message(sentence, name=path.name, reason=error)) from error
        VIEW3D_PT_mobius_flow_presets.bl_label = bpy.path.display_name(path.name, title_case=False)


class CURVE_OT_mobius_flow_preset_add(AddPresetBase, bpy.types.Operator):
    """Keep all settings as a preset, or remove one"""

    bl_idname = "curve.mobius_flow_preset_add"
    bl_label = "Add Preset"
    preset_menu = PANEL
    preset_subdir = SUBDIRECTORY
    preset_defines = ("settings = bpy.context.scene.mobius_flow",)
    preset_values = tuple(f"settings.{name}" for name in _KEPT)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add or remove a preset; the extension's own presets stay, wherever it is installed."""
        shipped = [bpy.path.display_name(path.name, title_case=False) for path in SHIPPED.glob("*.py")]
        if self.remove_name and self.name in shipped:
            sentence = "The preset {name} belongs to Möbius Flow; only your own can be removed"
            self.report({"ERROR"}, rpt_(sentence, name=self.name))
            return {"CANCELLED"}
        return set(super().execute(context))


class VIEW3D_PT_mobius_flow_presets(PresetPanel, bpy.types.Panel):
    """The menu of presets of the extension and the user's own, in the head of the panel."""

    bl_idname = PANEL
    bl_label = "Möbius Flow Presets"
    preset_subdir = SUBDIRECTORY
    preset_operator = CURVE_OT_mobius_flow_preset.bl_idname
    preset_add_operator = CURVE_OT_mobius_flow_preset_add.bl_idname


def register() -> None:
    """Tell Blender where the extension's presets are; only 4.2.0 cannot be told, and has none."""
    if hasattr(bpy.utils, "register_preset_path"):
        bpy.utils.register_preset_path(str(ROOM))


def unregister() -> None:
    if hasattr(bpy.utils, "unregister_preset_path"):
        bpy.utils.unregister_preset_path(str(ROOM))
