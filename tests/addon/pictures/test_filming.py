"""Films of a scene: whole or not at all, and the scene is not touched."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_trefoil
from mobius_flow.addon.pictures import movie, rendering
from mobius_flow.addon.pictures.movie import Filming, length_of
from mobius_flow.core import MobiusFlowError


@pytest.fixture
def scene():
    """Three frames of nothing, fast to render."""
    scene = bpy.context.scene
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 1, False
    scene.render.resolution_x, scene.render.resolution_y = 64, 36
    scene.frame_start, scene.frame_end = 5, 7
    scene.frame_set(6)
    return scene


def settings(scene):
    render = scene.render
    return (
        [render.engine, render.filepath, render.image_settings.file_format, render.use_file_extension],
        [scene.view_settings.view_transform, scene.display.render_aa, scene.frame_current, scene.cycles.samples],
    )


@pytest.mark.parametrize(("step", "count"), [(1, 3), (2, 2)])
def test_a_film_has_every_frame_and_leaves_the_scene_alone(scene, tmp_path, step, count):
    scene.frame_step = step
    before = settings(scene)
    film = Filming(scene, str(tmp_path / "film"))
    film.render()
    assert film.path == tmp_path / "film.mp4"
    assert film.frames == length_of(film.path) == count
    assert [path.name for path in tmp_path.iterdir()] == ["film.mp4"]
    assert settings(scene) == before
    assert list(bpy.data.scenes) == [scene]


def test_half_a_film_is_none(scene, tmp_path, monkeypatch):
    monkeypatch.setattr(movie, "length_of", lambda _path: 2)
    (tmp_path / "film.mp4").write_bytes(b"old")
    with pytest.raises(MobiusFlowError, match="did not finish rendering"):
        Filming(scene, str(tmp_path / "film.mp4"), overwrite=True).render()
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"old"]
    assert list(bpy.data.scenes) == [scene]


def test_a_copy_that_was_saved_meanwhile_is_swept_away(scene, tmp_path):
    Filming(scene, str(tmp_path / "film.mp4"))
    film = Filming(scene, str(tmp_path / "film.mp4"))
    assert len(bpy.data.scenes) == 2
    film.finish()
    assert list(bpy.data.scenes) == [scene]


WRONG = [
    ({"camera": None}, "film.mp4", "no camera; press Set Up Stage"),
    ({"render.resolution_x": 63}, "film.mp4", "63 × 36 pixels"),
    ({}, "there.mp4", "is there already"),
    ({}, "nowhere/film.mp4", "is not a directory"),
    ({}, "film.avi", r"does not end in \.mp4"),
    ({}, "", "is a directory"),
]


@pytest.mark.parametrize(("change", "name", "said"), WRONG)
def test_what_would_go_wrong_is_said_first(scene, tmp_path, change, name, said):
    (tmp_path / "there.mp4").touch()
    for path, value in change.items():
        setattr(scene.render if "." in path else scene, path.rpartition(".")[2], value)
    with pytest.raises(MobiusFlowError, match=said) as error:
        Filming(scene, f"{tmp_path}/{name}")
    assert "\n" not in str(error.value)
    assert list(bpy.data.scenes) == [scene]
    assert [path.name for path in tmp_path.iterdir()] == ["there.mp4"]


def test_no_setting_of_a_scene_is_taken_for_the_mark(scene):
    """Before Blender 5 custom properties and those of extensions have one and the same place."""
    assert not hasattr(bpy.types.Scene, movie._MARK)


def test_names_of_films_and_looks(scene, tmp_path):
    for name, said in (("//film.mp4", "Save your file first"), (" ", "no name")):
        with pytest.raises(MobiusFlowError, match=said):
            Filming(scene, name)
    with pytest.raises(MobiusFlowError, match="did you mean QUICK"):
        Filming(scene, str(tmp_path / "film.mp4"), "quick")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    assert movie.target("//film") == tmp_path / "film.mp4"


def test_quick_films_are_lit_from_where_the_stages_first_light_is(scene, tmp_path):
    add_trefoil().data.bevel_depth = 0.1
    bpy.ops.curve.mobius_flow_set_up_stage()
    film = Filming(scene, str(tmp_path / "film.mp4"), "QUICK")
    (copy,) = set(bpy.data.scenes) - {scene}
    light = next(each for each in scene.objects if each.type == "LIGHT").matrix_world.col[2]
    np.testing.assert_allclose(copy.display.light_direction, [light[0], light[2], -light[1]], atol=1e-6)
    film.finish()


def test_a_quick_film(scene, tmp_path):
    if not rendering.workbench_works():
        pytest.skip("Workbench needs a graphics driver")
    Filming(scene, str(tmp_path / "film.mp4"), "QUICK").render()
