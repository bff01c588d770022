"""What is written, by suffix, and where: checked before hours of work are spent on it, or else kept elsewhere.

Curve files are `core`'s; keyframed and rendered scenes need Blender's module.
"""

import os
import shutil
import stat
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import combinations, product
from pathlib import Path

from ..addon.pictures import export
from ..core import Curve, Iterate, MobiusFlowError, Result
from ..core.base.errors import OptionError, OutputError, wrong_suffix
from ..core.base.files import atomic_write, status_of
from ..core.curve import check_closed
from ..core.io import FORMATS, Format, written_formats
from ..core.keys.motion import Playing, check_dimension
from . import curves
from .curves import DEVICE, OUTPUT, STREAM
from .progress import live

VIEWED = (".html", ".stl", ".3mf", ".glb")  # what mobius-flow view makes
Identity = tuple[int | str, ...]
Write = Callable[[str], None]
Writer = Callable[[str, Result, Sequence[Iterate], bool, Playing], object]


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


def check_place(path: str) -> None:
    """Raise a MobiusFlowError unless a file can be created there."""
    if path in (STREAM, DEVICE) and (sys.stdout is None or not sys.stdout.writable()):
        raise MobiusFlowError(f"{OUTPUT} is closed; name a file")
    if path == STREAM:
        return
    try:
        found, directory = status_of(path), Path(os.path.realpath(path)).parent
        if found is not None and stat.S_ISDIR(found.st_mode):
            raise MobiusFlowError(f"{path}: is a directory; name a file")
        if found is None and not directory.is_dir():
            raise MobiusFlowError(f"{path}: cannot be written: the directory {Path(path).parent} does not exist")
        if not os.access(directory if found is None else path, os.W_OK):
            raise MobiusFlowError(f"{path}: is write-protected")
        if found is None:
            tempfile.NamedTemporaryFile(prefix=".", dir=directory).close()  # the only way to know
        elif stat.S_ISREG(found.st_mode):
            open(path, "r+b").close()
    except MobiusFlowError:
        raise
    except (OSError, ValueError) as error:  # a ValueError for a null character
        raise OutputError(path, error) from error


def check_directory(path: str) -> None:
    """Raise an OutputError unless files can be made in a directory, or where it would be made."""
    place = Path(path).absolute()
    try:
        while not place.exists():
            place = place.parent
        tempfile.NamedTemporaryFile(prefix=".", dir=place).close()
    except (OSError, ValueError) as error:
        raise OutputError(path, error) from error


def foreign(path: Path, command: str) -> MobiusFlowError:
    """The error about something in the way of a command's files: a command replaces nothing but its own."""
    why = f"was not written by mobius-flow {command}, or has been changed since"
    return MobiusFlowError(f"{path}: {why}; move it, or name another directory")


def is_file(path: str) -> bool:
    """Whether a path is a file's, or free for one, rather than a stream's or device's, where one may wait."""
    try:
        found = status_of(path)
    except (OSError, ValueError):
        return True
    return path != STREAM and (found is None or stat.S_ISREG(found.st_mode))


def _identity(path: str, stream: int) -> Identity | None:
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


@contextmanager
def writing(path: str) -> Iterator[Path]:
    """Give a temporary path whose file replaces the real one in the end, whole; an OutputError says why it cannot."""
    try:
        with atomic_write(path) as temporary:
            yield temporary
    except (OSError, ValueError) as error:
        raise OutputError(path, error) from error


