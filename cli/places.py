"""What is written, by suffix, and where: checked before hours of work are spent on it, or else kept elsewhere.

Curve files are `core`'s; keyframed and rendered scenes need Blender's module.
"""

import os
import shutil
import stat
import sys
import tempfile
from collections.abc import Callable, Collection, Mapping
from itertools import combinations, product
from pathlib import Path

from ..addon.pictures import export
from ..core import Curve, MobiusFlowError
from ..core.base import OptionError, OutputError, files, status_of, wrong_suffix
from ..core.io import FORMATS, written_formats
from ..core.keys.motion import check_dimension
from . import curves
from .curves import DEVICE, OUTPUT, STREAM
from .terminal import OutputStreamError

FILMS = (".blend", ".mp4")  # which are played as a motion
SCENES = (*FILMS, ".png")  # which show the whole run, and need Blender's module
OUTPUTS = (*written_formats(), *SCENES)
VIEWED = (".html", ".stl", ".3mf", ".glb")  # what mobius-flow view makes
Write = Callable[[str], None]


def check_places(inputs: Mapping[str, str], outputs: Mapping[str, str | None]) -> None:
    """Raise a MobiusFlowError unless all outputs can be written and are files of their own.

    Keys are the paths' names on the command line; outputs that are None are not wanted.
    """
    wanted = {name: path for name, path in outputs.items() if path is not None}
    for path in wanted.values():
        check_place(path)
    read = [(k, path, _identity(path, 0)) for k, path in inputs.items()]
    written = [(k, path, _identity(path, 1)) for k, path in wanted.items()]
    for (first, _, one), (second, path, other) in [*product(read, written), *combinations(written, 2)]:
        if one is not None and one == other:
            raise MobiusFlowError(f"{path}: {first} and {second} are the same file; give each one of its own")


def _identity(path: str, stream: int) -> tuple[int | str, ...] | None:
    """An identity that two names of one file share; None for terminals and the like, which may be named twice."""
    try:
        found = os.fstat(stream) if path == STREAM else status_of(path)
        if found is None:
            target = Path(os.path.realpath(path))
            parent = target.parent.stat()
            return parent.st_dev, parent.st_ino, os.path.normcase(target.name)
    except (OSError, ValueError):
        return None  # a missing input, which is reported elsewhere
    regular = stat.S_ISREG(found.st_mode) or stat.S_ISFIFO(found.st_mode)
    return (found.st_dev, found.st_ino) if regular else None


def check_place(path: str) -> None:
    """Raise a MobiusFlowError unless a file can be created there."""
    if path in (STREAM, DEVICE) and (sys.stdout is None or not sys.stdout.writable()):
        raise MobiusFlowError(f"{OUTPUT} is closed; name a file")
    if path != STREAM:
        files.check_place(path)


def check_directory(path: str) -> None:
    """Raise an OutputError unless files can be made in a directory, or where it would be made."""
    place = Path(path).absolute()
    try:
        while not place.exists():
            place = place.parent
        tempfile.NamedTemporaryFile(prefix=".", dir=place).close()
    except (OSError, ValueError) as error:
        raise OutputError(path, error) from error


def is_file(path: str) -> bool:
    """Whether a path is a file's, or free for one, rather than a stream's or device's, where one may wait."""
    try:
        found = status_of(path)
    except (OSError, ValueError):
        return True
    return path != STREAM and (found is None or stat.S_ISREG(found.st_mode))


def kept(path: str, write: Write, rescue: Write | None = None, name: str | None = None) -> list[str]:
    """Write a result; if that fails, keep it in a temporary directory, and return the sentences that say so.

    If interrupted, it is kept there too; the sentence is then the message of the KeyboardInterrupt, which is re-raised.
    ``rescue``, ``name``: another way to write it, and a file name, for that directory: a curve instead of a film.
    """
    interrupt = None
    try:
        write(path)
        return []
    except KeyboardInterrupt as error:
        reason, interrupt = f"{path} is not written", error
    except (MobiusFlowError, OutputStreamError) as error:
        reason = str(error)
    except OSError as error:
        reason = f"{path}: cannot be written: {error.strerror or error}"
    except MemoryError:
        reason = f"{path}: there is not enough memory to write it"
    try:
        room = tempfile.mkdtemp(prefix="mobius-flow-")
        place = Path(room, os.path.basename(name or path))  # the room itself where the path ends in no name
        try:
            (rescue or write)(str(place))
            reason += f" (the result is kept as {place})"
        except (MobiusFlowError, OSError, MemoryError):
            shutil.rmtree(room, ignore_errors=True)
    except OSError:  # there is no temporary directory either
        pass
    if interrupt is not None:
        raise KeyboardInterrupt(reason) from interrupt
    return [reason]


def suffix_of(path: str, known: Collection[str], kind: str) -> str:
    """The suffix of an output, in lower case; raises a MobiusFlowError if it is none of those known."""
    suffix = Path(path).suffix.lower()
    if suffix not in known:
        raise MobiusFlowError(f"{path}: {wrong_suffix(path, known, kind)}")
    return suffix


def is_scene(path: str) -> bool:
    """Whether a scene, film or picture is asked for, by a path's suffix."""
    return Path(path).suffix.lower() in SCENES


def check_output(path: str, form: str | None, look: str | None, played: bool) -> None:
    """Raise a MobiusFlowError if the suffix is unknown and no format named, or Blender's module is needed and missing.

    An OptionError if the output has no look, or is not to be ``played``, there and back or with a tube as asked for.
    """
    suffix = Path(path).suffix.lower()
    if look is not None and suffix not in SCENES:
        raise OptionError(f"--look is for {', '.join(SCENES)}")
    if played and suffix not in FILMS:
        raise OptionError(f"--loop and --constant-radius are for {', '.join(FILMS)}")
    if suffix in SCENES:
        export.require_blender()
    elif form is None and path != STREAM and suffix not in FORMATS:
        more = "; --trajectory writes motions" if suffix == ".npz" else curves.or_format(path)
        more = f"; mobius-flow view makes {suffix} of one of those" if suffix in VIEWED else more
        raise MobiusFlowError(f"{path}: {wrong_suffix(path, OUTPUTS, 'outputs')}{more}")
    else:
        curves.format_for(path, form)


def check_holds(path: str, form: str | None, curve: Curve) -> None:
    """Raise a MobiusFlowError that names the output if it cannot hold the curve."""
    try:
        if is_scene(path):
            check_dimension(curve)
        else:
            curves.format_for(path, form).text(curve)
    except MobiusFlowError as error:
        raise MobiusFlowError(f"{path}: {error}") from error
