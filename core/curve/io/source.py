"""The text of a curve file, and errors that point into it."""

import hashlib
import re
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import BinaryIO

from ...errors import CurveFileError, reason_of

MAX_BYTES = 16 << 20  # two hundred thousand vertices with all their digits
MAX_LINES = 500_000
_INTEGER = re.compile(r"[+-]?[0-9]+", re.ASCII)
_MAX_DIGITS = 18  # digits; beyond that it is no count or index of anything in memory


@dataclass(frozen=True)
class Source:
    """The text of one file.

    Parameters
    ----------
    path
        Where it comes from, for messages.
    text
        Its contents, with line ends as ``\\n``.
    sha256
        Of its bytes, in hexadecimal digits.
    """

    path: Path
    text: str = field(repr=False)
    sha256: str

    @classmethod
    def load(cls, path: Path) -> "Source":
        """Read a text file; raises CurveFileError if it is missing, empty, too long or not UTF-8 text."""
        try:
            stream = path.open("rb")
        except (OSError, ValueError) as error:  # a ValueError for a path with a null character
            raise CurveFileError(path, f"cannot be read: {reason_of(error)}") from error
        with stream:
            return cls.read(path, stream)

    @classmethod
    def read(cls, path: Path, stream: BinaryIO) -> "Source":
        """Read a stream, which need not end; otherwise as `load`."""
        try:
            data = stream.read(MAX_BYTES + 1)
        except OSError as error:
            raise CurveFileError(path, f"cannot be read: {reason_of(error)}") from error
        if len(data) > MAX_BYTES:
            raise CurveFileError(path, f"longer than {MAX_BYTES >> 20} MB, more than this program reads")
        text = _decode(path, data).replace("\r\n", "\n").replace("\r", "\n")
        if text.count("\n") > MAX_LINES:
            raise CurveFileError(path, f"more than {MAX_LINES} lines, more than this program reads")
        source = cls(path, text, hashlib.sha256(data).hexdigest())
        if not source.text.strip():
            raise source.error("the file is empty")
        return source

    @cached_property
    def lines(self) -> list[str]:
        """The lines without their ends; line number i is ``lines[i - 1]``."""
        return self.text.split("\n")

    def error(self, reason: str, line: int | None = None) -> CurveFileError:
        """Make the error that names this file, the line and the reason."""
        return CurveFileError(self.path, reason, line)

    def number(self, token: str, line: int) -> float:
        """Parse a coordinate; nan and inf are left for :func:`assemble`, which knows the vertex."""
        try:
            if "_" in token:  # Python's own spelling, which no other program reads
                raise ValueError
            return float(token)
        except ValueError:
            raise self.error(f"{shown(token)} is not a number", line) from None

    def integer(self, token: str, line: int) -> int:
        """Parse a count or an index."""
        if not _INTEGER.fullmatch(token) or len(token) > _MAX_DIGITS:
            raise self.error(f"{shown(token)} is not a whole number", line)
        return int(token)


def shown(token: str) -> str:
    """Quote a piece of the file in a message: escaped and cut to a readable length."""
    return ascii(token if len(token) <= 30 else token[:27] + "...")


def _decode(path: Path, data: bytes) -> str:
    nul = data.find(b"\0")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        nul = error.start if nul < 0 else nul
    if nul >= 0:
        reason = f"not a text file in UTF-8 (byte 0x{data[nul]:02x} at position {nul})"
        raise CurveFileError(path, reason, data.count(b"\n", 0, nul) + 1)
    return text
