"""Writing files so that a reader finds the whole new file or the whole old one, never half of one."""

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def atomic_write(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary path to write to, and move it to ``path`` when the block ends well.

    The temporary file lies in the same directory and has the same suffix, so libraries that look at the
    suffix work too; text or binary is up to the block. If the block raises, ``path`` is left as it was and
    the temporary file is removed. Symbolic links are followed; devices and pipes are written to directly.

    Raises
    ------
    OSError
        If the target is a directory or write-protected, or the disk refuses.

    Examples
    --------
    >>> import tempfile
    >>> target = Path(tempfile.mkdtemp()) / "curve.txt"
    >>> with atomic_write(target) as temporary:
    ...     _ = temporary.write_text("0 0 0")
    >>> target.read_text()
    '0 0 0'
    """
    target = Path(os.path.realpath(path))
    if target.is_dir():
        raise IsADirectoryError(f"{target} is a directory")
    if target.exists() and not os.access(target, os.W_OK):
        # The replacement itself would succeed, since it needs rights on the directory only.
        raise PermissionError(f"{target} is write-protected")
    if target.exists() and not target.is_file():
        yield target
        return
    temporary = target.with_name(f".{secrets.token_hex(8)}{target.suffix}")
    try:
        _create(temporary, target)
        yield temporary
        _flush_to_disk(temporary)
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def _create(temporary: Path, target: Path) -> None:
    """Create the empty temporary file with the rights of the file it replaces, or the user's default ones."""
    os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
    if target.exists():
        temporary.chmod(target.stat().st_mode & 0o777)


def _flush_to_disk(path: Path) -> None:
    """Wait until the contents are on the disk, so that a power cut cannot leave a renamed empty file."""
    with path.open("rb+") as stream:
        os.fsync(stream.fileno())
