"""Rendering a scene to a file, the same in all versions of Blender and without a display."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy

Progress = Callable[[int, int], None]

FRAME_RATE = 24
_PATIENCE = 60  # seconds
_TRIAL = """
import bpy
bpy.ops.wm.read_factory_settings()
render = bpy.context.scene.render
render.engine = "BLENDER_WORKBENCH"
render.resolution_x = render.resolution_y = 16
render.filepath = {path!r}
bpy.ops.render.render(write_still=True)
"""


def use_cycles(scene: "bpy.types.Scene", width: int, height: int, samples: int, denoising: str = "HIGH") -> None:
    """Set a scene up for Cycles, which unlike the other engines needs no graphics driver."""
    cycles = scene.cycles
    scene.render.engine = "CYCLES"
    _set_size(scene, width, height)
    scene.view_settings.view_transform = "AgX"
    scene.view_settings.look = "AgX - Medium High Contrast"
    cycles.samples = samples
    cycles.adaptive_threshold = 0.05
    cycles.max_bounces = 3
    cycles.use_denoising = True
    cycles.denoising_quality = denoising


def use_workbench(scene: "bpy.types.Scene", width: int, height: int) -> None:
    """Set a scene up for Workbench: plain shading, but many frames in little time, also without a graphics card."""
    scene.render.engine = "BLENDER_WORKBENCH"
    _set_size(scene, width, height)
    scene.view_settings.view_transform = "Standard"
    scene.display.render_aa = "5"  # the time for a frame is proportional to it
    shading = scene.display.shading
    shading.light, shading.studio_light, shading.color_type = "STUDIO", "outdoor.sl", "MATERIAL"
    shading.show_shadows, shading.shadow_intensity = True, 0.2
    shading.show_cavity, shading.cavity_type = True, "SCREEN"


def skip_frames(scene: "bpy.types.Scene") -> None:
    """Render every second frame only, for as long a film."""
    scene.frame_step, scene.render.fps = 2, FRAME_RATE // 2


def _set_size(scene: "bpy.types.Scene", width: int, height: int) -> None:
    render = scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.fps = FRAME_RATE
    render.use_persistent_data = True


def workbench_works() -> bool:
    """Try Workbench in a process of its own, since without a graphics driver it ends the process it runs in."""
    import bpy

    with tempfile.TemporaryDirectory() as room:
        trial = _TRIAL.format(path=os.path.join(room, "trial.png"))
        blender = bpy.app.binary_path
        options = ["--background", "--factory-startup", "--python-exit-code", "1", "--python-expr"]
        command = [blender, *options, trial] if blender else [sys.executable, "-c", trial]
        try:
            done = subprocess.run(command, capture_output=True, timeout=_PATIENCE, check=False)
        except (OSError, subprocess.TimeoutExpired):
            return False
        return done.returncode == 0 and bool(os.listdir(room))


def render_still(scene: "bpy.types.Scene", path: Path) -> None:
    """Render the current frame to a PNG."""
    settings = scene.render.image_settings
    settings.file_format = "PNG"
    settings.color_mode = "RGB"
    _render(scene, path)


def render_movie(scene: "bpy.types.Scene", path: Path, progress: Progress | None = None) -> None:
    """Render all frames to an MP4 that plays everywhere; ``progress`` gets the frames done and their number."""
    settings, video = scene.render.image_settings, scene.render.ffmpeg
    if hasattr(settings, "media_type"):  # Blender 5.0 and later
        settings.media_type = "VIDEO"
    settings.file_format = "FFMPEG"
    video.format, video.codec = "MPEG4", "H264"
    video.constant_rate_factor, video.ffmpeg_preset = "HIGH", "GOOD"
    video.audio_codec = "NONE"
    with _reported(scene, progress):
        _render(scene, path, animation=True)


def _render(scene: "bpy.types.Scene", path: Path, animation: bool = False) -> None:
    import bpy

    scene.render.filepath = str(path)
    scene.render.use_file_extension = False
    with quiet():
        bpy.ops.render.render(animation=animation, write_still=not animation, scene=scene.name)


@contextmanager
def _reported(scene: "bpy.types.Scene", progress: Progress | None) -> Iterator[None]:
    import bpy

    if progress is None:
        yield
        return
    first, step = scene.frame_start, scene.frame_step
    total = (scene.frame_end - first) // step + 1

    def frame_done(*_: object) -> None:
        progress((scene.frame_current - first) // step + 1, total)

    bpy.app.handlers.render_post.append(frame_done)
    try:
        yield
    finally:
        bpy.app.handlers.render_post.remove(frame_done)


@contextmanager
def quiet() -> Iterator[None]:
    """Keep Blender's own lines, which it prints past Python, out of standard output."""
    sys.stdout.flush()
    saved = os.dup(1)
    sink = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(sink, 1)
        yield
    finally:
        os.dup2(saved, 1)
        os.close(saved)
        os.close(sink)
