"""Buttons of the panel Film."""

import pytest

bpy = pytest.importorskip("bpy")

from blender_scenes import add_trefoil, contents, sentence  # noqa: E402
from mobius_flow.addon.buttons.film import CURVE_OT_mobius_flow_render_film, CURVE_OT_mobius_flow_set_up_stage  # noqa: E402
from mobius_flow.addon.pictures import staging  # noqa: E402
from mobius_flow.addon.pictures.movie import length_of  # noqa: E402

OPS = bpy.ops.curve


@pytest.fixture
def scene():
    """A trefoil, and frames fast to render."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 1, False
    scene.render.resolution_x, scene.render.resolution_y = 64, 36
    scene.frame_start, scene.frame_end = 1, 2
    add_trefoil().data.bevel_depth = 0.1
    return scene


def test_stage_and_film(scene, tmp_path):
    assert OPS.mobius_flow_set_up_stage() == {"FINISHED"}
    scene.mobius_flow_film.filepath = str(tmp_path / "film.mp4")
    assert OPS.mobius_flow_render_film() == {"FINISHED"}
    assert length_of(tmp_path / "film.mp4") == 2
    with pytest.raises(RuntimeError, match="is there already"):
        OPS.mobius_flow_render_film()
    assert OPS.mobius_flow_render_film(overwrite=True) == {"FINISHED"}
    assert OPS.mobius_flow_render_film(filepath=str(tmp_path / "other.mp4"), look="SCENE") == {"FINISHED"}
    assert scene.mobius_flow_film.filepath == str(tmp_path / "film.mp4")


def test_the_stage_is_one_step_of_undo(scene):
    bpy.ops.ed.undo_push(message="Before")
    before = contents()
    OPS.mobius_flow_set_up_stage("INVOKE_DEFAULT", True)
    assert staging.own_stage(scene)
    bpy.ops.ed.undo()
    assert contents() == before
    assert staging.own_stage(bpy.context.scene) is None
    assert bpy.context.scene.camera is None


def test_the_stage_is_removed(scene):
    before = contents()
    OPS.mobius_flow_set_up_stage()
    OPS.mobius_flow_remove_stage()
    assert contents() == before
    assert not OPS.mobius_flow_remove_stage.poll()


def test_the_selection_stays(scene):
    obj = bpy.context.object
    OPS.mobius_flow_set_up_stage()
    assert bpy.context.selected_objects == [obj]
    assert bpy.context.object == obj


def test_a_curve_that_renders_do_not_show_is_told_of(scene, capfd):
    bpy.context.object.data.bevel_depth = 0
    OPS.mobius_flow_set_up_stage()
    assert "Renders do not show 'Knot'" in capfd.readouterr().out


def test_what_is_wanted_first(scene):
    assert CURVE_OT_mobius_flow_render_film.refusal(bpy.context).sentence.startswith("The scene has no camera")
    bpy.context.object.data.splines[0].use_cyclic_u = False
    assert "is open" in CURVE_OT_mobius_flow_set_up_stage.refusal(bpy.context).sentence
    bpy.ops.object.select_all(action="DESELECT")
    before = contents()
    with pytest.raises(RuntimeError) as error:
        OPS.mobius_flow_set_up_stage()
    assert "Select a curve object first" in sentence(error.value)
    assert contents() == before
