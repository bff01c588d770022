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
        if not os.fspath(path):  # which would be the working directory's
            raise MobiusFlowError("the name of a file to be written is empty; name a file")
        if found is not None and stat.S_ISDIR(found.st_mode):
            raise MobiusFlowError(f"{path}: is a directory; name a file")
        if found is None and not Path(os.path.realpath(path)).parent.is_dir():
            raise MobiusFlowError(f"{path}: cannot be written: the directory {Path(path).parent} does not exist")
        if found is not None and not os.access(path, os.W_OK):
            # the replacement itself would succeed, since it needs rights on the directory only
            raise MobiusFlowError(f"{path}: is write-protected")
        stream = None if found is None else own_stream(found)
        is_file = found is None or (stat.S_ISREG(found.st_mode) and stream is None)
        target = Path(os.path.realpath(path)) if is_file else Path(path)
        temporary = _create(target, found, beside=is_file)
        yield temporary
        # on the disk, so that a power cut cannot leave a renamed empty file
        with temporary.open("rb+") as written:
            os.fsync(written.fileno())
        if is_file and temporary.parent == target.parent:
            try:
                temporary.replace(target)
                return
            except OSError as error:
                if found is None or error.errno not in _NOT_REPLACEABLE:
                    raise
        if is_file:
            with target.open("r+b", buffering=0) as file:
                old = file.read()
                try:
                    _overwrite(file.fileno(), temporary.read_bytes())
                except BaseException:
                    _overwrite(file.fileno(), old)
                    raise
        else:
            with temporary.open("rb") as file, open(stream or target, "wb", closefd=stream is None) as device:
                shutil.copyfileobj(file, device)
    except (OSError, ValueError) as error:  # a ValueError for a path with a null character
        if isinstance(error, MobiusFlowError):
            raise
        raise OutputError(os.fspath(path), error) from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


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


def _overwrite(descriptor: int, data: bytes) -> None:
    os.lseek(descriptor, 0, os.SEEK_SET)
    rest = memoryview(data)
    while rest:
        rest = rest[os.write(descriptor, rest) :]
    os.ftruncate(descriptor, len(data))
    os.fsync(descriptor)
