"""Lists of knots that can be downloaded: a name and a code in each row (KnotInfo, LinkInfo, SnapPy, KnotFolio)."""

import csv
import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from ...arguments import checked
from ...diagrams import Diagram
from ...diagrams.codes import gauss_text, is_code
from ...errors import CurveFileError
from .codes import knoodle_diagrams
from .source import Source

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
_DELIMITERS = ",\t|;"
_MAX_BYTES = 256 << 20  # KnotInfo's own, with all invariants, has dozens of megabytes


@checked
def knot_list(path: str | os.PathLike[str]) -> dict[str, str]:
    """The names in a list of knots and their codes, for `mobius_flow.core.knots.knot`: ``{"3_1": "PD: [[1,5,2,...``.

    A list is a table with a first line of names, among which is one of `CODES`, separated by commas, tabs, semicolons
    or bars; or it has a code in each line, after a name and a separator or alone; or it is Knoodle's.  Rows without a
    code are known by their names, such as 3_1, or left out; rows without a name of their own have numbers.  Raises
    CurveFileError if there is no code.
    """
    source = Source.load(Path(path), _MAX_BYTES)
    if source.text.lstrip()[:1] in "ksul0123456789" and (diagrams := _knoodle(source)):
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
    """Names and codes, either of which may be empty."""
    lines = [line for line in lines if line.strip() and not line.startswith("#")]
    delimiter = max(_DELIMITERS, key=lines[0].count) if lines else ","
    table = csv.reader(lines, delimiter=delimiter, skipinitialspace=True)
    head = [cell.strip().lower().replace(" ", "_") for cell in next(table, [])]
    column = next((head.index(name) for name in CODES if name in head), None)
    if column is None:
        yield from map(_plain, lines)
        return
    title = next((head.index(name) for name in _NAMES if name in head), None)
    for row in table:
        if column < len(row):
            name = row[title].strip() if title is not None and title < len(row) else ""
            yield name, _code(row[column].strip(), CODES[head[column]]) or _known(name)


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


def _knoodle(source: Source) -> list[Diagram]:
    """The diagrams of Knoodle's crossings; none if it is another table."""
    try:
        return knoodle_diagrams(source)
    except CurveFileError:
        if source.text.lstrip()[:1] in "ksul":
            raise
        return []


def _code(text: str, before: str) -> str:
    """The text that `knot` reads for a cell; empty for cells that hold no code."""
    if before != "braid":
        return before + text if _CODE.fullmatch(text) else ""
    match = _BRAID.fullmatch(text)
    if match is None:
        return ""
    strands, letters = match.groups()
    return f"BR[{strands},{{{letters}}}]" if strands else f"braid({letters})"
