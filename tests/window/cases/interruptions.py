"""Whatever happens during a run ends it cleanly: undo, edit mode, deletion, loading, saving, disabling, and more."""

import os
from collections.abc import Callable

import bpy
import numpy as np
from case import Steps, picture, until
from hands import key, window
from scene import obj, points, reaches, ready, run, state

FILE = os.path.join(os.environ["ROOM"], "saved.blend")


def relax() -> Steps:
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.ed.undo_push(message="Before")
        assert bpy.ops.curve.mobius_flow_relax("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield from reaches(2)


def ended(what: str) -> Steps:
    yield from until(lambda: run() is None, f"the run to end after {what}")


def interrupted(what: str, act: Callable[[], object], restored: bool = True) -> Steps:
    before = points()
    worker = None
    yield from relax()
    worker = run()._worker
    act()
    yield from ended(what)
    assert worker.process.poll() is not None, "the worker's process has ended"
    assert not worker._thread.is_alive()
    if restored:
        assert np.array_equal(points(), before), what
    print("INTERRUPTED by", what, "->", state(), flush=True)


def undo() -> None:
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.ed.undo()


def rename() -> None:
    obj().name = "Renamed"
    obj().data.name = "Renamed too"


def case() -> Steps:
    yield from ready(vertices=600)
    before = points()

    yield from relax()
    yield from key("Z", ctrl=True)
    yield from ended("Ctrl-Z")
    assert np.array_equal(points(), before)

    yield from interrupted("Edit > Undo", undo, restored=False)
    assert np.array_equal(points(), before)

    yield from relax()
    yield from key("TAB")
    yield from ended("edit mode")
    assert bpy.context.mode == "EDIT_CURVE"
    yield from picture("interruptions-edit-mode")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert np.array_equal(points(), before)

    yield from relax()
    rename()
    bpy.context.scene.frame_set(7)
    bpy.ops.wm.save_as_mainfile(filepath=FILE, copy=True)
    yield from reaches(run().last.index + 2)
    assert run().name == "Renamed"
    with bpy.data.libraries.load(FILE) as (_, loaded):
        loaded.curves = ["Renamed too"]
    saved = next(data for data in bpy.data.curves if data != obj().data)
    assert len(saved.splines[0].points) == len(before), "what is saved is the curve as it was"
    bpy.data.curves.remove(saved)
    yield from key("ESC")
    yield from ended("Esc after a new name, another frame and saving")
    assert np.array_equal(points(), before)

    yield from interrupted("a new point", lambda: obj().data.splines[0].points.add(1), False)
    assert state() == "lost"
    undo()
    yield
    assert np.array_equal(points(), before)

    yield from rendering(before)

    yield from relax()
    yield from key("X")
    yield from key("RET")
    yield from until(lambda: run() is None, "the run to end after deletion")
    yield from picture("interruptions-deleted")
    print("after X:", state(), [o.name for o in bpy.data.objects], flush=True)
    if not bpy.data.objects:
        undo()
        yield
    assert np.array_equal(points(), before)

    yield from relax()
    data = obj().data
    bpy.data.objects.remove(obj())
    yield from ended("removal by a script")
    assert state() == "lost"
    assert np.array_equal(np.array([p.co[:] for p in data.splines[0].points], dtype=np.float32), before)

    yield from ready(vertices=600)
    before = points()
    bpy.ops.wm.save_as_mainfile(filepath=FILE)
    yield from interrupted("a new window's closing", close_second_window, restored=True)

    yield from interrupted("a file", lambda: bpy.ops.wm.open_mainfile(filepath=FILE))
    yield from ready(vertices=600)
    yield from relax()
    before_names = set(dir(bpy.types.Scene))
    disable()
    yield
    assert "mobius_flow" in before_names
    assert not hasattr(bpy.types.Scene, "mobius_flow")
    assert np.array_equal(points(), before)
    assert not left_over()
    yield from picture("interruptions-disabled")


def rendering(before: np.ndarray) -> Steps:
    """Nothing moves while Blender renders; then the run goes on."""
    scene = window().scene
    bpy.context.preferences.view.render_display_type = "NONE"
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 64
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.camera.location.z = 9.0
    scene.collection.objects.link(scene.camera)
    yield from relax()
    with bpy.context.temp_override(window=window()):
        assert bpy.ops.render.render("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    index, looks = run().last.index, 0
    while bpy.app.is_job_running("RENDER"):
        assert run().last.index == index
        looks += 1
        yield
    print("MEASURED looks at a curve being rendered:", looks, flush=True)
    assert looks > 1
    yield from reaches(index + 2)
    yield from key("ESC")
    yield from ended("Esc after rendering")
    assert np.array_equal(points(), before)


def close_second_window() -> None:
    """Not the window of the run: that goes on, and Esc ends it."""
    manager = bpy.context.window_manager
    bpy.ops.wm.window_new()
    with bpy.context.temp_override(window=manager.windows[-1]):
        bpy.ops.wm.window_close()
    assert run() is not None
    run().cancel()


def disable() -> None:
    run_ = run()
    bpy.ops.preferences.addon_disable(module="bl_ext.user_default.mobius_flow")
    assert run_.state.value == "cancelled"
    assert run_._worker.process.poll() is not None


def left_over() -> list[str]:
    """Handlers of ours that are still there."""
    lists = [getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers)]
    return [
        f.__module__ for handlers in lists if isinstance(handlers, list) for f in handlers if "mobius" in f.__module__
    ]
