"""Rendering a scene to a file, the same in all versions of Blender and without a display."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import bpy

from ...core.base.deadline import signals_wait
from .looks import Look

NOT_WHOLE = "Blender did not finish writing it; is the disk full?"
_TRIAL = """
import bpy
bpy.ops.wm.read_factory_settings()
render = bpy.context.scene.render
render.engine = "BLENDER_WORKBENCH"
render.resolution_x = render.resolution_y = 16
render.filepath = {path!r}
bpy.ops.render.render(write_still=True)
"""


def use_cycles(scene: bpy.types.Scene, look: Look, width: int, height: int, samples: int | None = None) -> None:
    """Set a scene up for films by Cycles, which unlike the other engines needs no graphics driver."""
    look_fine(scene, look, samples)
    _set_size(scene, width, height)


def empty_scene() -> bpy.types.Scene:
    """An empty factory scene, which replaces what is open in Blender."""
    with quiet():
        bpy.ops.wm.read_factory_settings(use_empty=True)
    return bpy.context.scene


def look_fine(scene: bpy.types.Scene, look: Look, samples: int | None = None) -> None:
    """Let a scene be rendered by Cycles; drafts, of so few samples, are denoised less well, in a third of the time."""
    cycles = scene.cycles
    scene.render.engine = "CYCLES"
    scene.view_settings.view_transform = "AgX"
    scene.view_settings.look = "AgX - Medium High Contrast"
    scene.view_settings.exposure = 0.0
    cycles.samples = samples or look.samples
    cycles.adaptive_threshold = 0.05
    cycles.max_bounces = cycles.transmission_bounces = look.bounces
    cycles.sample_clamp_indirect = 4.0  # of light along paths seldom found: without it single pixels stay bright
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.use_denoising = True  # by OpenImageDenoise, which all builds have
    cycles.denoising_quality = "BALANCED" if samples else "HIGH"
    cycles.denoising_input_passes = "RGB_ALBEDO_NORMAL"


def use_workbench(scene: bpy.types.Scene, width: int, height: int) -> None:
    """Set a scene up for films by Workbench, also without a graphics card.

    Edges are left jagged. More pixels than the film has look as smooth as Workbench's own antialiasing and take less
    than half as long without a graphics card, since everything is drawn once only.
    """
    look_plain(scene)
    _set_size(scene, width, height)
    scene.render.resolution_percentage = 140
    scene.display.render_aa = "OFF"


def look_plain(scene: bpy.types.Scene) -> None:
    """Let a scene be drawn by Workbench: plain shading, but many frames in little time."""
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.view_settings.view_transform = "Standard"
    scene.display.render_aa = "8"
    shading = scene.display.shading
    shading.light, shading.studio_light, shading.color_type = "STUDIO", "outdoor.sl", "TEXTURE"
    shading.show_cavity, shading.cavity_type = True, "SCREEN"  # dark lines where a strand passes behind another
    shading.curvature_ridge_factor, shading.curvature_valley_factor = 0.0, 1.5
    shading.show_shadows, shading.shadow_intensity = True, 0.2


def _set_size(scene: bpy.types.Scene, width: int, height: int) -> None:
    render = scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.fps = 24
    render.use_persistent_data = True


def workbench_works() -> bool:
    """Try Workbench in an isolated process, since without a graphics driver it ends the process it runs in."""
    with tempfile.TemporaryDirectory() as room:
        trial = _TRIAL.format(path=os.path.join(room, "trial.png"))
        blender = bpy.app.binary_path
        options = ["--background", "--factory-startup", "--python-exit-code", "1", "--python-expr"]
        command = [blender, *options, trial] if blender else [sys.executable, "-I", "-c", trial]
        try:
            done = subprocess.run(command, capture_output=True, timeout=60, check=False)
        except (OSError, subprocess.TimeoutExpired):
            return False
        return done.returncode == 0 and bool(os.listdir(room))


def render_still(scene: bpy.types.Scene, path: Path) -> None:
    """Render the current frame to a PNG, or to a JPEG if it is to end in .jpg.

    Raises OSError if the picture is not whole, which Blender does not notice.
    """
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):  # Blender 5.0 and later
        settings.media_type = "IMAGE"
    settings.file_format, end = ("JPEG", b"\xff\xd9") if path.suffix == ".jpg" else ("PNG", b"IEND\xaeB`\x82")
    settings.color_mode, settings.quality = "RGBA" if scene.render.film_transparent else "RGB", 100
    scene.render.filepath = str(path)
    scene.render.use_file_extension = False
    with quiet():
        bpy.ops.render.render(write_still=True, scene=scene.name)
    if not path.read_bytes().endswith(end):
        raise OSError(NOT_WHOLE)


def save(path: Path) -> None:
    with quiet():
        bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=True)


def is_rendering() -> bool:
    """Whether Blender renders something in the background of a window."""
    return bool(bpy.app.is_job_running("RENDER"))


@contextmanager
def quiet() -> Iterator[None]:
    """Keep the lines that Blender and graphics drivers print, past Python, out of standard output and error.

    Signals wait: what their handlers raise is lost in Cycles' own Python.
    """
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()
    saved = [os.dup(number) for number in (1, 2)]
    sink = os.open(os.devnull, os.O_WRONLY)
    try:
        for number in (1, 2):
            os.dup2(sink, number)
        with signals_wait():
            yield
    finally:
        for number, descriptor in zip((1, 2), saved, strict=True):
            os.dup2(descriptor, number)
            os.close(descriptor)
        os.close(sink)