def kept(path: str, write: Write, rescue: Write | None = None, name: str | None = None) -> list[str]:
    """Write a result; if that fails, keep it in a temporary directory, and return the sentences that say so.

    If interrupted, it is kept there too; the sentence is then the message of the KeyboardInterrupt, which is re-raised.
    ``rescue``, ``name``: another way to write it, and a file name, for that directory: a curve instead of a film.
    """

    def keep(reason: str) -> str:
        """Write to a temporary directory; return the reason for that, and the place if it worked."""
        try:
            place = Path(tempfile.mkdtemp(prefix="mobius-flow-"), os.path.basename(name or path))
        except OSError:
            return reason
        try:
            (rescue or write)(str(place))
        except (MobiusFlowError, OSError, MemoryError):
            shutil.rmtree(place.parent, ignore_errors=True)
            return reason
        return f"{reason} (the result is kept as {place})"

    try:
        write(path)
    except KeyboardInterrupt as interrupt:
        raise KeyboardInterrupt(keep(f"{path} is not written")) from interrupt
    except MobiusFlowError as error:
        return [keep(str(error))]
    except OSError as error:
        return [keep(f"{path}: cannot be written: {error.strerror or error}")]
    except MemoryError:
        return [keep(f"{path}: there is not enough memory to write it")]
    return []


@dataclass(frozen=True)
class OutputKind:
    """One kind of output."""

    write: Writer  # the last arguments are whether progress may be shown, and how a scene looks and is played
    admit: Callable[[Curve], object]  # raises a MobiusFlowError if it cannot hold a curve
    is_scene: bool = False  # shows the whole run, and needs Blender's module
    is_played: bool = False  # as a motion


def _curve_output(form: Format, name: str | None = None) -> OutputKind:
    return OutputKind(lambda path, result, *_: curves.write(path, result.curve, name), form.text)


def _scene_output(write: Callable[[str, Sequence[Iterate], bool, Playing], object], is_played: bool) -> OutputKind:
    def admit(curve: Curve) -> None:
        check_dimension(curve)
        check_closed(curve, "scenes, films and pictures")

    return OutputKind(lambda path, _, iterates, *how: write(path, iterates, *how), admit, True, is_played)


def _write_movie(path: str, iterates: Sequence[Iterate], shown: bool, playing: Playing) -> None:
    with live(shown) as show:
        export.write_movie(path, iterates, lambda done, total: show(f"frame {done} of {total} is drawn"), playing)


OUTPUTS: Mapping[str, OutputKind] = {suffix: _curve_output(FORMATS[suffix]) for suffix in written_formats()} | {
    ".blend": _scene_output(lambda path, iterates, _, playing: export.write_blend(path, iterates, playing), True),
    ".mp4": _scene_output(_write_movie, True),
    ".png": _scene_output(lambda path, iterates, _, playing: export.write_still(path, iterates, playing.look), False),
}


def output_for(path: str, name: str | None = None, look: str | None = None, played: bool = False) -> OutputKind:
    """The kind of output that a path's suffix or ``--format`` asks for.

    Raises MobiusFlowError if the suffix is unknown and no format named, or Blender's module is needed and missing;
    OptionError if it has no look, or is not to be ``played``, there and back or with a tube as it is asked for.
    """
    suffix = Path(path).suffix.lower()
    if look is not None and not (suffix in OUTPUTS and OUTPUTS[suffix].is_scene):
        raise OptionError(f"--look is for {', '.join(name for name, each in OUTPUTS.items() if each.is_scene)}")
    if played and not (suffix in OUTPUTS and OUTPUTS[suffix].is_played):
        films = ", ".join(name for name, each in OUTPUTS.items() if each.is_played)
        raise OptionError(f"--loop and --constant-radius are for {films}")
    if suffix not in OUTPUTS:
        if name is None and path != curves.STREAM and suffix not in FORMATS:
            more = "; --trajectory writes motions" if suffix == ".npz" else curves.or_format(path)
            more = f"; mobius-flow view makes {suffix} of one of those" if suffix in VIEWED else more
            raise MobiusFlowError(f"{path}: {wrong_suffix(path, OUTPUTS, 'outputs')}{more}")
        return _curve_output(curves.format_for(path, name), name)
    if OUTPUTS[suffix].is_scene:
        export.require_blender()
    return OUTPUTS[suffix]


def admit(output: OutputKind, path: str, curve: Curve) -> None:
    """Raise a MobiusFlowError that names the output if it cannot hold the curve."""
    try:
        output.admit(curve)
    except MobiusFlowError as error:
        raise MobiusFlowError(f"{path}: {error}") from error
