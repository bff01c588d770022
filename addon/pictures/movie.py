"""Films of scenes, whole or not at all: by Blender's own loop over frames, or frame by frame.

An artist's scene is filmed as it is rendered, plainly, or in a look.
"""

import os
import secrets
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

import bpy

from ...core.base import Message, MobiusFlowError, OutputError, choice
from ..curves.keyframes import all_fcurves
from . import rendering, stage, staging
from .looks import LOOKS
from .rendering import is_rendering

Progress = Callable[[int, int], None]

_MARK = "mobius_flow_copy"  # custom property of scenes made here; before Blender 5 settings of scenes are such, too
SUFFIX = ".mp4"
# how films are rendered: their labels and descriptions
CHOICES = {
    "SCENE": ("As the Scene", "With the render engine, the settings and the stage that the scene has"),
    "QUICK": ("Quick", "Plain shading by Workbench: many frames in little time"),
    **{name: (look.label, look.description) for name, look in LOOKS.items()},
}


def _write_to(scene: bpy.types.Scene, path: Path) -> None:
    """Let a scene's animation be written as an MP4 that plays everywhere, without sound."""
    settings, video = scene.render.image_settings, scene.render.ffmpeg
    if hasattr(settings, "media_type"):  # Blender 5.0 and later
        settings.media_type = "VIDEO"
    settings.file_format = "FFMPEG"
    video.format, video.codec = "MPEG4", "H264"
    video.constant_rate_factor, video.ffmpeg_preset = "HIGH", "GOOD"
    video.audio_codec = "NONE"
    scene.render.filepath, scene.render.use_file_extension = str(path), False


def render_movie(scene: bpy.types.Scene, path: Path, progress: Progress | None = None) -> None:
    """Render all frames of a scene made for that, in which F-curves alone move things, to an MP4 that plays everywhere.

    ``progress`` gets the number of frames done and of all frames. The film has the scene's resolution at 100 %; at more
    its pixels are rendered more finely. Stopped by an exception, such as a KeyboardInterrupt, it ends after the frame
    at hand, or after the seconds in which the frames are put together, and leaves nothing behind. A frame in which
    everything is where it was in another reuses that one. Raises OSError or RuntimeError if the film cannot be written.
    """
    try:
        with tempfile.TemporaryDirectory(dir=path.absolute().parent) as room:
            frames, curves = frames_of(scene), list(all_fcurves())
            drawn, pictures = dict[tuple[str, ...], Path](), list[Path]()
            for k, frame in enumerate(frames, 1):
                pose = tuple(f"{curve.evaluate(frame):.6g}" for curve in curves)  # on the way back the last bits differ
                if pose not in drawn:
                    drawn[pose] = Path(room) / f"{frame:06}.jpg"
                    scene.frame_set(frame)
                    rendering.render_still(scene, drawn[pose])
                pictures.append(drawn[pose])
                if progress is not None:
                    progress(k, len(frames))
            reel, part = _spliced(scene, pictures), Path(room) / "film.mp4"
            _write_to(reel, part)
            with rendering.quiet():
                bpy.ops.render.render(animation=True, scene=reel.name)
            if length_of(part) != len(frames):
                raise OSError(rendering.NOT_WHOLE)
            part.replace(path)
    finally:
        sweep()


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
    except RuntimeError:  # there is none, or half of one
        return 0
    length = int(clip.frame_duration)
    bpy.data.movieclips.remove(clip)
    return length


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


