"""Buttons of the panel Film."""

import time
from types import SimpleNamespace

import bpy
import pytest
from blender_scenes import add_trefoil, contents
from mobius_flow.addon.buttons import film as buttons
from mobius_flow.addon.buttons.film import CURVE_OT_mobius_flow_render_film
from mobius_flow.addon.pictures import staging
from mobius_flow.addon.pictures.movie import Filming, length_of

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


def test_a_film_in_a_look_is_that_of_the_stage(scene, tmp_path):
    OPS.mobius_flow_set_up_stage()
    curve = bpy.context.object.data
    assert curve.materials[0].name == "Dark Studio 6"
    eye = scene.camera
    Filming(scene, str(tmp_path / "film.mp4"), "STUDIO").finish()
    assert scene.camera == eye, "a stage in that look, which somebody may have changed, stays"
    OPS.mobius_flow_render_film(filepath=str(tmp_path / "film.mp4"), look="PAPER")
    pale = scene.world.node_tree.nodes["Background"].inputs["Color"].default_value
    assert tuple(pale)[:3] == pytest.approx((0.36, 0.39, 0.43))
    assert curve.materials[0].name == "Paper 6"


def test_other_objects_are_left_out_until_the_stage_goes(scene, capfd):
    for name in ("Cube", "Hidden", "Post"):
        obj = bpy.data.objects.new(name, bpy.data.meshes.new(name))
        scene.collection.objects.link(obj)
    bpy.data.objects["Hidden"].hide_render = True
    scene.mobius_flow_surroundings.container = bpy.data.objects["Post"]
    OPS.mobius_flow_set_up_stage()
    assert "Renders leave out 'Cube' until you press Remove Stage" in capfd.readouterr().out
    OPS.mobius_flow_set_up_stage()
    assert {obj.name for obj in scene.objects if obj.hide_render} == {"Cube", "Hidden"}
    OPS.mobius_flow_remove_stage()
    assert {obj.name for obj in scene.objects if obj.hide_render} == {"Hidden"}
    OPS.mobius_flow_set_up_stage(hide_others=False)
    assert not bpy.data.objects["Cube"].hide_render


def test_the_stage_is_one_step_of_undo(scene):
    bpy.ops.ed.undo_push(message="Before")
    before = contents()
    OPS.mobius_flow_set_up_stage("INVOKE_DEFAULT", True)
    assert staging.own_stage(scene)
    bpy.ops.ed.undo()
    assert contents() == before
    assert staging.own_stage(bpy.context.scene) is None
    assert bpy.context.scene.camera is None


def test_the_stage_changes_no_selection_and_goes(scene, capfd):
    obj = bpy.context.object
    obj.data.bevel_depth = 0
    before = contents()
    OPS.mobius_flow_set_up_stage()
    assert "Renders do not show 'Knot'" in capfd.readouterr().out
    assert bpy.context.selected_objects == [obj]
    assert bpy.context.object == obj
    OPS.mobius_flow_remove_stage()
    assert contents() == before
    assert not OPS.mobius_flow_remove_stage.poll()


class Waiting:
    """A double of Render Film whose render has begun; Blender starts none without a window."""

    modal = CURVE_OT_mobius_flow_render_film.modal
    cancel = CURVE_OT_mobius_flow_render_film.cancel
    _end = CURVE_OT_mobius_flow_render_film._end
    _report_film = CURVE_OT_mobius_flow_render_film._report_film

    def __init__(self, scene, path):
        self.filming, self.timer, self.reports = Filming(scene, str(path)), object(), []
        self.removed = []
        self.said = []
        self.context = SimpleNamespace(
            window_manager=SimpleNamespace(event_timer_remove=self.removed.append),
            workspace=SimpleNamespace(status_text_set=self.said.append),
        )

    def report(self, kind, message):
        self.reports.append((kind, message))

    def event(self, kind="TIMER"):
        return self.modal(self.context, SimpleNamespace(type=kind))

    def render(self):
        """What Blender does meanwhile."""
        bpy.ops.render.render(animation=True, scene=self.filming._scene)


def test_in_a_window_it_waits_for_the_end(scene, tmp_path, monkeypatch):
    OPS.mobius_flow_set_up_stage()
    waiting = Waiting(scene, tmp_path / "film.mp4")
    with monkeypatch.context() as patch:
        patch.setattr(buttons, "is_rendering", lambda: True)
        assert waiting.event() == waiting.event("MOUSEMOVE") == {"PASS_THROUGH"}
        assert waiting.said[-1] == "Rendering the film: 0 of 2 frames"
        waiting.filming._began, waiting.filming.done = time.monotonic() - 20, 1
        assert waiting.event() == {"PASS_THROUGH"}
        assert waiting.said[-1] == "Rendering the film: 1 of 2 frames, about 20 s left"
    waiting.filming.done = 0
    bpy.app.handlers.render_write.append(waiting.filming._count)
    waiting.render()
    assert waiting.filming.done == 2
    assert waiting.event("MOUSEMOVE") == {"PASS_THROUGH"}
    assert waiting.event() == {"FINISHED"}
    assert waiting.reports == [({"INFO"}, f"A film of 2 frames: {tmp_path / 'film.mp4'}")]
    assert waiting.removed == [waiting.timer]
    assert length_of(tmp_path / "film.mp4") == 2
    assert list(bpy.data.scenes) == [scene]


def test_play_film_needs_one(scene, tmp_path, monkeypatch):
    scene.mobius_flow_film.filepath = str(tmp_path / "film.mp4")
    assert not OPS.mobius_flow_play_film.poll()
    scene.mobius_flow_film.filepath = ""
    assert not OPS.mobius_flow_play_film.poll()
    scene.mobius_flow_film.filepath = str(tmp_path / "film.mp4")
    (tmp_path / "film.mp4").write_bytes(b"a film")
    played = []
    monkeypatch.setattr(buttons, "play", played.append)
    assert OPS.mobius_flow_play_film() == {"FINISHED"}
    assert played == [tmp_path / "film.mp4"]


@pytest.mark.parametrize("how", ["event", "cancel"])
def test_a_render_that_was_stopped_leaves_no_file(scene, tmp_path, how):
    OPS.mobius_flow_set_up_stage()
    waiting = Waiting(scene, tmp_path / "film.mp4")
    bpy.data.scenes[waiting.filming._scene].frame_end = 1  # the first frame was done
    waiting.render()
    if how == "event":
        assert waiting.event() == {"CANCELLED"}
        assert waiting.reports == [({"WARNING"}, "The film was not finished; no file was written")]
    else:
        waiting.cancel(waiting.context)
    assert waiting.removed == [waiting.timer]
    assert list(tmp_path.iterdir()) == []
    assert list(bpy.data.scenes) == [scene]
