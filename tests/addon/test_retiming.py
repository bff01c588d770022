"""A finished film follows the settings of its timing at once: its keys stay, and are passed at other frames."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import add_trefoil, evaluated, relax
from mobius_flow.addon.buttons import button, relaxing
from mobius_flow.addon.curves import bake
from mobius_flow.addon.curves.keyframes import all_fcurves, frames_of

pytestmark = pytest.mark.usefixtures("defaults")
EVEN = {"radius": "none", "timing": "EVEN", "length": 40, "max_iterations": 8}


@pytest.fixture
def settings():
    return bpy.context.scene.mobius_flow


@pytest.fixture
def film():
    add_trefoil()
    return relax(**EVEN)


def ends(obj):
    return evaluated(obj, frames_of(obj.data)[0]), evaluated(obj, frames_of(obj.data)[-1])


def test_length_and_rests_and_pace_act_at_once(film, settings):
    before, count = ends(film), len(frames_of(film.data))
    settings.timing, settings.length = "EVEN", 90
    assert bake.scene_range([film]) == (1, 90)
    settings.hold_start, settings.hold_end = 10, 20
    frames = frames_of(film.data)
    assert bake.scene_range([film]) == (1, 90)
    assert (frames[0], frames[-1], len(frames)) == (11, 70, count)
    settings.start_frame = 5
    assert bake.scene_range([film]) == (5, 94)
    steps = []
    for settings.timing in ("DISTANCE", "FLOW_TIME", "ITERATE"):
        steps.append(np.diff(frames_of(film.data)))
    assert all(not np.allclose(*pair) for pair in (steps[:2], steps[1:]))
    settings.frames_per_iterate = 2.5
    assert frames_of(film.data)[-1] - frames_of(film.data)[0] == pytest.approx(2.5 * 8)
    for one, other in zip(before, ends(film), strict=True):
        np.testing.assert_array_equal(one, other)
    kept = frames_of(film.data)
    settings.hold_end, settings.timing = 500, "EVEN"  # which do not go together
    settings.length = 89
    np.testing.assert_array_equal(frames_of(film.data), kept)
    assert bake.is_baked(film.data)
    assert not bake.is_edited(film.data)


def test_others_are_not_retimed_nor_keys_that_somebody_has_moved(settings):
    obj = add_trefoil()
    relax(**EVEN)
    obj.select_set(False)
    settings.length = 90
    assert bake.scene_range([obj]) == (1, 40)
    obj.select_set(True)
    (curve,) = (curve for curve in all_fcurves() if curve.data_path == "eval_time")
    curve.keyframe_points[3].co.x += 0.4
    curve.update()
    settings.length = 80
    assert bake.scene_range([obj]) == (1, 40)


def test_the_frames_that_the_scene_plays_follow_and_so_does_the_stage(settings):
    add_trefoil()
    relax(**EVEN)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 40
    assert bpy.ops.curve.mobius_flow_set_up_stage() == {"FINISHED"}
    settings.length = 90
    assert (scene.frame_start, scene.frame_end) == (1, 90)
    for start, played in ((-9, (0, 80)), (-20, (0, 69)), (1, (1, 90))):  # no scene plays negative frames
        scene.mobius_flow.start_frame = start
        assert (scene.frame_start, scene.frame_end) == played
    moved = [curve for curve in all_fcurves() if curve.data_path == "location"]
    assert moved
    assert all(curve.keyframe_points[-1].co.x == 90 for curve in moved)
    scene.frame_end = 70
    settings.length = 50
    assert scene.frame_end == 70


def asked(name, monkeypatch, **values):
    """The menus that an operator shows when it is pressed in a window; if there are none, it begins."""
    menus = []
    manager = SimpleNamespace(popup_menu=lambda draw, **_: menus.append(draw))
    context = bpy.context
    here = SimpleNamespace(
        window=object(),
        window_manager=manager,
        view_layer=context.view_layer,
        active_object=context.active_object,
        selected_objects=context.selected_objects,
    )
    cls = getattr(relaxing, f"CURVE_OT_mobius_flow_{name}")
    pressed = type("Pressed", (SimpleNamespace,), {"bl_idname": cls.bl_idname, "moving": cls.moving, "asks": cls.asks})
    with monkeypatch.context() as patch:
        patch.setattr(button, "bpy", SimpleNamespace(app=SimpleNamespace(background=False), types=bpy.types))
        begins = {"begin": lambda _context: {"RUNNING_MODAL"}, "sample_splines": False, "again": False}
        said = cls.invoke(pressed(**begins | {"continues": cls.continues} | values), here, None)
    assert said == ({"CANCELLED"} if menus else {"RUNNING_MODAL"})
    return menus


def test_relax_on_a_film_asks_and_a_script_says_what_it_replaces(capfd, monkeypatch):
    obj = add_trefoil()
    bpy.context.scene.mobius_flow.timing = "ITERATE"
    relax(max_iterations=3)
    relax(max_iterations=2)
    assert "; 3 keys in place of 4 up to frame 3, " in capfd.readouterr().out
    offered = []

    class Layout:
        def operator(self, name, text, **_):
            offered.append((name, self.operator_context, text))
            return self

    class Menu:
        layout = Layout()

    asked("relax", monkeypatch)[0](Menu, bpy.context)
    assert [name for name, *_ in offered] == ["curve.mobius_flow_continue", "curve.mobius_flow_relax"]
    assert {context for _, context, _ in offered} == {"INVOKE_DEFAULT"}
    assert Menu.layout.again is True
    for name in ("bake_again", "pack"):
        offered.clear()
        asked(name, monkeypatch)[0](Menu, bpy.context)
        assert [name for name, *_ in offered] == [f"curve.mobius_flow_{name}"]
    assert not asked("relax", monkeypatch, again=True)
    assert not asked("continue", monkeypatch)
    other = add_trefoil()
    obj.select_set(True)
    assert asked("morph", monkeypatch)  # only the one that moves gets keys
    bpy.context.view_layer.objects.active = obj
    assert not asked("morph", monkeypatch)
    obj.select_set(False)
    bpy.context.view_layer.objects.active = other
    assert not asked("relax", monkeypatch)
    assert obj.data.shape_keys


def test_smooth_splines_are_offered_as_polygons_by_the_button_that_was_pressed(monkeypatch):
    bpy.ops.curve.primitive_bezier_circle_add()
    offered, told = [], []
    layout = SimpleNamespace(
        operator=lambda name, **_: offered.append(name) or layout, label=lambda text, **_: told.append(text)
    )
    asked("pack", monkeypatch)[0](SimpleNamespace(layout=layout), bpy.context)
    assert offered == ["curve.mobius_flow_pack"]
    assert "become polygons, of 48 points in all" in told[0]
    assert (layout.sample_splines, layout.again) == (True, True)
    assert not asked("pack", monkeypatch, sample_splines=True)
