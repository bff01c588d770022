"""JSON lists of coordinates (.json): ``{"components": [[[x, y, z], ...], ...]}``, our own form.

The key "closed" has true or false for each component; without it all are closed. Other keys are ignored. A bare list of
components, or a bare list of points (one component), is read too. Any dimension from 2 on is allowed; NaN and Infinity
are not.
"""

import json
from functools import partial
from typing import TextIO

from ..curve import Curve
from .json_position import Path, line_of
from .polygons import Polygon
from .source import Source


def read(source: Source) -> list[Polygon]:
    """Read the polygons; raises CurveFileError naming the line."""
    value = _parse(source)
    at: Path = ()
    flags: object = None
    if isinstance(value, dict):
        if "components" not in value:
            raise source.error('the object has no key "components"', 1)
        value, flags, at = value["components"], value.get("closed"), ("components",)
    if isinstance(value, list) and value and isinstance(value[0], list) and _is_point(value[0]):
        return [_polygon(source, value, at, *_flags(source, flags, 1))]
    parts = _items(source, value, at, "a list of components")
    closed = _flags(source, flags, len(parts))
    return [_polygon(source, part, (*at, k), closed[k]) for k, part in enumerate(parts)]


def _flags(source: Source, flags: object, components: int) -> list[bool]:
    """Whether each component is closed: all are if nothing is said."""
    if flags is None:
        return [True] * components
    if isinstance(flags, list) and len(flags) == components and all(isinstance(flag, bool) for flag in flags):
        return flags
    reason = f'"closed" must be a list of true or false, one for each component, of which there are {components}'
    raise source.error(reason, line_of(source.text, ("closed",)))


def _parse(source: Source) -> object:
    try:
        return json.loads(source.text)
    except json.JSONDecodeError as error:
        raise source.error(f"not JSON: {error.msg}", error.lineno) from error
    except RecursionError as error:
        raise source.error("not a curve: lists nested too deeply") from error
    except ValueError as error:  # a whole number with thousands of digits
        raise source.error(f"not a curve: {error}") from error


def _is_point(value: list[object]) -> bool:
    return bool(value) and not any(isinstance(x, list | dict) for x in value)


def _items(source: Source, value: object, at: Path, wanted: str) -> list[object]:
    if not isinstance(value, list) or not value:
        found = "an empty list" if value == [] else _kind(value)
        raise source.error(f"{found} where {wanted} is expected", line_of(source.text, at))
    return value


def _polygon(source: Source, value: object, at: Path, closed: bool) -> Polygon:
    points = _items(source, value, at, "a list of points")
    return Polygon(
        [_point(source, point, (*at, i)) for i, point in enumerate(points)],
        lambda i: line_of(source.text, (*at, i)),
        closed,
    )


def _point(source: Source, value: object, at: Path) -> tuple[float, ...]:
    numbers = _items(source, value, at, "a point [x, y, z]")
    point = tuple(map(partial(_coordinate, source, at), numbers))
    if len(point) < 2:
        raise source.error("a point with 1 coordinate; at least 2 are needed", line_of(source.text, at))
    return point


def _coordinate(source: Source, at: Path, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise source.error(f"{_kind(value)} where a coordinate is expected", line_of(source.text, at))
    try:
        return float(value)
    except OverflowError:
        return float("inf")  # refused with the vertex's number, like any coordinate that is not finite


def _kind(value: object) -> str:
    """Name what was found, in the words of JSON."""
    kinds: list[tuple[type, str]] = [(dict, "an object"), (list, "a list"), (str, "a string")]
    if value is None or isinstance(value, bool):
        return json.dumps(value)
    return next((name for kind, name in kinds if isinstance(value, kind)), "a number")


def write(curve: Curve, stream: TextIO) -> None:
    """Write the documented form, one vertex per line."""
    parts = ("[\n" + ",\n".join(json.dumps(point) for point in part.tolist()) + "\n]" for part in curve.components)
    flags = "" if curve.mesh.all_closed else f', "closed": {json.dumps(curve.mesh.closed)}'
    stream.write('{"components": [' + ", ".join(parts) + f"]{flags}}}\n")
