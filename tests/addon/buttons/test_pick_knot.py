"""Knots picked from the table, in the gallery and by search."""

import bpy
import numpy as np
import pytest
from blender_scenes import contents, sentence, stored
from mobius_flow.addon import settings as gallery
from mobius_flow.addon.engine.knot_list import GROUPS, labels
from mobius_flow.addon.pictures import icons
from mobius_flow.core.knots import KNOTS, smooth_knot


def picked(**options):
    """The object added for these options."""
    assert bpy.ops.curve.mobius_flow_pick_knot(**options) == {"FINISHED"}
    return bpy.context.object


@pytest.mark.parametrize(
    ("options", "name"),
    [
        ({}, "3_1"),
        ({"knot": "4_1 Figure-Eight"}, "4_1"),
        ({"knot": "figure-eight"}, "4_1"),
        ({"choice": "5_2"}, "5_2"),
        ({"knot": "L6a4 Borromean Rings"}, "L6a4"),
        ({"knot": "3_1 Trefoil", "mirror": True}, "m3_1"),
        ({"knot": "7_4", "vertices": 300}, "7_4"),
    ],
)
def test_it_is_the_relaxed_shape(options, name):
    bpy.context.scene.cursor.location = (3, 2, 1)
    obj = picked(**options, size=2.5)
    points = stored(obj.data).astype(np.float64)
    expected = smooth_knot(name, options.get("vertices")).vertices
    expected = expected - 0.5 * (expected.min(axis=0) + expected.max(axis=0))
    assert tuple(obj.location) == (3, 2, 1)
    np.testing.assert_allclose(points, expected * 5 / np.ptp(expected, axis=0).max(), atol=1e-5)
    assert all(spline.use_cyclic_u and spline.type == "POLY" for spline in obj.data.splines)
    assert obj.data.bevel_depth > 0.05


def test_components_of_links_have_their_own_materials():
    one, two = picked(knot="L6a4"), picked(knot="hopf")
    assert [spline.material_index for spline in one.data.splines] == [0, 1, 2]
    assert [m.name for m in two.data.materials] == [m.name for m in one.data.materials][:2]
    assert len({tuple(material.diffuse_color) for material in one.data.materials}) == 3
    bpy.ops.curve.mobius_flow_color_components()
    assert len(two.data.materials) == 2, "the button's materials are the same"
    assert not picked(knot="hopf", color_components=False).data.materials
    assert not picked(knot="3_1").data.materials


def test_a_material_that_was_changed_stays():
    material = picked(knot="hopf").data.materials[0]
    material.diffuse_color = (0, 0, 0, 1)
    assert picked(knot="hopf").data.materials[0] == material
    assert tuple(material.diffuse_color) == (0, 0, 0, 1)


@pytest.mark.parametrize(
    "options", [{"knot": "nonsense"}, {"knot": ""}, {"knot": "granny"}, {"knot": "5_1", "vertices": 6}]
)
def test_what_is_none_is_refused(options):
    before = contents()
    with pytest.raises(RuntimeError) as error:
        picked(**options)
    assert len(sentence(error.value)) > 10
    assert contents() == before


def test_the_gallery_has_every_knot_in_one_group(monkeypatch):
    monkeypatch.setattr(icons, "icon", lambda _: 0)
    settings = bpy.context.scene.mobius_flow_knots
    assert settings.knot == "3_1"
    shown = []
    for group in GROUPS:
        settings.group = group
        assert gallery.group(settings.knot) == group
        names = [item[0] for item in gallery._knots(settings, bpy.context)]
        assert 5 < len(names) < 90
        shown += names
        settings.knot = names[-1]
        assert settings.knot == names[-1]
    assert shown == list(KNOTS)
    assert set(labels()) == set(KNOTS)


def test_what_is_picked_is_saved_with_the_file(tmp_path):
    settings = bpy.context.scene.mobius_flow_knots
    settings.group, settings.knot = "9", "9_42"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    assert bpy.context.scene.mobius_flow_knots.knot == "9_42"


def test_every_setting_says_what_it_does():
    for name in ("pick_knot", "add_knot", "draw_knot"):
        own = getattr(bpy.ops.curve, f"mobius_flow_{name}").get_rna_type().properties
        for each in own:
            if each.identifier not in ("rna_type", "align", "location", "rotation"):
                assert each.description, each.identifier
                assert not each.description.endswith("."), each.identifier
