"""The table of curve formats, and the two functions that use it."""

import io
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import BinaryIO, TextIO

from ..base import CurveError, CurveFileError, MobiusFlowError, Table, atomic_write, checked, wrong_suffix
from ..curve import Curve
from . import codes, json_lists, obj, pdb, vect, xyz
from .source import Polygon, Source, assemble


@dataclass(frozen=True)
class Format:
    """How one kind of file is read and written."""

    description: str  # for help texts
    read: Callable[[Source], list[Polygon]]  # raises CurveFileError
    write: Callable[[Curve, TextIO], None] | None  # raises CurveError for what it cannot hold; None if only read
    dimensions: Sequence[int] = ()  # that curves may have to be written; any if empty

    def text(self, curve: Curve) -> str:
        """The contents of a file of the curve; raises CurveError if the format cannot hold it, or is only read."""
        if self.write is None:
            raise CurveError("this format is only read; choose another one to write")
        if self.dimensions and curve.dimension not in self.dimensions:
            held = " or ".join(map(str, self.dimensions))
            raise CurveError(f"this format holds curves of dimension {held}, not {curve.dimension}; use .json")
        stream = io.StringIO()
        self.write(curve, stream)
        return stream.getvalue()


_COLUMNS = Format(
    "x y z per line, as KnotPlot writes it too, a blank line between components, # comments, # open before an open one",
    xyz.read,
    xyz.separated(" "),
    (2, 3),
)

_FORMATS: Mapping[str, Format] = {
    ".txt": _COLUMNS,
    ".xyz": _COLUMNS,
    ".obj": Format("Wavefront OBJ, vertices (v) and polylines (l)", obj.read, obj.write, (2, 3)),
    ".vect": Format("Geomview VECT, polylines", vect.read, vect.write, (2, 3)),
    ".json": Format(
        '{"components": [[[x, y, z], ...], ...], "closed": [true, ...]}, "closed" only if some are open',
        json_lists.read,
        json_lists.write,
    ),
    ".csv": Format(
        "x, y, z between commas, with or without a first line of names", xyz.read, xyz.separated(",", True), (2, 3)
    ),
    ".tsv": Format("x y z between tabs, or Knoodle's crossings", codes.read_tsv, xyz.separated("\t"), (2, 3)),
    ".raw": _COLUMNS,
    ".kp": _COLUMNS,
    ".kndlxyz": _COLUMNS,
    ".pdb": Format("Protein Data Bank, the alpha carbons of each chain as an open arc (read only)", pdb.read, None),
    ".cif": Format("PDBx/mmCIF, likewise (read only)", pdb.read_cif, None),
    ".pd": Format("planar diagram code of a knot or link, PD[X[1,5,2,4], ...]", codes.read_pd, codes.write_pd, (3,)),
    ".dt": Format("Dowker-Thistlethwaite code, DT: [4 6 2] or DT: cacbca (read only)", codes.read_dt, None),
    ".gauss": Format("Gauss code, 1 -2 3 ... or with signs O1+U2+O3+...", codes.read_gauss, codes.write_gauss, (3,)),
}
FORMATS: Mapping[str, Format] = Table("mobius_flow.formats", lambda it: isinstance(it, Format), _FORMATS)
"""Every format, by suffix; packages join by entry points in ``mobius_flow.formats``, named ``.suffix``."""


def written_formats() -> list[str]:
    """The suffixes of the formats that are not only read."""
    return [suffix for suffix, form in FORMATS.items() if form.write is not None]


@dataclass(frozen=True, eq=False)
class CurveFile:
    """A curve as read, in the user's units, and the text around it, with its path and its hash."""

    curve: Curve
    source: Source
    _polygons: Sequence[Polygon] = field(repr=False)

    def line_of(self, vertex: int) -> int | None:
        """The line in which a vertex of the curve (index from 0) was read."""
        part = int(self.curve.mesh.component[vertex])
        return self._polygons[part].line_of(vertex - int(self.curve.mesh.offsets[part]))

    def index_of(self, number: int) -> int:
        """The index on the curve of what the file counts as this vertex, from 0; raises CurveFileError."""
        if number not in self._indices:
            raise self.source.error(f"there is no vertex {number + 1} on the curve")
        return self._indices[number]

    @cached_property
    def _indices(self) -> dict[int, int]:
        sizes, starts = self.curve.mesh.component_sizes, self.curve.mesh.offsets[:-1].tolist()
        indices: dict[int, int] = {}  # a last vertex that repeats the first counts as the first
        for polygon, start, size in zip(self._polygons, starts, sizes, strict=True):
            numbers = range(start, start + size) if polygon.numbers is None else polygon.numbers
            indices |= {number: start + k % size for k, number in enumerate(numbers)}
        return indices

    def refusal(self, error: CurveError) -> CurveFileError:
        """The same error with the file's name and, where it is about vertices, the line of the first."""
        vertices = error.place.vertices if error.place is not None else ()
        return self.source.error(str(error), self.line_of(vertices[0]) if vertices else None)


def load_curve(path: str | os.PathLike[str], form: Format | None = None, stream: BinaryIO | None = None) -> CurveFile:
    """`read_curve`, keeping what later errors need; by a given format or the suffix's, from a stream if given."""
    path = Path(path)
    form = format_of(path) if form is None else form
    source = Source.load(path) if stream is None else Source.read(path, stream)
    polygons = form.read(source)
    return CurveFile(assemble(source, polygons), source, polygons)


@checked
def read_curve(path: str | os.PathLike[str]) -> Curve:
    """Read polygons, closed or open, from a file; the suffix determines the format (see :data:`FORMATS`).

    The order of components and vertices is kept. A vertex at a component's end that repeats its first vertex is
    dropped, with a note in the log.  Raises CurveFileError if the file cannot be read or is not what its suffix says;
    the message names file, line and reason.
    """
    return load_curve(path).curve


@checked
def write_curve(path: str | os.PathLike[str], curve: Curve, form: Format | None = None) -> None:
    """Write polygons to a file; the suffix determines the format (see :data:`FORMATS`) unless one is given.

    Coordinates are written with all their digits: reading the file gives the same doubles. The file appears whole or
    not at all.  Raises CurveFileError if the suffix is unknown, the format cannot hold the curve, or the file cannot be
    written.
    """
    path = Path(path)
    form = format_of(path) if form is None else form
    try:
        with atomic_write(path) as temporary, temporary.open("w", encoding="utf-8", newline="\n") as stream:
            stream.write(form.text(curve))
    except MobiusFlowError as error:
        raise CurveFileError(path, str(error).removeprefix(f"{path}: ")) from error


def format_of(path: Path) -> Format:
    """The format of a suffix; a CurveFileError lists the known ones."""
    try:
        return FORMATS[path.suffix.lower()]
    except KeyError:
        raise CurveFileError(path, wrong_suffix(path, FORMATS, "curve files")) from None
