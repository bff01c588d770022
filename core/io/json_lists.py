"""JSON lists of coordinates (.json): ``{"components": [[[x, y, z], ...], ...]}``, our own form.

The key "closed" has true or false for each component; without it all are closed. Other keys are ignored. A bare list of
components, or a bare list of points (one component), is read too. Any dimension from 2 on is allowed; NaN and Infinity
are not.
"""

import json
import re
from typing import TextIO

from ..curve import Curve
from .source import Polygon, Source

_Path = tuple[str | int, ...]  # keys and indices that lead from the top to a value

_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"(?:\s*:)?|[\[\]{},]|[^\s\[\]{}:,"]+')  # a key with its colon is one


def read(source: Source) -> list[Polygon]:
    """Read the polygons; raises CurveFileError naming the line."""
    try:
        value = json.loads(source.text)
    except json.JSONDecodeError as error:
        raise source.error(f"not JSON: {error.msg}", error.lineno) from error
    except RecursionError as error:
        raise source.error("not a curve: lists nested too deeply") from error
    except ValueError as error:  # a whole number with thousands of digits
        raise source.error(f"not a curve: {error}") from error
    at: _Path = ()
    closed: object = None
    if isinstance(value, dict):
        if "components" not in value:
            raise source.error('the object has no key "components"', 1)
        value, closed, at = value["components"], value.get("closed"), ("components",)
    first = value[0] if isinstance(value, list) and value else None
    if isinstance(first, list) and first and not any(isinstance(x, list | dict) for x in first):  # a point
        parts = [(at, value)]
    else:
        parts = [((*at, k), part) for k, part in enumerate(_items(source, value, at, "a list of components"))]
    flags = [True] * len(parts) if closed is None else closed
    if not isinstance(flags, list) or len(flags) != len(parts) or not all(isinstance(flag, bool) for flag in flags):
        reason = f'"closed" must be a list of true or false, one for each component, of which there are {len(parts)}'
        raise source.error(reason, _line_of(source.text, ("closed",)))
    return [_polygon(source, part, place, flag) for (place, part), flag in zip(parts, flags, strict=True)]


def _items(source: Source, value: object, at: _Path, wanted: str) -> list[object]:
    if not isinstance(value, list) or not value:
        found = "an empty list" if value == [] else _kind(value)
        raise source.error(f"{found} where {wanted} is expected", _line_of(source.text, at))
    return value


def _polygon(source: Source, value: object, at: _Path, closed: bool) -> Polygon:
    points = []
    for i, point in enumerate(_items(source, value, at, "a list of points")):
        place, numbers = (*at, i), list[float]()
        for number in _items(source, point, place, "a point [x, y, z]"):
            if isinstance(number, bool) or not isinstance(number, int | float):
                raise source.error(f"{_kind(number)} where a coordinate is expected", _line_of(source.text, place))
            try:
                numbers.append(float(number))
            except OverflowError:  # refused with the vertex's number, like any coordinate that is not finite
                numbers.append(float("inf"))
        if len(numbers) < 2:
            raise source.error("a point with 1 coordinate; at least 2 are needed", _line_of(source.text, place))
        points.append(numbers)
    return Polygon(points, lambda i: _line_of(source.text, (*at, i)), closed)


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
