"""The table of curve formats, and the two functions that look into it."""

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TextIO

from ...errors import CurveError, CurveFileError
from ...files import atomic_write
from ..curve import Curve, check_is_curve
from . import json_lists, obj, vect, xyz
from .polygons import Polygon, assemble
from .source import Source


@dataclass(frozen=True)
class Format:
    """How one kind of file is read and written.

    Parameters
    ----------
    description
        A few words for help texts.
    read
        Turn the text into polygons; raises CurveFileError.
    write
        Write the curve to a text stream; raises CurveError if the format cannot hold it.
    """

    description: str
    read: Callable[[Source], list[Polygon]]
    write: Callable[[Curve, TextIO], None]


_COLUMNS = Format("x y z per line, a blank line between components, # comments", xyz.read, xyz.write)

FORMATS: Mapping[str, Format] = MappingProxyType(
    {
        ".txt": _COLUMNS,
        ".xyz": _COLUMNS,
        ".obj": Format("Wavefront OBJ, vertices (v) and polylines (l)", obj.read, obj.write),
        ".vect": Format("Geomview VECT, closed polylines", vect.read, vect.write),
        ".json": Format('{"components": [[[x, y, z], ...], ...]}', json_lists.read, json_lists.write),
    }
)


def read_curve(path: str | os.PathLike[str]) -> Curve:
    """Read closed polygons from a file; the suffix tells the format (see :data:`FORMATS`).

    The order of components and vertices is kept. A vertex at a component's end that repeats its first
    vertex is dropped, with a note in the log.

    Parameters
    ----------
    path
        The file; coordinates are in the user's units.

    Raises
    ------
    CurveFileError
        If the file cannot be read or is not what its suffix says; the message names file, line and reason.
    """
    path = Path(path)
    form = _format_of(path)
    source = Source.load(path)
    return assemble(source, form.read(source))


def write_curve(path: str | os.PathLike[str], curve: Curve) -> None:
    """Write closed polygons to a file; the suffix tells the format (see :data:`FORMATS`).

    Coordinates are written with all their digits: reading the file gives the same doubles. The file
    appears whole or not at all.

    Parameters
    ----------
    path
        The file to make or to replace.
    curve
        The curve to write.

    Raises
    ------
    CurveFileError
        If the suffix is unknown, the format cannot hold the curve, or the file cannot be written.
    """
    check_is_curve(curve)
    path = Path(path)
    form = _format_of(path)
    try:
        with atomic_write(path) as temporary, temporary.open("w", encoding="utf-8", newline="\n") as stream:
            form.write(curve, stream)
    except CurveError as error:
        raise CurveFileError(path, str(error)) from error
    except OSError as error:
        raise CurveFileError(path, f"cannot be written: {error.strerror or error}") from error
    except ValueError as error:  # a path with a null character
        raise CurveFileError(path, f"cannot be written: {error}") from error


def _format_of(path: Path) -> Format:
    try:
        return FORMATS[path.suffix.lower()]
    except KeyError:
        found = f"unknown suffix {path.suffix!r}" if path.suffix else "no suffix"
        raise CurveFileError(path, f"{found}; curve files end in {', '.join(FORMATS)}") from None
