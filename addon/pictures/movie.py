"""Films of scenes, whole or not at all: by Blender's own loop over frames, or frame by frame.

Blender's own loop shows a window with progress and an Esc, and otherwise cannot be interrupted. Frame by frame every
picture is a file, and then they are put together.
"""

import secrets
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path

import bpy

from ..curves.keyframes import all_fcurves
from . import rendering

Progress = Callable[[int, int], None]

_MARK = "mobius_flow_copy"  # custom property of scenes made here; before Blender 5 settings of scenes are such, too


class Reel:
    """A scene made for one film, which is rendered beside its place and moved there if it is whole."""

    def __init__(self, scene: bpy.types.Scene, path: Path) -> None:
        self.path = path
        self.frames = len(frames_of(scene))
        self.done, self._began = 0, 0.0  # frames that are written, and when that began
        self._part = path.with_name(f".{secrets.token_hex(8)}{path.suffix}")
        self._scene = str(scene.name)
        _use_h264(scene)
        scene.render.filepath, scene.render.use_file_extension = str(self._part), False

    def render(self) -> None:
        """Render the film in this call; raises OSError or RuntimeError if it does not come to its end."""
        try:
            with rendering.quiet():
                bpy.ops.render.render(animation=True, scene=self._scene)
        finally:
            whole = self.finish()
        if not whole:
            raise OSError(rendering.NOT_WHOLE)

    def start(self) -> None:
        """Begin to render in Blender's own window, and return at once; `finish` is to be called when that is over."""
        self._began = time.monotonic()
        bpy.app.handlers.render_write.append(self._count)
        try:
            bpy.ops.render.render("INVOKE_DEFAULT", animation=True, scene=self._scene)
        except RuntimeError:
            self.finish()
            raise

    @property
    def seconds_left(self) -> float | None:
        """How long the frames that are missing take, if they take as long as those before; None before the first."""
        return (time.monotonic() - self._began) / self.done * (self.frames - self.done) if self.done else None

    def _count(self, scene: bpy.types.Scene, *_: object) -> None:
        self.done += scene.name == self._scene

    def finish(self) -> bool:
        """Put the film in its place if it is whole, and return whether it is; leave nothing else behind."""
        with suppress(ValueError):  # it was not started in a window
            bpy.app.handlers.render_write.remove(self._count)
        try:
            whole = self._part.exists() and length_of(self._part) == self.frames
            if whole:
                self._part.replace(self.path)
        finally:
            with suppress(OSError):
                self._part.unlink(missing_ok=True)
            if not rendering.is_rendering():
                sweep()
        return whole


def render_movie(scene: bpy.types.Scene, path: Path, progress: Progress | None = None) -> None:
    """Render all frames of a scene made for that, in which F-curves alone move things, to an MP4 that plays everywhere.

    ``progress`` gets the number of frames done and of all frames. The film has the scene's resolution at 100 %; at more
    its pixels are rendered more finely. Stopped by an exception, such as a KeyboardInterrupt, it ends after the frame
    at hand, or after the seconds in which the frames are put together, and leaves nothing behind. A frame in which
    all is where it was in another is that one again. Raises OSError or RuntimeError if the film cannot be written.
    """
    try:
        with tempfile.TemporaryDirectory(dir=path.absolute().parent) as room:
            pictures = list(_pictures(scene, Path(room), progress or (lambda *_: None)))
            Reel(_spliced(scene, pictures), path).render()
    finally:
        sweep()


def copied(scene: bpy.types.Scene) -> bpy.types.Scene:
    """A copy of a scene with the same objects, to be rendered with other settings, until `sweep`."""
    copy = scene.copy()
    copy.name, copy[_MARK] = "Film", True
    return copy


def sweep() -> None:
    """Remove scenes made here: those just rendered, and any that was saved while it was being rendered."""
    for scene in [each for each in bpy.data.scenes if _MARK in each]:
        bpy.data.scenes.remove(scene)


def frames_of(scene: bpy.types.Scene) -> range:
    return range(scene.frame_start, scene.frame_end + 1, scene.frame_step)


def length_of(path: Path) -> int:
    """Count a film's frames; Blender does not notice when it cannot write all of them."""
    try:
        clip = bpy.data.movieclips.load(str(path))
    except RuntimeError:
        return 0
    length = int(clip.frame_duration)
    bpy.data.movieclips.remove(clip)
    return length


def _pictures(scene: bpy.types.Scene, room: Path, progress: Progress) -> Iterator[Path]:
    frames = frames_of(scene)
    curves, pictures = list(all_fcurves()), dict[tuple[str, ...], Path]()
    for k, frame in enumerate(frames, 1):
        pose = tuple(f"{curve.evaluate(frame):.6g}" for curve in curves)  # on the way back the last bits differ
        if pose not in pictures:
            pictures[pose] = room / f"{frame:06}.jpg"
            scene.frame_set(frame)
            rendering.render_still(scene, pictures[pose])
        yield pictures[pose]
        progress(k, len(frames))


def _spliced(scene: bpy.types.Scene, pictures: Sequence[Path]) -> bpy.types.Scene:
    """A new scene that shows pictures from one directory for a frame each, in the size and speed of another's film."""
    reel = bpy.data.scenes.new("Film")
    reel[_MARK] = True
    for name in ("resolution_x", "resolution_y", "fps", "fps_base"):
        setattr(reel.render, name, getattr(scene.render, name))
    reel.view_settings.view_transform = "Standard"  # the pictures have their colours
    reel.frame_start, reel.frame_end = 1, len(pictures)
    editor = reel.sequence_editor_create()
    strips = editor.strips if hasattr(editor, "strips") else editor.sequences  # Blender 4.3 and before
    strip = strips.new_image("Film", str(pictures[0]), channel=1, frame_start=1, fit_method="FIT")
    for picture in pictures[1:]:
        strip.elements.append(picture.name)
    if scene.render.resolution_percentage > 100:  # of all filters nearest to many samples; it would blur equal sizes
        strip.transform.filter = "CUBIC_BSPLINE"
    return reel


def _use_h264(scene: bpy.types.Scene) -> None:
    """Let a scene's animation be written as an MP4 that plays everywhere, without sound."""
    settings, video = scene.render.image_settings, scene.render.ffmpeg
    if hasattr(settings, "media_type"):  # Blender 5.0 and later
        settings.media_type = "VIDEO"
    settings.file_format = "FFMPEG"
    video.format, video.codec = "MPEG4", "H264"
    video.constant_rate_factor, video.ffmpeg_preset = "HIGH", "GOOD"
    video.audio_codec = "NONE"
