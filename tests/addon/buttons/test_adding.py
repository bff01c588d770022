"""Knots that are added: woven ones of the table, families, and smooth ones, picked in the gallery or by search."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import contents, sentence, stored
from mobius_flow.addon import settings as gallery
from mobius_flow.addon.buttons import adding, drawing
from mobius_flow.addon.pictures import icons
from mobius_flow.addon.pictures.icons import GROUPS, labels
from mobius_flow.core import Curve
from mobius_flow.core.collision import check_embedded, gap
from mobius_flow.core.knots import KNOTS, knot, rounded, smooth_knot
from panel_layout import Layout


def added(**options):
    assert bpy.ops.curve.mobius_flow_add_knot(**options) == {"FINISHED"}
    return bpy.context.object


def picked(**options):
    assert bpy.ops.curve.mobius_flow_pick_knot(**options) == {"FINISHED"}
    return bpy.context.object


def sizes(obj):
    assert all(spline.use_cyclic_u and spline.type == "POLY" for spline in obj.data.splines)
    return tuple(len(spline.points) for spline in obj.data.splines)


@pytest.mark.parametrize(
    ("options", "name", "components"),
    [
        ({}, "thistlethwaite", 1),
        ({"knot": "L2a1"}, "L2a1", 2),
        ({"kind": "TORUS", "p": 4, "q": 6}, "T(4,6)", 2),
        ({"kind": "BRAID"}, "braid(1,-2,1,-2,1,-2)", 3),
        ({"kind": "BRAID", "word": "1, 1 ,1"}, "braid(1,1,1)", 1),
        ({"kind": "LISSAJOUS"}, "Lissajous(3,4,7)", 1),
        ({"kind": "CABLE"}, "Cable(2,1) of 3_1", 1),
        ({"kind": "CABLE", "companion": "figure-eight", "strands": 3, "turns": 3}, "Cable(3,3) of figure-eight", 3),
        ({"kind": "DOUBLE", "companion": "4_1 Figure-Eight", "twists": 1}, "Double of 4_1", 1),
    ],
)
def test_a_knot_is_added(options, name, components):
    bpy.context.scene.cursor.location = (3, 2, 1)
    obj = added(**options, size=2.5)
    assert (obj.name, obj.type, obj.select_get()) == (name, "CURVE", True)
    assert tuple(obj.location) == (3, 2, 1)
    assert len(sizes(obj)) == components
    if options.get("kind", "TABLE") in ("TABLE", "TORUS"):
        assert sizes(obj) == rounded(knot(name)).mesh.component_sizes  # its height does not change how it is cut
    points = stored(obj.data).astype(np.float64)
    assert np.ptp(points, axis=0).max() == pytest.approx(5)
    np.testing.assert_allclose(points.max(axis=0) + points.min(axis=0), 0, atol=1e-6)
    check_embedded(Curve.from_components(np.split(points, np.cumsum(sizes(obj))[:-1])))
    assert bpy.ops.curve.mobius_flow_relax(max_iterations=1) == {"FINISHED"}


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
def test_what_is_picked_is_the_relaxed_shape(options, name):
    bpy.context.scene.cursor.location = (3, 2, 1)
    obj = picked(**options, size=2.5)
    expected = smooth_knot(name, options.get("vertices")).vertices
    expected = expected - 0.5 * (expected.min(axis=0) + expected.max(axis=0))
    assert tuple(obj.location) == (3, 2, 1)
    np.testing.assert_allclose(stored(obj.data), expected * 5 / np.ptp(expected, axis=0).max(), atol=1e-5)
    assert len(sizes(obj)) == (3 if name == "L6a4" else 1)
    assert obj.data.bevel_depth > 0.05


def test_a_tube_is_as_thick_as_asked_for_or_fits():
    for given in (0.125, 0.0):
        assert added(thickness=given).data.bevel_depth == given
        assert added(fit_bevel=False, thickness=given).data.bevel_depth == given
    fitted = added()
    room = gap.thickness(Curve(stored(fitted.data).astype(np.float64)))
    assert 0.5 * room < fitted.data.bevel_depth <= room
    assert added(fit_bevel=True, thickness=0.125).data.bevel_depth == fitted.data.bevel_depth


def test_knots_are_added_beside_each_other_unless_a_place_is_given():
    for _ in range(3):
        added()
    first, *others = [obj.location.copy() for obj in sorted(bpy.data.objects, key=lambda obj: obj.location.x)]
    assert all(b.x - a.x > 2 for a, b in zip([first, *others], others, strict=False))
    assert added(location=first).location == first


@pytest.mark.parametrize(
    ("add", "options"),
    [
        (added, {"knot": "nonsense"}),
        (added, {"knot": ""}),
        (added, {"kind": "TORUS", "p": 0, "q": 3}),
        (added, {"knot": "m torus( 500, 501 )"}),
        (added, {"knot": "braid(" + ",".join(map(str, range(1, 300))) + ")"}),
        (added, {"kind": "BRAID", "word": "1 x"}),
        (added, {"kind": "LISSAJOUS", "frequency_x": 2, "frequency_y": 4}),
        (added, {"kind": "DOUBLE", "companion": "L2a1 Hopf Link"}),
        *((added, {name: float(value)}) for name in ("size", "thickness") for value in ("nan", "inf")),
        (picked, {"knot": "nonsense"}),
        (picked, {"knot": "granny"}),
        (picked, {"knot": "5_1", "vertices": 6}),
    ],
)
def test_what_is_none_is_refused(add, options):
    before = contents()
    with pytest.raises(RuntimeError) as error:
        add(**options)
    assert len(sentence(error.value)) > 10
    assert contents() == before


def test_the_gallery_has_every_knot_in_one_group_and_files_keep_what_was_picked(monkeypatch, tmp_path):
    monkeypatch.setattr(icons, "icon", lambda _: 0)
    settings = bpy.context.scene.mobius_flow_knots
    assert settings.knot == "3_1"
    shown = []
    for group in GROUPS:
        settings.group = group
        assert gallery.group(settings.knot) == group
        names = [item[0] for item in gallery._knots(settings.group)]
        assert 5 < len(names) < 90
        shown += names
    assert shown == list(KNOTS)
    assert set(labels()) == set(KNOTS)
    settings.group, settings.knot = "9", "9_42"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    assert bpy.context.scene.mobius_flow_knots.knot == "9_42"


@pytest.mark.parametrize(
    ("cls", "first"),
    [
        (adding.CURVE_OT_mobius_flow_add_knot, ["kind", "knot", "size"]),
        (adding.CURVE_OT_mobius_flow_pick_knot, ["knot", "mirror", "vertices", "size"]),
        (drawing.CURVE_OT_mobius_flow_draw_knot, ["mirror", "height", "number", "hide_drawing", "color_components"]),
        (drawing.CURVE_OT_mobius_flow_stroke, ["color_components", "fit_bevel", "thickness"]),
    ],
)
def test_its_settings_can_be_changed_afterwards(cls, first):
    declared = getattr(bpy.ops.curve, cls.bl_idname.partition(".")[2]).get_rna_type().properties
    values = {each.identifier: getattr(each, "default", None) for each in declared}
    double = SimpleNamespace(layout=Layout(), common=cls.common, placing=cls.placing, **values)
    double.own = lambda: cls.own(double)
    cls.draw(double, None)
    assert double.layout.settings[: len(first)] == first