class Filming:
    """One film of the frames that a scene plays, in the size of its renders, through its camera.

    The scene stays as it is, but for its stage, which takes on the look: a copy is rendered, next to the film's place,
    and what is whole is moved there. In the path, Blender's ``//`` is the directory of the open file, and ``.mp4`` is
    added to a name without suffix. Raises MobiusFlowError if the film cannot be made.
    """

    def __init__(self, scene: bpy.types.Scene, path: str, look: str = "SCENE", overwrite: bool = False) -> None:
        if look not in CHOICES:
            raise MobiusFlowError(f"{look!r} is not a look for films; {choice(look, CHOICES)}")
        place, render = target(path), scene.render
        width, height = (n * render.resolution_percentage // 100 for n in (render.resolution_x, render.resolution_y))
        odd = "Frames are {width} × {height} pixels, but films need even numbers; change Size of Pictures"
        there = "{path} is there already; give the film another name, or let it be overwritten"
        nowhere = "{path} is not a directory; choose another place for the film"
        closed = "{path} cannot be written; choose another place for the film"
        wrong = {  # what would be said after minutes of rendering
            Message("Blender is rendering; wait until it is done, or stop it with Esc"): is_rendering(),
            Message("The scene has no camera; press Set Up Stage first, or add one"): scene.camera is None,
            Message(odd, width=width, height=height): width % 2 or height % 2,
            Message(there, path=place): place.exists() and not overwrite,
            Message(nowhere, path=place.parent): not place.parent.is_dir(),
            Message(closed, path=place): not os.access(place if place.exists() else place.parent, os.W_OK),
        }
        if reason := next((reason for reason, found in wrong.items() if found), None):
            raise MobiusFlowError(reason)
        sweep()
        self.path, self.frames = place, len(frames_of(scene))
        self.done, self._began = 0, 0.0  # frames that are written, and when that began
        self._part = place.with_name(f".{secrets.token_hex(8)}{SUFFIX}")
        if look in LOOKS:
            staging.renew(scene, look)
        copy = scene.copy()  # with the same objects; `sweep` removes it
        copy.name, copy[_MARK] = "Film", True
        self._scene = str(copy.name)
        if look in LOOKS:
            rendering.look_fine(copy, LOOKS[look])
        elif look == "QUICK":
            rendering.look_plain(copy)
            if made := staging.own_stage(copy):
                stage.light_workbench(copy, made)
        _write_to(copy, self._part)

    def render(self) -> None:
        """Render the film in this call; raises MobiusFlowError if it does not finish."""
        try:
            with rendering.quiet():
                bpy.ops.render.render(animation=True, scene=self._scene)
        except RuntimeError as error:
            raise OutputError(self.path, error) from error
        finally:
            whole = self.finish()
        if not whole:
            sentence = "{path}: Blender did not finish rendering the film; is the disk full?"
            raise MobiusFlowError(Message(sentence, path=self.path))

    def start(self) -> None:
        """Begin to render in Blender's own window, and return at once; call `finish` when that is over.

        Raises MobiusFlowError.
        """
        self._began = time.monotonic()
        bpy.app.handlers.render_write.append(self._count)
        try:
            bpy.ops.render.render("INVOKE_DEFAULT", animation=True, scene=self._scene)
        except RuntimeError as error:
            self.finish()
            raise OutputError(self.path, error) from error

    def _count(self, scene: bpy.types.Scene, *_: object) -> None:
        self.done += scene.name == self._scene

    @property
    def seconds_left(self) -> float | None:
        """The time for the missing frames, if they take as long as those before; None before the first."""
        return (time.monotonic() - self._began) / self.done * (self.frames - self.done) if self.done else None

    def finish(self) -> bool:
        """Put the film in its place if it is whole, and return whether it is; leave nothing else behind."""
        with suppress(ValueError):  # it was not started in a window
            bpy.app.handlers.render_write.remove(self._count)
        whole = False
        with suppress(OSError):
            if self._part.exists() and length_of(self._part) == self.frames:
                self._part.replace(self.path)
                whole = True
        with suppress(OSError):
            self._part.unlink(missing_ok=True)
        if not is_rendering():
            sweep()
        return whole


def play(path: Path) -> None:
    """Play a film in Blender's own player, or in the system's where Blender is a module; raises OutputError."""
    try:
        if bpy.app.binary_path:
            subprocess.Popen([bpy.app.binary_path, "-a", str(path)], stdout=subprocess.DEVNULL)
        else:
            bpy.ops.wm.path_open(filepath=str(path))
    except (OSError, RuntimeError) as error:
        raise OutputError(path, error) from error


def target(path: str) -> Path:
    """The path of a film; raises MobiusFlowError if the name is not a film's, or is relative to a file never saved."""
    if not path.strip():
        raise MobiusFlowError(Message("The film has no name; give it a file"))
    if path.startswith("//") and not bpy.data.filepath:
        sentence = "Save your file first, since the film goes next to it, or choose another place"
        raise MobiusFlowError(Message(sentence))
    found = Path(bpy.path.abspath(path)).absolute()
    if found.is_dir():
        raise MobiusFlowError(Message("{path} is a directory; name a file in it", path=found))
    if found.suffix and found.suffix.lower() != SUFFIX:
        sentence = "{name} does not end in {suffix}, as films do here; give it another name"
        raise MobiusFlowError(Message(sentence, name=found.name, suffix=SUFFIX))
    return found if found.suffix else found.with_suffix(SUFFIX)
