"""Where results go, checked before hours of work are put into them; what cannot be written there is kept elsewhere."""

import os
import shutil
import stat
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from itertools import combinations, product
from pathlib import Path

from ..core import MobiusFlowError
from ..core.errors import OutputError
from ..core.files import atomic_write, status_of
from .curves import DEVICE, OUTPUT, STREAM

Identity = tuple[int | str, ...]
Write = Callable[[str], None]


def check_places(inputs: Mapping[str, str], outputs: Mapping[str, str | None]) -> None:
    """Raise a MobiusFlowError unless all outputs can be written and are files of their own.

    Keys are what paths are called on the command line; outputs that are None are not wanted.
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
    """Raise a MobiusFlowError unless a file can be there."""
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


def is_file(path: str) -> bool:
    """Whether a path is one of a file, or of nothing yet, rather than of a stream or device, where one may wait."""
    try:
        found = status_of(path)
    except (OSError, ValueError):
        return True
    return path != STREAM and (found is None or stat.S_ISREG(found.st_mode))


def _identity(path: str, stream: int) -> Identity | None:
    """What two names of one file have in common; None for terminals and the like, which may be named twice."""
    try:
        found = os.fstat(stream) if path == STREAM else status_of(path)
        if found is None:
            target = Path(os.path.realpath(path))
            parent = target.parent.stat()
            return parent.st_dev, parent.st_ino, os.path.normcase(target.name)
    except (OSError, ValueError):
        return None  # a missing input, which has its own sentence
    regular = stat.S_ISREG(found.st_mode) or stat.S_ISFIFO(found.st_mode)
    return (found.st_dev, found.st_ino) if regular else None


@contextmanager
def writing(path: str) -> Iterator[Path]:
    """Give a temporary path whose file takes its place in the end, whole; an OutputError says why it cannot."""
    try:
        with atomic_write(path) as temporary:
            yield temporary
    except (OSError, ValueError) as error:
        raise OutputError(path, error) from error


def kept(path: str, write: Write, rescue: Write | None = None, name: str | None = None) -> list[str]:
    """Write a result; where that fails keep it in a temporary directory, and return the sentences that say so.

    It is kept there where it is interrupted, too; the sentence is then that of the KeyboardInterrupt, which goes on.
    ``rescue``, ``name``: another way to write it, and a file name, for that directory: a curve instead of a film.
    """
    keep = partial(_elsewhere, rescue or write, os.path.basename(name or path))
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


def _elsewhere(write: Write, name: str, reason: str) -> str:
    """Write to a temporary directory; return the reason for that, and the place if it could be done."""
    try:
        place = Path(tempfile.mkdtemp(prefix="mobius-flow-"), name)
    except OSError:
        return reason
    try:
        write(str(place))
    except (MobiusFlowError, OSError, MemoryError):
        shutil.rmtree(place.parent, ignore_errors=True)
        return reason
    return f"{reason} (the result is kept as {place})"
