"""While Blender renders nothing moves, so that the picture is of one shape; then the run goes on."""

import bpy
import numpy as np
from case import Steps, picture, until
from hands import key, window
from interruption import is_whole, over, relax
from scene import obj, points, reaches, ready, run, state


def case() -> Steps:
    yield from ready(vertices=1200)
    window().scene.mobius_flow.tolerance = 1e-7  # it takes longer than rendering
    before = points()
    camera()
    window().view_layer.objects.active = obj()
    yield from relax()
    yield from key("F12")
    yield from until(lambda: bpy.app.is_job_running("RENDER"), "the render to start")
    index, shown, looks = run().last.index, points(), 0
    yield from picture("rendering-1-rendering")
    while bpy.app.is_job_running("RENDER"):
        assert run().last.index == index
        assert np.array_equal(points(), shown)
        looks += 1
        yield
    print("MEASURED looks at a curve being rendered:", looks, flush=True)
    assert looks > 1
    yield from reaches(index + 2)
    yield from picture("rendering-2-goes-on")

    yield from key("F12")
    yield from until(lambda: bpy.app.is_job_running("RENDER"), "the render to start again")
    yield from key("ESC")
    yield from until(lambda: not bpy.app.is_job_running("RENDER"), "Esc to end the render")
    assert state() == "running", f"Esc was for the render: {state()}"
    yield from reaches(run().last.index + 1)
    yield from key("ESC")
    yield from over("Esc after rendering")
    is_whole(before)
    yield from picture("rendering-3-restored", differs_from="rendering-2-goes-on")


def camera() -> None:
    """A camera that sees the knot; a render of some seconds that opens no window."""
    scene = window().scene
    bpy.context.preferences.view.render_display_type = "NONE"
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 64, False  # not every build can denoise
    scene.render.resolution_percentage = 50
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.camera.location.z = 9.0
    scene.collection.objects.link(scene.camera)
