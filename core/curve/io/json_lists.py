"""JSON lists of coordinates (.json): ``{"components": [[[x, y, z], ...], ...]}``, our own form.

The key "closed" has true or false for each component; without it all are closed. Other keys are ignored. A bare list of
components, or a bare list of points (one component), is read too. Any dimension from 2 on is allowed; NaN and Infinity
are not.
"""

import json
import re
from functools import partial
from typing import TextIO

from ..curve import Curve
from .source import Polygon, Source

_Path = tuple[str | int, ...]  # keys and indices that lead from the top to a value

_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"(?:\s*:)?|[\[\]{},]|[^\s\[\]{}:,"]+')  # a key with its colon is one


def read(source: Source) -> list[Polygon]:
    """Read the polygons; raises CurveFileError naming the line."""
    value = _parse(source)
    at: _Path = ()
    flags: object = None
    if isinstance(value, dict):
        if "components" not in value:
            raise source.error('the object has no key "components"', 1)
        value, flags, at = value["components"], value.get("closed"), ("components",)
    first = value[0] if isinstance(value, list) and value else None
    if isinstance(first, list) and first and not any(isinstance(x, list | dict) for x in first):  # a point
        return [_polygon(source, value, at, *_flags(source, flags, 1))]
    parts = _items(source, value, at, "a list of components")
    closed = _flags(source, flags, len(parts))
    return [_polygon(source, part, (*at, k), closed[k]) for k, part in enumerate(parts)]


def _parse(source: Source) -> object:
    try:
        return json.loads(source.text)
    except json.JSONDecodeError as error:
        raise source.error(f"not JSON: {error.msg}", error.lineno) from error
    except RecursionError as error:
        raise source.error("not a curve: lists nested too deeply") from error
    except ValueError as error:  # a whole number with thousands of digits
        raise source.error(f"not a curve: {error}") from error


def _flags(source: Source, flags: object, components: int) -> list[bool]:
    if flags is None:
        return [True] * components
    if isinstance(flags, list) and len(flags) == components and all(isinstance(flag, bool) for flag in flags):
        return flags
    reason = f'"closed" must be a list of true or false, one for each component, of which there are {components}'
    raise source.error(reason, _line_of(source.text, ("closed",)))


def _items(source: Source, value: object, at: _Path, wanted: str) -> list[object]:
    if not isinstance(value, list) or not value:
        found = "an empty list" if value == [] else _kind(value)
        raise source.error(f"{found} where {wanted} is expected", _line_of(source.text, at))
    return value


def _polygon(source: Source, value: object, at: _Path, closed: bool) -> Polygon:
    points = _items(source, value, at, "a list of points")
    return Polygon(
        [_point(source, point, (*at, i)) for i, point in enumerate(points)],
        lambda i: _line_of(source.text, (*at, i)),
        closed,
    )


def _point(source: Source, value: object, at: _Path) -> tuple[float, ...]:
    numbers = _items(source, value, at, "a point [x, y, z]")
    point = tuple(map(partial(_coordinate, source, at), numbers))
    if len(point) < 2:
        raise source.error("a point with 1 coordinate; at least 2 are needed", _line_of(source.text, at))
    return point


def _coordinate(source: Source, at: _Path, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise source.error(f"{_kind(value)} where a coordinate is expected", _line_of(source.text, at))
    try:
        return float(value)
    except OverflowError:
        return float("inf")  # refused with the vertex's number, like any coordinate that is not finite


def _kind(value: object) -> str:
    """Name what was found, in JSON's terms."""
    kinds = {dict: "an object", list: "a list", str: "a string", int: "a number", float: "a number"}
    return kinds.get(type(value)) or json.dumps(value)


def _line_of(text: str, path: _Path) -> int | None:
    """The line (from 1) where the value at a path starts, which Python's parser drops; None if there is none."""
    here: list[str | int] = []  # the key or index of the current value in each open object or list
    for match in _TOKEN.finditer(text):
        token = match[0]
        if token == ",":
            here[-1] = here[-1] + 1 if isinstance(here[-1], int) else here[-1]
        elif token in "]}":
            here.pop()
        elif token[-1] == ":":
            here[-1] = token[1 : token.rindex('"')]
        else:
            if tuple(here) == path:
                return text.count("\n", 0, match.start()) + 1
            if token in "[{":
                here.append(0 if token == "[" else "")
    return None


def write(curve: Curve, stream: TextIO) -> None:
    """Write the documented form, one vertex per line."""
    parts = ("[\n" + ",\n".join(json.dumps(point) for point in part.tolist()) + "\n]" for part in curve.components)
    flags = "" if curve.mesh.all_closed else f', "closed": {json.dumps(curve.mesh.closed)}'
    stream.write('{"components": [' + ", ".join(parts) + f"]{flags}}}\n")
