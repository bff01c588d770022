"""Films: every frame a picture, then the pictures in one file. Blender's own loop over frames cannot be interrupted."""

import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from ..curves.fcurves import all_fcurves
from . import rendering

if TYPE_CHECKING:
    import bpy

Progress = Callable[[int, int], None]

_KEPT = ("media_type", "file_format", "color_mode", "color_depth", "compression")  # each depends on those before
_COMPRESSION = 5  # percent: the pictures live for a minute


def render_movie(scene: "bpy.types.Scene", path: Path, progress: Progress | None = None, oversampling: int = 1) -> None:
    """Render all frames to an MP4 that plays everywhere.

    Stopped by an exception, such as a KeyboardInterrupt, it ends after the frame at hand, or after the seconds in which
    the frames are put together. Then too nothing is left behind and the scene is as before. A frame in which nothing
    has moved is the frame before again.

    Parameters
    ----------
    scene
        What to render; all that moves is moved by F-curves.
    path
        The file; it appears whole or not at all.
    progress
        Gets the number of frames done and of all frames.
    oversampling
        A pixel of the film is the mean of so many times so many rendered ones.

    Raises
    ------
    OSError, RuntimeError
        If the film cannot be written.
    """
    with tempfile.TemporaryDirectory(dir=path.absolute().parent) as room, _kept(scene):
        made = Path(room) / path.name
        size = scene.render.resolution_percentage
        scene.render.resolution_percentage = size * oversampling
        pictures = list(_pictures(scene, Path(room), progress or (lambda *_: None)))
        scene.render.resolution_percentage = size
        _encode(scene, pictures, made)
        made.replace(path)


def _pictures(scene: "bpy.types.Scene", room: Path, progress: Progress) -> Iterator[Path]:
    """Render a scene's frames; the same picture may come more than once."""
    frames = range(scene.frame_start, scene.frame_end + 1, scene.frame_step)
    curves = list(all_fcurves())
    shown, picture = None, room
    for k, frame in enumerate(frames, 1):
        pose = [curve.evaluate(frame) for curve in curves]
        if pose != shown:
            shown, picture = pose, room / f"{frame:06}.png"
            scene.frame_set(frame)
            rendering.render_still(scene, picture, _COMPRESSION)
        yield picture
        progress(k, len(frames))


@contextmanager
def _kept(scene: "bpy.types.Scene") -> Iterator[None]:
    """Put a scene's frame and the settings for pictures back at the end."""
    render, settings = scene.render, scene.render.image_settings
    frame = scene.frame_current, scene.frame_subframe
    kept = [(settings, name) for name in _KEPT if hasattr(settings, name)]
    kept += [(render, name) for name in ("filepath", "use_file_extension", "resolution_percentage")]
    values = [getattr(owner, name) for owner, name in kept]
    try:
        yield
    finally:
        for (owner, name), value in zip(kept, values, strict=True):
            setattr(owner, name, value)
        scene.frame_set(frame[0], subframe=frame[1])


def _encode(scene: "bpy.types.Scene", pictures: Sequence[Path], path: Path) -> None:
    """Put pictures into one file, in the size and at the speed of a scene's film."""
    import bpy

    reel = bpy.data.scenes.new("Film")
    try:
        for name in ("resolution_x", "resolution_y", "resolution_percentage", "fps", "fps_base"):
            setattr(reel.render, name, getattr(scene.render, name))
        reel.view_settings.view_transform = "Standard"  # the pictures have their colours
        reel.frame_start, reel.frame_end = 1, len(pictures)
        _splice(reel, pictures)
        use_h264(reel)
        reel.render.filepath, reel.render.use_file_extension = str(path), False
        with rendering.quiet():
            bpy.ops.render.render(animation=True, scene=reel.name)
    finally:
        bpy.data.scenes.remove(reel)
    if length_of(path) != len(pictures):
        raise OSError(rendering.NOT_WHOLE)


def length_of(path: Path) -> int:
    """Count a film's frames; Blender does not notice when it cannot write all of them."""
    import bpy

    try:
        clip = bpy.data.movieclips.load(str(path))
    except RuntimeError:
        return 0
    length = int(clip.frame_duration)
    bpy.data.movieclips.remove(clip)
    return length


def _splice(reel: "bpy.types.Scene", pictures: Sequence[Path]) -> None:
    """Fill a scene's sequencer with pictures from one directory, each for one frame."""
    editor = reel.sequence_editor_create()
    strips = editor.strips if hasattr(editor, "strips") else editor.sequences  # Blender 4.3 and before
    strip = strips.new_image("Film", str(pictures[0]), channel=1, frame_start=1, fit_method="FIT")
    for picture in pictures[1:]:
        strip.elements.append(picture.name)
    strip.transform.filter = "BOX"


def use_h264(reel: "bpy.types.Scene") -> None:
    """Let a scene's animation be written as an MP4 that plays everywhere, without sound."""
    settings, video = reel.render.image_settings, reel.render.ffmpeg
    if hasattr(settings, "media_type"):  # Blender 5.0 and later
        settings.media_type = "VIDEO"
    settings.file_format = "FFMPEG"
    video.format, video.codec = "MPEG4", "H264"
    video.constant_rate_factor, video.ffmpeg_preset = "HIGH", "GOOD"
    video.audio_codec = "NONE"
