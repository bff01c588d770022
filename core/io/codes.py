"""Codes of diagrams (.pd, .dt, .gauss, Knoodle's .tsv): read as a drawing of the diagram, written from a view.

Lists of knots can be downloaded: a name and a code in each row (KnotInfo, LinkInfo, SnapPy, KnotFolio).

``#`` begins a comment.  For the forms of the codes see :mod:`mobius_flow.core.knots.diagrams.codes`.
"""

import csv
import os
import re
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import TextIO

from ..base import CurveError, CurveFileError, checked
from ..curve import Curve, check_closed
from ..knots.diagrams import Diagram, diagram_of, views
from ..knots.diagrams.codes import CodeError, check_count, diagram_from_code, gauss_text, is_code, joined, planar_text
from ..knots.planar import drawn
from . import xyz
from .source import Polygon, Source

_NAMES = ("name", "knot", "link", "id", "knot_name", "link_name")
CODES: Mapping[str, str] = {
    "pd_notation": "PD: ", "pd_notation_math": "", "pd_notation_vector": "PD: ", "pd_code": "PD: ", "pd": "PD: ",
    "dt_notation": "DT: ", "dt_code": "DT: ", "dt": "DT: ", "gauss_notation": "Gauss: ", "gauss_code": "Gauss: ",
    "gauss": "Gauss: ", "braid_notation": "braid", "braid_word": "braid", "braid": "braid",
}  # fmt: skip
"""Columns that are read, the first one that a list has, and what must stand before their codes."""
_BRAID = re.compile(r"[\[({]\s*(?:(\d+)\s*,\s*[\[({])?([^\[\](){}]*)[\])}\s]*")
_CODE = re.compile(r"[^\[({]*[\[({].*\d.*|[\d\s,;+-]+|[a-zA-Z]{4,}(\.[01]+)?", re.DOTALL)  # not a column's title
_NAME = re.compile(r"(m?[KL]?\d+(?:\^\d)?(?:_|[an]_?)\d+)(?:\(0,0\))*")  # a knot's, and as SnapPy prints manifolds
_COLUMNS = range(4, 8)  # of Knoodle's: four edges, and perhaps the sign and two colours


def code_diagram(kind: str, source: Source) -> Diagram:
    """The diagram of the code in a file, ``pd``, ``dt`` or ``gauss``; raises CurveFileError."""
    text = "\n".join(line.partition("#")[0] for line in source.lines)
    try:
        return diagram_from_code(text, kind)
    except CodeError as error:
        raise source.error(str(error), text.count("\n", 0, error.position) + 1) from error
    except CurveError as error:
        raise source.error(str(error)) from error


def _read(kind: str, source: Source) -> list[Polygon]:
    """Polygons of the code in a file; raises CurveFileError."""
    return _polygons(drawn(code_diagram(kind, source)))


read_pd, read_dt, read_gauss = (partial(_read, kind) for kind in ("pd", "dt", "gauss"))


def read_tsv(source: Source) -> list[Polygon]:
    """Polygons of coordinates, or of a knot's crossings, as `knoodle_diagrams` reads them; or CurveFileError."""
    found = knoodle_diagrams(source)
    if not found:
        return xyz.read(source)
    if len(found) > 1:
        raise source.error(f"{len(found)} knots; mobius-flow knot FILE DIRECTORY makes a file for each")
    try:
        return _polygons(drawn(found[0]))
    except CurveError as error:
        raise source.error(str(error)) from error


def knoodle_diagrams(source: Source) -> list[Diagram]:
    """The diagrams in a file of Knoodle's; none if there are no crossings.  Raises CurveFileError.

    Lines have a crossing's four edges, its sign if it is given, and colours, which are ignored.  A line with ``k``
    begins a knot, and with ``s`` a summand of it; one without crossings is a circle.
    """
    knots: list[list[list[tuple[int, list[int]]]]] = []  # summands of crossings with their lines
    columns = 0
    for number, line in enumerate(source.lines, start=1):
        words = line.partition("#")[0].split()
        mark = words[0].lower() if words else ""
        if not knots and mark and mark not in ("k", "l", "s", "u") and len(words) not in _COLUMNS:
            return []
        if mark in ("k", "l") or (mark and not knots):
            knots.append([])
        if mark in ("s", "u") or (mark and mark not in ("k", "l") and not knots[-1]):
            knots[-1].append([])
        if not mark or mark in ("k", "l", "s", "u"):
            continue
        if len(words) != (columns := columns or len(words)) or columns not in _COLUMNS:
            raise source.error(f"{len(words)} columns; all crossings have as many, 4 to 7", number)
        knots[-1][-1].append((number, [source.integer(word, number) for word in words]))
    try:
        return [joined([_crossings(source, rows) for rows in summands]) for summands in knots]
    except CurveFileError:
        raise
    except CurveError as error:
        raise source.error(str(error)) from error


