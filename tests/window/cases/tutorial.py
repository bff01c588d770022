"""The steps of docs/tutorial.md, by mouse clicks: the first press, and from an empty scene to a film."""

from pathlib import Path

import bpy
import numpy as np
from case import Steps, picture, until
from hands import addon, button, here, key, open_panels, open_sidebar, window
from scene import clear, is_, look, obj, points, reaches, undone

FOLDER = Path(bpy.app.tempdir)
FILM = FOLDER / "film.mp4"  # beside the file


def first_press() -> Steps:
    """A new file, Add Knot, Relax: the tangle is in view beside the default cube, falls open and ends as a circle."""
    yield from open_sidebar()
    yield from picture("first-press-0-new")
    yield from button("curve.mobius_flow_add_knot")
    yield from until(lambda: obj().type == "CURVE", "the knot")
    yield from picture("first-press-1-added", differs_from="first-press-0-new")
    window().scene.mobius_flow.view_every = 1
    yield from button("curve.mobius_flow_relax")
    yield from reaches(12)
    yield from picture("first-press-2-falls-open", differs_from="first-press-1-added")
    yield from is_("done")
    yield from picture("first-press-3-circle", differs_from="first-press-2-falls-open")
    radii = np.linalg.norm(points() - points().mean(axis=0), axis=1)
    assert np.ptp(radii) < 1e-2 * radii.mean()


def film() -> Steps:
    """From an empty scene to a film, and what else films can meet."""
    open_panels("film")
    for step in (added, relaxed, staged, filmed, asked, taken_away, interrupted):
        yield from step()


PARTS = (first_press, film)


def added() -> Steps:
    """An empty scene, an unknot, and a file that has a name."""
    clear()
    with here():
        bpy.ops.ed.undo_push(message="Emptied")
        bpy.ops.curve.mobius_flow_add_knot(knot="thistlethwaite")
        bpy.ops.curve.mobius_flow_color_components()
        bpy.ops.ed.undo_push(message="Knot added")
    yield from open_sidebar()
    yield from look()
    with here():
        bpy.ops.view3d.zoom(delta=-1)  # the sidebar hides nothing
    bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "tutorial.blend"))
    yield from picture("tutorial-1-added")


def relaxed() -> Steps:
    """The knot moves, and the scene plays it."""
    settings = window().scene.mobius_flow
    settings.length, settings.hold_end, settings.view_every = 60, 8, 1
    yield from button("curve.mobius_flow_relax")
    yield from reaches(25)
    yield from button("curve.mobius_flow_pause")
    yield from is_("paused")
    yield from look()
    yield from picture("tutorial-2-relaxing", differs_from="tutorial-1-added")
    yield from button("curve.mobius_flow_pause")
    yield from is_("done")
    yield from button("curve.mobius_flow_scene_range")
    yield from until(lambda: window().scene.frame_end == 60, "the range")
    yield from look()
    yield from picture("tutorial-3-relaxed", differs_from="tutorial-2-relaxing")


def staged() -> Steps:
    """The stage is one step of undo; the camera sees the knot."""
    yield from button("curve.mobius_flow_set_up_stage")
    yield from until(stage, "the stage")
    yield from undone(lambda: not stage() and window().scene.camera is None, "the stage")
    yield from button("curve.mobius_flow_set_up_stage")
    yield from until(stage, "the stage again")
    window().scene.frame_set(1)
    yield from key("NUMPAD_0")
    yield from picture("tutorial-4-staged", differs_from="tutorial-3-relaxed")


def filmed() -> Steps:
    """The film appears whole, beside the file."""
    scene = window().scene
    scene.render.resolution_percentage, scene.mobius_flow_film.look = 25, "QUICK"
    before = scene.render.engine
    yield from button("curve.mobius_flow_render_film")
    yield from until(rendering, "the render to start")
    assert window().scene.name == scene.name
    for _ in range(12):  # until there are frames to be seen
        yield
    yield from picture("tutorial-5-rendering")
    yield from until(lambda: FILM.exists() and not rendering(), "the film", 200)
    yield from until(lambda: len(bpy.data.scenes) == 1, "the copy to be gone")
    yield from close_render()
    assert addon("pictures.movie").length_of(FILM) == 60
    assert window().scene.render.engine == before
    yield from picture("tutorial-6-filmed")


def asked() -> Steps:
    """A film that is there is overwritten only if that is wanted."""
    yield from button("curve.mobius_flow_render_film")
    yield from picture("tutorial-7-question", differs_from="tutorial-6-filmed")
    assert not rendering()
    yield from key("ESC")


def interrupted() -> Steps:
    """A file that is loaded ends the render, and the film that was there stays; simulated keys do not stop renders."""
    made = FILM.read_bytes()
    with here():
        bpy.ops.curve.mobius_flow_set_up_stage()
    bpy.ops.wm.save_mainfile()
    window().scene.mobius_flow_film.look = "PAPER"  # slow enough
    bpy.context.preferences.view.render_display_type = "NONE"
    with here():
        assert bpy.ops.curve.mobius_flow_render_film("INVOKE_DEFAULT", overwrite=True) == {"RUNNING_MODAL"}
    yield from until(rendering, "the render to start again")
    assert not bpy.ops.curve.mobius_flow_render_film.poll()
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    yield from until(lambda: not rendering(), "the render to end")
    assert FILM.read_bytes() == made
    assert [path.name for path in FOLDER.glob("*.mp4")] == ["film.mp4"]
    assert not list(FOLDER.glob(".*.mp4"))
    assert len(bpy.data.scenes) == 1
    yield from picture("tutorial-9-loaded")


def taken_away() -> Steps:
    """Nothing is left of the stage, and the knot is as it was."""
    with here():
        bpy.ops.curve.mobius_flow_remove_stage("INVOKE_DEFAULT", True)
    yield from until(lambda: not stage(), "the stage to be gone")
    assert list(window().scene.objects) == [obj()]
    assert addon("curves.bake").is_baked(obj().data)
    yield from look()
    yield from picture("tutorial-8-taken-away")


def stage() -> object:
    """The stage's collection, if there is one."""
    return addon("pictures.staging").own_stage(window().scene)


def rendering() -> bool:
    """Whether Blender renders."""
    return bool(bpy.app.is_job_running("RENDER"))


def close_render() -> Steps:
    """Close the window in which Blender shows what it renders."""
    for other in list(bpy.context.window_manager.windows)[1:]:
        with bpy.context.temp_override(window=other):
            bpy.ops.wm.window_close()
    yield
