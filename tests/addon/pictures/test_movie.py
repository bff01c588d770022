"""Films are rendered frame by frame: what does not move once, whole or not at all, and can be stopped at any frame."""

import os
import signal
import sys
from contextlib import contextmanager

import bpy
import numpy as np
import pytest
from mobius_flow.addon.pictures import movie, rendering
from mobius_flow.addon.pictures.looks import LOOKS
from processes import finished

FRAMES, MOVING = 8, 5  # the last frames are like the fifth


@pytest.fixture
def scene():
    """A grey sky that becomes brighter until it stays as it is."""
    scene = bpy.context.scene
    rendering.use_cycles(scene, LOOKS["PAPER"], 128, 64, 1)
    scene.cycles.use_denoising = False
    scene.view_settings.view_transform, scene.view_settings.look = "Standard", "None"
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    scene.world = bpy.data.worlds.new("World")
    if scene.world.node_tree is None:
        scene.world.use_nodes = True
    strength = scene.world.node_tree.nodes["Background"].inputs["Strength"]
    for frame in range(1, MOVING + 1):
        strength.default_value = 3.0 * frame
        strength.keyframe_insert("default_value", frame=frame)
    scene.frame_start, scene.frame_end = 1, FRAMES
    return scene


@pytest.fixture
def rendered(monkeypatch):
    """The frames that are rendered from now on."""
    frames = []
    render = rendering.render_still

    def noted(scene, *arguments):
        frames.append(scene.frame_current)
        render(scene, *arguments)

    monkeypatch.setattr(rendering, "render_still", noted)
    return frames


def frames_of(path, count):
    """The frames of a film: brightness between 0 and 1, of shape (height, width)."""
    viewer = bpy.data.scenes.new("Viewer")
    viewer.render.resolution_x, viewer.render.resolution_y = 128, 64
    viewer.view_settings.view_transform = "Standard"
    editor = viewer.sequence_editor_create()
    strips = editor.strips if hasattr(editor, "strips") else editor.sequences
    strips.new_movie("Film", str(path), channel=1, frame_start=1)
    viewer.frame_start, viewer.frame_end = 1, count
    viewer.render.filepath = str(path.with_name("frame"))
    with rendering.quiet():
        bpy.ops.render.render(animation=True, scene=viewer.name)
    bpy.data.scenes.remove(viewer)
    for picture in sorted(path.parent.glob("frame*.png")):
        yield np.array(bpy.data.images.load(str(picture)).pixels[:]).reshape(64, 128, 4)[:, :, :3].mean(axis=2)


def shown(strength):
    """What a grey sky of that strength looks like on a screen."""
    linear = 0.0508761 * strength  # the colour of a new world's background
    return 1.055 * linear ** (1 / 2.4) - 0.055


def test_what_does_not_move_is_rendered_once(tmp_path, scene, rendered):
    seen = []
    movie.render_movie(scene, tmp_path / "a.mp4", lambda *counts: seen.append(counts))
    assert rendered == [1, 2, 3, 4, 5]
    assert seen == [(k, FRAMES) for k in range(1, FRAMES + 1)]
    assert movie.length_of(tmp_path / "a.mp4") == FRAMES


@pytest.mark.parametrize("step", [1, 3])
@pytest.mark.parametrize("percentage", [100, 150])
def test_every_frame_shows_its_time_in_its_colours(tmp_path, scene, step, percentage):
    scene.frame_step, scene.render.resolution_percentage = step, percentage
    path, frames = tmp_path / "a.mp4", range(1, FRAMES + 1, step)
    movie.render_movie(scene, path)
    clip = bpy.data.movieclips.load(str(path))
    assert (tuple(clip.size), clip.frame_duration) == ((128, 64), len(frames))
    for frame, picture in zip(frames, frames_of(path, len(frames)), strict=True):
        np.testing.assert_allclose(picture, shown(3.0 * min(frame, MOVING)), atol=0.03)


@pytest.mark.parametrize("percentage", [100, 150])
def test_a_film_shows_the_whole_picture(tmp_path, scene, percentage):
    scene.frame_end, scene.render.resolution_percentage = 2, percentage
    scene.render.use_border, scene.render.border_max_x = True, 0.25  # the rest stays black
    movie.render_movie(scene, tmp_path / "a.mp4")
    picture, _ = frames_of(tmp_path / "a.mp4", 2)
    np.testing.assert_allclose(picture[:, :28], shown(3.0), atol=0.05)
    np.testing.assert_allclose(picture[:, 36:], 0, atol=0.05)


@pytest.mark.parametrize("stop", [1, 3, FRAMES, "while it is encoded"])
def test_stopped_within_one_frame_without_a_trace(tmp_path, scene, rendered, monkeypatch, stop):
    """By the keyboard, while so many frames are done."""
    (tmp_path / "a.mp4").write_text("old")
    splice = movie._spliced

    def watch(done, _total):
        if done == stop:
            signal.raise_signal(signal.SIGINT)

    def stopped(*arguments):
        splice(*arguments)
        raise KeyboardInterrupt

    if stop not in range(FRAMES + 1):
        monkeypatch.setattr(movie, "_spliced", stopped)
    with pytest.raises(KeyboardInterrupt):
        movie.render_movie(scene, tmp_path / "a.mp4", watch)
    assert rendered == list(range(1, min(stop if isinstance(stop, int) else FRAMES, MOVING) + 1))
    assert os.listdir(tmp_path) == ["a.mp4"]
    assert (tmp_path / "a.mp4").read_text() == "old"
    assert list(bpy.data.scenes) == [scene]


@pytest.mark.parametrize("suffix", [".jpg", ".mp4"])
def test_a_full_disk_is_noticed(tmp_path, scene, monkeypatch, suffix):
    """Blender's operator says it has written what is only half there."""
    quiet = rendering.quiet

    @contextmanager
    def half_written():
        with quiet():
            yield
        for path in tmp_path.rglob(f"*{suffix}"):
            os.truncate(path, path.stat().st_size // 2)

    monkeypatch.setattr(rendering, "quiet", half_written)
    with pytest.raises(OSError, match="disk full"):
        movie.render_movie(scene, tmp_path / "a.mp4")
    assert os.listdir(tmp_path) == []
    assert list(bpy.data.scenes) == [scene]
    assert not bpy.data.movieclips


PROCESS = """
import os, signal, sys
import numpy as np
from mobius_flow.addon.pictures import export
from mobius_flow.core import Curve, RelaxOptions, relax
export._FILM_WITHOUT_DRIVER, export.rendering.workbench_works = (64, 36, 1), lambda: False
t = np.linspace(0, 2 * np.pi, 40, endpoint=False)
curve = Curve(np.stack([np.cos(t), 2 * np.sin(t), 0.5 * np.sin(2 * t)], axis=1))
def progress(done, total):
    print(done, flush=True)
    if done == 3:
        os.kill(os.getpid(), int(sys.argv[1]))
export.write_movie("a.mp4", list(relax(curve, RelaxOptions(max_iterations=3))), progress)
"""


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's")
@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGINT, -signal.SIGINT), (signal.SIGTERM, 128 + signal.SIGTERM)]
)
def test_a_signal_ends_it_tidily(tmp_path, number, status):
    command = [sys.executable, "-c", PROCESS, str(int(number))]
    done = finished(command, cwd=tmp_path)
    assert [line for line in done.stdout.split("\n") if line.isdigit()] == ["1", "2", "3"], done.stderr
    assert done.returncode == status
    assert os.listdir(tmp_path) == []