def _crossings(source: Source, rows: list[tuple[int, list[int]]]) -> Diagram:
    """The diagram of crossings with their lines; raises CurveError if there is none, or given signs contradict it."""
    check_count(len(rows))
    diagram = diagram_of([edges[:4] for _, edges in rows])
    for (number, edges), sign, (a, b) in zip(rows, diagram.signs, diagram.joins(), strict=True):
        if a == b and len(edges) % 2 and edges[4] != sign:
            raise source.error(f"the sign of this crossing is {edges[4]}, but its edges make it {sign}", number)
    return diagram


def _polygons(curve: Curve) -> list[Polygon]:
    """The polygons of a drawing, whose vertices are on no line of the code."""
    return [Polygon(part.tolist(), lambda _: None) for part in curve.components]


def _written(text_of: Callable[[Diagram], str], curve: Curve, stream: TextIO) -> None:
    """Write the code of a view of the curve; raises CurveError if no view is clear, or a component is open."""
    check_closed(curve, "codes of diagrams")
    found = min(views(curve, 4), key=lambda diagram: diagram.crossings)
    stream.write(text_of(found) + "\n")


write_pd, write_gauss = partial(_written, planar_text), partial(_written, gauss_text)


@checked
def knot_list(path: str | os.PathLike[str]) -> dict[str, str]:
    """The names in a list of knots and their codes, for `mobius_flow.core.knots.knot`: ``{"3_1": "PD: [[1,5,2,...``.

    A list is a table with a first line of names, among which is one of `CODES`, separated by commas, tabs, semicolons
    or bars; or it has a code in each line, after a name and a separator or alone; or it is Knoodle's.  Rows without a
    code are known by their names, such as 3_1, or left out; rows without a name of their own have numbers.  Raises
    CurveFileError if there is no code.
    """
    source = Source.load(Path(path), 256 << 20)  # KnotInfo's own, with all invariants, has dozens of megabytes
    if (begin := source.text.lstrip()[:1]) in "ksul0123456789":
        try:
            diagrams = knoodle_diagrams(source)
        except CurveFileError:
            if begin in "ksul":
                raise
            diagrams = []  # another table
        if diagrams:
            return {f"knot-{number}": gauss_text(diagram) for number, diagram in enumerate(diagrams, start=1)}
    found: dict[str, str] = {}
    try:
        for number, (name, code) in enumerate(_rows(source.lines), start=1):
            if code:
                found[name if name and name not in found else f"{name or 'knot'}-{number}"] = code
    except csv.Error as error:
        raise source.error(f"{error}; perhaps a quotation mark is not closed") from error
    if not found:
        columns = ", ".join(CODES)
        raise source.error(f"no list of knots: there is no code in any line, and no column named {columns}")
    return found


def _rows(lines: list[str]) -> Iterator[tuple[str, str]]:
    """Names and codes as `knot` reads them, either of which may be empty."""
    lines = [line for line in lines if line.strip() and not line.startswith("#")]
    delimiter = max(",\t|;", key=lines[0].count) if lines else ","
    table = csv.reader(lines, delimiter=delimiter, skipinitialspace=True)
    head = [cell.strip().lower().replace(" ", "_") for cell in next(table, [])]
    column = next((head.index(name) for name in CODES if name in head), None)
    if column is None:
        yield from map(_plain, lines)
        return
    title, before = next((head.index(name) for name in _NAMES if name in head), None), CODES[head[column]]
    for row in table:
        if column >= len(row):
            continue
        name, cell = row[title].strip() if title is not None and title < len(row) else "", row[column].strip()
        code = before + cell if _CODE.fullmatch(cell) else ""
        if before == "braid":
            strands, letters = match.groups() if (match := _BRAID.fullmatch(cell)) else (None, "")
            code = f"BR[{strands},{{{letters}}}]" if strands else f"braid({letters})" if match else ""
        yield name, code or _known(name)


def _plain(line: str) -> tuple[str, str]:
    """A line with a code, and perhaps with a name before it: up to a separator, or a bracket."""
    if name := _known(line.strip()):
        return name, name
    if is_code(line):
        return "", line.strip()
    name, _, code = re.sub(r"\s*[,\t|;:=]\s*|\s+(?=[\[({])", "\0", line.strip(), count=1).partition("\0")
    return name.strip("\"' "), code.strip("\"' ") if is_code(code.strip("\"' ")) else ""


def _known(name: str) -> str:
    """The text that `knot` reads for a row with a name alone."""
    match = _NAME.fullmatch(name)
    return match[1] if match else ""
