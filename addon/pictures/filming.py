"""A scene rendered to a film by Blender's own loop over frames, in a window with its progress and its Esc.

What is rendered is a copy of the scene that has the film's settings and the same objects, so that the scene itself is
never touched, whatever ends the render. The film appears whole or not at all.
"""

import os
import secrets
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from ...core import MobiusFlowError
from ...core.errors import OutputError, choice
from ...core.messages import Message
from .looks import LOOKS
from .movie import length_of, use_h264
from .rendering import quiet

if TYPE_CHECKING:
    import bpy

SUFFIX = ".mp4"
_MARK = "mobius_flow_copy"  # custom property of the copies; before Blender 5 settings of scenes are such, too


class Filming:
    """One film of a scene.

    Parameters
    ----------
    scene
        What is filmed: the frames that it plays, in the size of its renders, through its camera.
    path
        The file, with Blender's ``//`` for the directory of the open file; ``.mp4`` is added to a name without suffix.
    look
        One of `LOOKS`.
    overwrite
        Whether a file that is there may be replaced.

    Attributes
    ----------
    path
        The file.
    frames
        Number of the film's frames.

    Raises
    ------
    MobiusFlowError
        If the film cannot be made; the message says why.
    """

    def __init__(self, scene: "bpy.types.Scene", path: str, look: str = "SCENE", overwrite: bool = False) -> None:
        if look not in LOOKS:
            raise MobiusFlowError(f"{look!r} is no look of films; {choice(look, LOOKS)}")
        self.path = target(path)
        _check(scene, self.path, overwrite)
        _sweep()
        self.frames = len(range(scene.frame_start, scene.frame_end + 1, scene.frame_step))
        self._part = self.path.with_name(f".{secrets.token_hex(8)}{SUFFIX}")
        self._copy = self._copied(scene, look)

    def _copied(self, scene: "bpy.types.Scene", look: str) -> str:
        made = scene.copy()
        made.name, made[_MARK] = "Film", True
        LOOKS[look].set_up(made)
        use_h264(made)
        made.render.filepath, made.render.use_file_extension = str(self._part), False
        return str(made.name)

    def render(self) -> None:
        """Render the film in this call; raises MobiusFlowError if it does not come to its end."""
        import bpy

        try:
            with quiet():
                bpy.ops.render.render(animation=True, scene=self._copy)
        except RuntimeError as error:
            raise OutputError(self.path, error) from error
        finally:
            whole = self.finish()
        if not whole:
            raise MobiusFlowError(
                Message("{path}: Blender did not render the film to its end; is the disk full?", path=self.path)
            )

    def start(self) -> None:
        """Begin to render in Blender's own window, and return at once; `finish` is to be called when `over`."""
        import bpy

        try:
            bpy.ops.render.render("INVOKE_DEFAULT", animation=True, scene=self._copy)
        except RuntimeError as error:
            self.finish()
            raise OutputError(self.path, error) from error

    @property
    def over(self) -> bool:
        """Whether nothing is rendered any more."""
        return not is_rendering()

    def finish(self) -> bool:
        """Put the film in its place if it is whole, and return whether it is; leave nothing else behind."""
        try:
            whole = self._part.exists() and length_of(self._part) == self.frames
            if whole:
                self._part.replace(self.path)
        finally:
            with suppress(OSError):
                self._part.unlink(missing_ok=True)
            if not is_rendering():
                _sweep()
        return whole


def target(path: str) -> Path:
    """Where a film goes that is called so.

    Raises
    ------
    MobiusFlowError
        If that is no film's name, or beside a file that was never saved.
    """
    import bpy

    if not path.strip():
        raise MobiusFlowError(Message("The film has no name; give it a file"))
    if path.startswith("//") and not bpy.data.filepath:
        sentence = "Save your file first, since the film is to lie beside it, or choose another place"
        raise MobiusFlowError(Message(sentence))
    found = Path(bpy.path.abspath(path)).absolute()
    if found.is_dir():
        raise MobiusFlowError(Message("{path} is a directory; name a file in it", path=found))
    if found.suffix and found.suffix.lower() != SUFFIX:
        sentence = "{name} does not end in {suffix}, as films do here; give it another name"
        raise MobiusFlowError(Message(sentence, name=found.name, suffix=SUFFIX))
    return found if found.suffix else found.with_suffix(SUFFIX)


def is_rendering() -> bool:
    """Whether Blender renders something in the background of a window."""
    import bpy

    return bool(bpy.app.is_job_running("RENDER"))


def _check(scene: "bpy.types.Scene", path: Path, overwrite: bool) -> None:
    """Raise a MobiusFlowError for what would go wrong after minutes of rendering."""
    render = scene.render
    sides = [side * render.resolution_percentage // 100 for side in (render.resolution_x, render.resolution_y)]
    if is_rendering():
        raise MobiusFlowError(Message("Blender is rendering; wait until it is done, or stop it with Esc"))
    if scene.camera is None:
        raise MobiusFlowError(Message("The scene has no camera; press Set Up Stage first, or add one"))
    if any(side % 2 for side in sides):
        sentence = "Frames are {width} × {height} pixels, but films want even numbers of them"
        raise MobiusFlowError(Message(sentence, width=sides[0], height=sides[1]))
    if path.exists() and not overwrite:
        sentence = "{path} is there already; give the film another name, or let it be overwritten"
        raise MobiusFlowError(Message(sentence, path=path))
    if not path.parent.is_dir():
        raise MobiusFlowError(Message("{path} is no directory; choose another place for the film", path=path.parent))
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise MobiusFlowError(Message("{path} cannot be written; choose another place for the film", path=path))


def _sweep() -> None:
    """Remove copies of scenes: the one just rendered, and any that was saved while it was being rendered."""
    import bpy

    for scene in [each for each in bpy.data.scenes if _MARK in each]:
        bpy.data.scenes.remove(scene)
