"""The text of a curve file, the polygons found in it, and errors that point to the line."""

import hashlib
import logging
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import BinaryIO, ClassVar

from ..base import CurveError, CurveFileError, reason_of, shown
from ..curve import Curve

_INTEGER = re.compile(r"[+-]?[0-9]{1,18}")  # with more digits it is no count or index of anything in memory
_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Source:
    """The text of one file, with line ends as ``\\n``, and the hexadecimal hash of its bytes."""

    path: Path
    text: str = field(repr=False)
    sha256: str
    max_bytes: ClassVar[int] = 16 << 20  # two hundred thousand vertices with all their digits
    max_lines: ClassVar[int] = 500_000

    @classmethod
    def load(cls, path: Path, most: int = max_bytes) -> "Source":
        """Read a text file; raises CurveFileError if it is missing, empty, too long or not UTF-8 text."""
        try:
            stream = path.open("rb")
        except (OSError, ValueError) as error:  # a ValueError for a path with a null character
            raise CurveFileError(path, f"cannot be read: {reason_of(error)}") from error
        with stream:
            return cls.read(path, stream, most)

    @classmethod
    def read(cls, path: Path, stream: BinaryIO, most: int = max_bytes) -> "Source":
        """Read a stream, which need not end; otherwise as `load`."""
        try:
            data = stream.read(most + 1)
        except OSError as error:
            raise CurveFileError(path, f"cannot be read: {reason_of(error)}") from error
        if len(data) > most:
            raise CurveFileError(path, f"longer than {most >> 20} MB, more than this program reads")
        if data.startswith(b"version https://git-lfs"):
            raise CurveFileError(path, "a pointer of Git LFS, not the file itself: get it with git lfs pull")
        nul = data.find(b"\0")
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            nul = error.start if nul < 0 else nul
        if nul >= 0:
            reason = f"not a text file in UTF-8 (byte 0x{data[nul]:02x} at position {nul})"
            raise CurveFileError(path, reason, data.count(b"\n", 0, nul) + 1)
        text = text.replace("\r\n", "\n").replace("\r", "\n")
        if text.count("\n") > cls.max_lines:
            raise CurveFileError(path, f"more than {cls.max_lines} lines, more than this program reads")
        if not text.strip():
            raise CurveFileError(path, "the file is empty")
        return cls(path, text, hashlib.sha256(data).hexdigest())

    @cached_property
    def lines(self) -> list[str]:
        """The lines without their ends; line number i is ``lines[i - 1]``."""
        return self.text.split("\n")

    def error(self, reason: str, line: int | None = None) -> CurveFileError:
        return CurveFileError(self.path, reason, line)

    def number(self, token: str, line: int) -> float:
        """Parse a coordinate; nan and inf are left for :func:`assemble`, which knows the vertex."""
        try:
            if "_" in token:  # Python's own notation, which no other program reads
                raise ValueError
            return float(token)
        except ValueError:
            raise self.error(f"{shown(token)} is not a number", line) from None

    def integer(self, token: str, line: int) -> int:
        if not _INTEGER.fullmatch(token):
            raise self.error(f"{shown(token)} is not a whole number", line)
        return int(token)


@dataclass(frozen=True)
class Polygon:
    """One component as found in a file."""

    points: Sequence[Sequence[float]]
    line_of: Callable[[int], int | None]  # where the vertex of an index, from 0, was read
    closed: bool = True  # also true if the last vertex repeats the first
    numbers: Sequence[int] | None = None  # the file's own vertex numbers, from 0, if not in order along the curve

    @property
    def repeats_first(self) -> bool:
        return len(self.points) > 1 and list(self.points[0]) == list(self.points[-1])


def assemble(source: Source, polygons: Sequence[Polygon]) -> Curve:
    """Join the polygons of a file into one curve.

    Raises CurveFileError if there is none, one has too few vertices, a coordinate is not finite, or dimensions differ
    or are too many; the message names the component, the vertex and the line.
    """
    if not polygons:
        raise source.error("no vertex found; give at least one polygon")
    dimension = len(polygons[0].points[0]) if polygons[0].points else 0
    if dimension > 16:  # embeddedness is checked in each of its planes
        raise source.error(f"vertices have {dimension} coordinates; there may be at most 16", polygons[0].line_of(0))
    components = []
    for number, polygon in enumerate(polygons, start=1):
        for i, point in enumerate(polygon.points):
            place = f"component {number}, vertex {i + 1}"
            if len(point) != dimension:
                reason = f"{place} has {len(point)} coordinates, the first vertex {dimension}"
                raise source.error(reason, polygon.line_of(i))
            if not all(map(math.isfinite, point)):
                raise source.error(f"{place} is not finite: {list(point)}", polygon.line_of(i))
        points, closed = polygon.points, polygon.closed or polygon.repeats_first
        if polygon.repeats_first:
            note = "%s: the last vertex of component %d repeats its first; dropped, since polygons close by themselves"
            _log.warning(note, source.path, number)
            points = points[:-1]
        if len(points) < (least := 3 if closed else 2):
            count = "1 vertex" if len(points) == 1 else f"{len(points)} vertices"
            kind = "a closed" if closed else "an open"
            reason = f"component {number} has {count}; {kind} polygon needs at least {least} different vertices"
            raise source.error(reason, polygon.line_of(0) if points else None)
        components.append(points)
    try:
        return Curve.from_components(components, [each.closed or each.repeats_first for each in polygons])
    except CurveError as error:
        raise source.error(str(error)) from error
