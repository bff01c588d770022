"""Writing files so that a reader finds the whole new file or the whole old one, never half of one."""

import errno
import os
import secrets
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from .errors import MobiusFlowError, OutputError

_NO_PLACE_BESIDE = (errno.EACCES, errno.EPERM, errno.EROFS)
_NOT_REPLACEABLE = (errno.EBUSY, errno.EXDEV, errno.EACCES, errno.EPERM)  # mount points, sticky directories


@contextmanager
def atomic_write(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary path to write to, and move it to ``path`` when the block ends well.

    The temporary file lies in the same directory and has the same suffix, so libraries that look at the suffix work
    too; text or binary is up to the block. If the block raises, ``path`` is left as it was and the temporary file is
    removed. Symbolic links are followed. Where a file cannot be replaced, as in a directory that is read-only or where
    it is mounted by itself, and to devices and pipes, the whole contents are copied. A MobiusFlowError says why it
    cannot be written.

    >>> import tempfile
    >>> target = Path(tempfile.mkdtemp()) / "curve.txt"
    >>> with atomic_write(target) as temporary:
    ...     _ = temporary.write_text("0 0 0")
    >>> target.read_text()
    '0 0 0'
    """
    temporary: Path | None = None
    try:
        found = status_of(path)
        if found is not None and stat.S_ISDIR(found.st_mode):
            raise MobiusFlowError(f"{path}: is a directory; name a file")
        if found is None and not Path(os.path.realpath(path)).parent.is_dir():
            raise MobiusFlowError(f"{path}: cannot be written: the directory {Path(path).parent} does not exist")
        if found is not None and not os.access(path, os.W_OK):
            # the replacement itself would succeed, since it needs rights on the directory only
            raise MobiusFlowError(f"{path}: is write-protected")
        replaced = found is None or (stat.S_ISREG(found.st_mode) and own_stream(found) is None)
        target = Path(os.path.realpath(path)) if replaced else Path(path)
        temporary = _create(target, found, beside=replaced)
        yield temporary
        # on the disk, so that a power cut cannot leave a renamed empty file
        with temporary.open("rb+") as stream:
            os.fsync(stream.fileno())
        if not (temporary.parent == target.parent and _replace(temporary, target, found)):
            _copy(temporary, target, found)
            temporary.unlink()
    except BaseException as error:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
        # a ValueError for a path with a null character
        if isinstance(error, OSError | ValueError) and not isinstance(error, MobiusFlowError):
            raise OutputError(path, error) from error
        raise


def check_place(path: str | os.PathLike[str]) -> None:
    """Raise a MobiusFlowError unless a file can be written there."""
    with suppress(_Enough), atomic_write(path):
        raise _Enough


class _Enough(Exception):  # noqa: N818 - nothing is wrong
    """Nothing is to be written."""


def write_file(path: str | os.PathLike[str], data: bytes) -> None:
    """Write a whole file, or none, as `atomic_write`."""
    with atomic_write(path) as temporary:
        temporary.write_bytes(data)


def status_of(path: str | os.PathLike[str]) -> os.stat_result | None:
    """What is at a path, links followed; None if nothing is. Raises OSError if that cannot be known."""
    try:
        return os.stat(path)
    except FileNotFoundError:
        return None


def own_stream(status: os.stat_result) -> int | None:
    """The descriptor of the process's own output that a file is, which is written to rather than replaced."""
    for descriptor in (1, 2):
        with suppress(OSError):
            if os.path.samestat(os.fstat(descriptor), status) and not stat.S_ISCHR(status.st_mode):
                return descriptor
    return None


def _create(target: Path, found: os.stat_result | None, beside: bool) -> Path:
    """Create the empty temporary file with the rights of the file it replaces, or the user's default ones."""
    suffix = target.suffix if len(target.suffix) <= 20 else ""
    if beside:
        temporary = target.with_name(f".{secrets.token_hex(8)}{suffix}")
        try:
            os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
        except OSError as error:
            if found is None or error.errno not in _NO_PLACE_BESIDE:
                raise
        else:
            if found is not None:
                temporary.chmod(found.st_mode & 0o777)
            return temporary
    descriptor, name = tempfile.mkstemp(suffix)
    os.close(descriptor)
    return Path(name)


def _replace(temporary: Path, target: Path, found: os.stat_result | None) -> bool:
    try:
        temporary.replace(target)
    except OSError as error:
        if found is None or error.errno not in _NOT_REPLACEABLE:
            raise
        return False
    return True


def _copy(source: Path, target: Path, found: os.stat_result | None) -> None:
    """Write a file's contents into one that exists; a regular file gets its old contents back if that fails."""
    stream = None if found is None else own_stream(found)
    if stream is not None or (found is not None and not stat.S_ISREG(found.st_mode)):
        with (
            source.open("rb") as file,
            open(target if stream is None else stream, "wb", closefd=stream is None) as device,
        ):
            shutil.copyfileobj(file, device)
        return
    with target.open("r+b", buffering=0) as file:
        old = file.read()
        try:
            _overwrite(file.fileno(), source.read_bytes())
        except BaseException:
            _overwrite(file.fileno(), old)
            raise


def _overwrite(descriptor: int, data: bytes) -> None:
    os.lseek(descriptor, 0, os.SEEK_SET)
    rest = memoryview(data)
    while rest:
        rest = rest[os.write(descriptor, rest) :]
    os.ftruncate(descriptor, len(data))
    os.fsync(descriptor)
