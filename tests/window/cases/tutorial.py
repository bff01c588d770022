"""The steps of docs/tutorial.md, by mouse clicks: from an empty scene to a film; and what else films can meet."""

from pathlib import Path

import bpy
from case import Steps, picture, until
from hands import addon, button, here, key, open_panels, open_sidebar, window
from scene import clear, is_, look, obj, reaches

FOLDER = Path(bpy.app.tempdir)


def case() -> Steps:
    open_panels("film")
    yield from added()
    yield from relaxed()
    yield from staged()
    yield from filmed()
    yield from asked()
    yield from taken_away()
    yield from interrupted()


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
    yield from key("Z", ctrl=True)
    yield from until(lambda: not stage() and window().scene.camera is None, "undo")
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
    assert window_scene() == scene.name
    for _ in range(12):  # until there are frames to be seen
        yield
    yield from picture("tutorial-5-rendering")
    yield from until(lambda: film().exists() and not rendering(), "the film", 200)
    yield from until(lambda: len(bpy.data.scenes) == 1, "the copy to be gone")
    yield from close_render()
    assert length() == 60
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
    made = film().read_bytes()
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
    assert film().read_bytes() == made
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


def window_scene() -> str:
    """Name of the scene that the window shows."""
    return str(window().scene.name)


def film() -> Path:
    """The film, beside the file."""
    return FOLDER / "film.mp4"


def length() -> int:
    """Its number of frames."""
    return int(addon("pictures.movie").length_of(film()))


def close_render() -> Steps:
    """Close the window in which Blender shows what it renders."""
    for other in list(bpy.context.window_manager.windows)[1:]:
        with bpy.context.temp_override(window=other):
            bpy.ops.wm.window_close()
    yield
