"""Films of what an artist's scene plays, as it is rendered, plainly, or in a look."""

import os
import subprocess
from pathlib import Path

import bpy

from ...core import MobiusFlowError
from ...core.errors import OutputError, choice
from ...core.messages import Message
from . import rendering, stage, staging
from .looks import LOOKS
from .movie import Reel, copied, sweep
from .rendering import is_rendering

SUFFIX = ".mp4"
# how films are rendered: their labels and descriptions
CHOICES = {
    "SCENE": ("As the Scene", "With the render engine, the settings and the stage that the scene has"),
    "QUICK": ("Quick", "Plain shading by Workbench: many frames in little time"),
    **{name: (look.label, look.description) for name, look in LOOKS.items()},
}


def _set_up(scene: bpy.types.Scene, look: str) -> None:
    if look in LOOKS:
        rendering.look_fine(scene, LOOKS[look])
    elif look == "QUICK":
        rendering.look_plain(scene)
        if direction := staging.key_direction(scene):
            stage.light_workbench(scene, direction)


class Filming(Reel):
    """One film of the frames that a scene plays, in the size of its renders, through its camera.

    The scene stays as it is. In the path, Blender's ``//`` is the directory of the open file, and ``.mp4`` is added to
    a name without suffix. Raises MobiusFlowError if the film cannot be made.
    """

    def __init__(self, scene: bpy.types.Scene, path: str, look: str = "SCENE", overwrite: bool = False) -> None:
        if look not in CHOICES:
            raise MobiusFlowError(f"{look!r} is not a look for films; {choice(look, CHOICES)}")
        place = target(path)
        _check(scene, place, overwrite)
        sweep()
        copy = copied(scene)
        _set_up(copy, look)
        super().__init__(copy, place)

    def render(self) -> None:
        """Render the film in this call; raises MobiusFlowError if it does not come to its end."""
        try:
            super().render()
        except RuntimeError as error:
            raise OutputError(self.path, error) from error
        except OSError as error:
            sentence = "{path}: Blender did not finish rendering the film; is the disk full?"
            raise MobiusFlowError(Message(sentence, path=self.path)) from error

    def start(self) -> None:
        """Begin to render in Blender's own window; raises MobiusFlowError."""
        try:
            super().start()
        except RuntimeError as error:
            raise OutputError(self.path, error) from error


def play(path: Path) -> None:
    """Play a film in Blender's own player, or in the system's where Blender is no program; raises OutputError."""
    try:
        if bpy.app.binary_path:
            subprocess.Popen([bpy.app.binary_path, "-a", str(path)], stdout=subprocess.DEVNULL)
        else:
            bpy.ops.wm.path_open(filepath=str(path))
    except (OSError, RuntimeError) as error:
        raise OutputError(path, error) from error


def target(path: str) -> Path:
    """Where a film of that name goes; raises MobiusFlowError if it is no film's, or beside a file never saved."""
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


def _check(scene: bpy.types.Scene, path: Path, overwrite: bool) -> None:
    """Raise a MobiusFlowError for what would go wrong after minutes of rendering."""
    render = scene.render
    sides = [side * render.resolution_percentage // 100 for side in (render.resolution_x, render.resolution_y)]
    if is_rendering():
        raise MobiusFlowError(Message("Blender is rendering; wait until it is done, or stop it with Esc"))
    if scene.camera is None:
        raise MobiusFlowError(Message("The scene has no camera; press Set Up Stage first, or add one"))
    if any(side % 2 for side in sides):
        sentence = "Frames are {width} × {height} pixels, but films need even numbers; change Size of Pictures"
        raise MobiusFlowError(Message(sentence, width=sides[0], height=sides[1]))
    if path.exists() and not overwrite:
        sentence = "{path} is there already; give the film another name, or let it be overwritten"
        raise MobiusFlowError(Message(sentence, path=path))
    if not path.parent.is_dir():
        raise MobiusFlowError(Message("{path} is not a directory; choose another place for the film", path=path.parent))
    if not os.access(path if path.exists() else path.parent, os.W_OK):
        raise MobiusFlowError(Message("{path} cannot be written; choose another place for the film", path=path))
