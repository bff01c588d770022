"""The directory of an atlas: each of its own files is in its list of checksums, as sha256sum writes them."""

import hashlib
from pathlib import Path

from ...core.base import OutputError, write_file
from ..batch.job import foreign, sha256_of

SUMS = "SHA256SUMS"
_MARK = "# mobius-flow atlas; check with: sha256sum -c SHA256SUMS\n"


class Folder:
    """A directory that is filled anew: unchanged files stay, and foreign ones are neither replaced nor removed.

    Each file is listed before it is in place, so that an interruption leaves no file that is not listed.  Raises
    MobiusFlowError where something foreign is there, or a file has been changed since.
    """

    def __init__(self, path: Path) -> None:
        self.path, self._sums = path, path / SUMS
        self._ours: dict[str, set[str]] = {}  # hashes that files may have
        self._kept: dict[str, str] = {}  # hashes of the files kept or written this time
        text = self._sums.read_text(encoding="utf-8", errors="replace") if self._sums.is_file() else ""
        if not text.startswith(_MARK):
            taken = path.is_symlink() or (path.exists() and not path.is_dir())
            if taken or (path.is_dir() and next(path.iterdir(), None) is not None):
                raise foreign(path, "atlas")
        for line in text.splitlines()[1:]:
            digest, _, name = line.partition("  ")
            if not (Path(name).is_absolute() or ".." in Path(name).parts):  # files elsewhere are not ours
                self._ours.setdefault(name, set()).add(digest)
        for name in self._ours:  # before any work
            self._check(name)

    def read(self, name: str) -> bytes | None:
        """A file of ours, from this time or before."""
        return (self.path / name).read_bytes() if name in self._ours and (self.path / name).is_file() else None

    def keep(self, name: str) -> bool:
        """Whether a file of ours is there; if so, it stays as it is."""
        if name in self._ours and (digest := sha256_of(self.path / name)):
            self._kept[name] = digest
        return name in self._kept

    def put(self, name: str, data: bytes | str) -> None:
        """Write a file, unless it is there already."""
        data = data.encode() if isinstance(data, str) else data
        digest = hashlib.sha256(data).hexdigest()
        there = self._check(name)
        self._kept[name] = digest
        if there == digest:
            return
        try:
            (self.path / name).parent.mkdir(parents=True, exist_ok=True)
            with self._sums.open("a", encoding="utf-8") as sums:
                sums.write("" if sums.tell() else _MARK)
                sums.write(f"{digest}  {name}\n")
            self._ours.setdefault(name, set()).add(digest)
            write_file(self.path / name, data)
        except OSError as error:
            raise OutputError(self.path / name, error) from error

    def close(self) -> None:
        """Remove files of ours that are not wanted any more."""
        for name in self._ours.keys() - self._kept.keys():
            if self._check(name) is not None:
                (self.path / name).unlink()
        lines = (f"{digest}  {name}\n" for name, digest in sorted(self._kept.items()))
        write_file(self.path / SUMS, "".join([_MARK, *lines]).encode())

    def _check(self, name: str) -> str | None:
        """The hash of a file, None if there is none; a MobiusFlowError if it is not ours, or behind a link."""
        path = self.path / name
        if any(each.is_symlink() for each in [path, *path.parents[: len(Path(name).parts) - 1]]):
            raise foreign(path, "atlas")  # wherever links lead, nothing there is ours
        digest = sha256_of(path)
        if path.exists() and digest not in self._ours.get(name, ()):
            raise foreign(path, "atlas")
        return digest
