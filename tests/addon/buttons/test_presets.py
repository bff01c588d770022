"""Presets in Blender's own menu: those of the extension, and the user's, which can be added and removed."""

from pathlib import Path

import bpy
import pytest
from mobius_flow.addon.buttons import presets
from mobius_flow.addon.buttons.presets import VIEW3D_PT_mobius_flow_presets
from mobius_flow.addon.properties import SETTINGS, key_options, relax_options
from mobius_flow.core import METHODS

SHIPPED = {bpy.path.display_name(path.name, title_case=False): path for path in sorted(presets.SHIPPED.glob("*.py"))}


@pytest.fixture
def user(tmp_path, monkeypatch):
    """Where the user's presets are, instead of in the user's own configuration."""
    monkeypatch.setattr(bpy.utils, "user_resource", lambda _kind, path="", create=False: _directory(tmp_path / path))
    monkeypatch.setattr(bpy.utils, "script_paths", lambda **_: [str(_directory(tmp_path / "presets"))])
    return tmp_path / "presets" / presets.SUBDIRECTORY


@pytest.fixture(autouse=True)
def title():
    """Blender gives the menu the name of the preset that was used last."""
    before = VIEW3D_PT_mobius_flow_presets.bl_label
    yield
    VIEW3D_PT_mobius_flow_presets.bl_label = before


def _directory(path):
    path.mkdir(parents=True, exist_ok=True)
    return str(path)


def use(path):
    assert bpy.ops.curve.mobius_flow_preset(filepath=str(path)) == {"FINISHED"}
    return bpy.context.scene.mobius_flow


def values():
    settings = bpy.context.scene.mobius_flow
    return {name: getattr(settings, name) for name in SETTINGS}


@pytest.mark.parametrize("path", SHIPPED.values(), ids=SHIPPED)
def test_a_preset_of_the_extension_can_be_relaxed_with(path):
    before = values()
    use(path)
    assert values() != before
    options = relax_options(values())
    key_options(values())
    assert not METHODS[options.method].comparison


def test_a_preset_that_is_gone_is_refused_in_one_sentence(tmp_path):
    with pytest.raises(RuntimeError, match=r"The preset Old\.py no longer exists; choose another one"):
        bpy.ops.curve.mobius_flow_preset(filepath=str(tmp_path / "Old.py"))


def test_a_preset_that_names_what_is_not_there_is_refused_and_changes_nothing(tmp_path):
    before, path = values(), tmp_path / "Old.py"
    wanted = "bpy.context.scene.mobius_flow"
    path.write_text(f"import bpy\n{wanted}.tolerance = 0.5\n{wanted}.length = 9\n{wanted}.method = 'missing'\n")
    with pytest.raises(RuntimeError, match=r"The preset Old\.py cannot be used here: method is 'missing'; "):
        bpy.ops.curve.mobius_flow_preset(filepath=str(path))
    assert values() == before


def test_a_preset_of_ones_own_keeps_every_setting(user):
    settings = bpy.context.scene.mobius_flow
    settings.energy, settings.tolerance, settings.hold_end, settings.fit_bevel = "edge", 0.02, 9, False
    wanted = values()
    assert bpy.ops.curve.mobius_flow_preset_add(name="My Knots") == {"FINISHED"}
    (path,) = user.glob("*.py")
    assert path.name == "My_Knots.py"
    for name in settings.bl_rna.properties.keys():  # noqa: SIM118
        settings.property_unset(name)
    assert values() != wanted
    use(path)
    assert values() == wanted
    assert bpy.ops.curve.mobius_flow_preset_add(name="My Knots", remove_name=True) == {"FINISHED"}
    assert not path.exists()


@pytest.mark.parametrize("name", SHIPPED)
def test_presets_of_the_extension_stay(user, name):
    with pytest.raises(RuntimeError, match=f"The preset {name} belongs to Möbius Flow; only your own can be removed"):
        bpy.ops.curve.mobius_flow_preset_add(name=name, remove_name=True)
    assert bpy.ops.curve.mobius_flow_preset_add(name=name) == {"CANCELLED"}
    assert SHIPPED[name].exists()
    assert not list(user.glob("*"))


def listed():
    """The files that the menu shows."""
    shown = []

    class Row:
        def __getattr__(self, _name):
            return lambda *_, **__: self

        def operator(self, name, **_):
            button = type("Button", (), {})()
            shown.append((name, button))
            return button

    class Menu:
        layout = Row()
        path_menu = VIEW3D_PT_mobius_flow_presets.path_menu
        bl_idname, preset_subdir = presets.PANEL, presets.SUBDIRECTORY
        preset_operator = VIEW3D_PT_mobius_flow_presets.preset_operator
        preset_add_operator = VIEW3D_PT_mobius_flow_presets.preset_add_operator

    bpy.types.Menu.draw_preset(Menu(), bpy.context)
    return [Path(button.filepath).stem for name, button in shown if name == Menu.preset_operator]


def test_the_menu_lists_both_kinds_once(user):
    bpy.ops.curve.mobius_flow_preset_add(name="My Knots")
    assert sorted(listed()) == sorted([*(path.stem for path in SHIPPED.values()), "My_Knots"])
