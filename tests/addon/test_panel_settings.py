"""Quality is what the options amount to, whoever sets them."""

import bpy
import pytest
from mobius_flow.addon.properties import QUALITIES


def panel():
    return bpy.context.scene.mobius_flow_panel


def test_the_first_quality_is_the_librarys():
    assert panel().quality == "GOOD"


@pytest.mark.parametrize("name", QUALITIES)
def test_choosing_a_quality_sets_its_options(name, capfd):
    settings = bpy.context.scene.mobius_flow
    settings.method, settings.vertices, settings.energy = "flow-l2", 77, "edge"
    assert panel().quality == "CUSTOM"
    settings.options += " nonsense"
    panel().quality = name
    assert (panel().quality, capfd.readouterr().err) == ("CUSTOM", "")
    settings.options = settings.options.removesuffix(" nonsense")
    panel().quality = name
    assert panel().quality == name
    for option, value in QUALITIES[name].values.items():
        assert getattr(settings, option) == (pytest.approx(value) if isinstance(value, float) else value)
    assert settings.energy == "edge"


def test_custom_leaves_all_as_it_is():
    before = bpy.context.scene.mobius_flow.tolerance
    panel().quality = "CUSTOM"
    assert (panel().quality, bpy.context.scene.mobius_flow.tolerance) == ("GOOD", before)


def test_tooltips_say_what_a_quality_means():
    items = panel().bl_rna.properties["quality"].enum_items
    for name, quality in QUALITIES.items():
        assert (items[name].name, items[name].description) == (quality.label, quality.description)
    assert all(items[name].description.isprintable() for name in [*QUALITIES, "CUSTOM"])


def test_every_scene_has_its_own():
    other = bpy.data.scenes.new("Other")
    other.mobius_flow_panel.quality = "EXACT"
    assert (other.mobius_flow_panel.quality, panel().quality) == ("EXACT", "GOOD")
