"""All splines of a curve as they are, to be put back bit for bit."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import bpy

Values = dict[str, Any]
_TYPES: dict[str, Any] = {"BOOLEAN": np.int32, "INT": np.int32, "FLOAT": np.float32, "ENUM": np.int32}
_BEVEL = ("bevel_depth", "bevel_resolution")


@dataclass(frozen=True, eq=False)
class _Spline:
    """One spline: its own settings, and an array for every setting of its points."""

    type: str
    count: int
    settings: Values
    points: dict[str, npt.NDArray[Any]]

    @classmethod
    def of(cls, spline: "bpy.types.Spline") -> "_Spline":
        points = _points(spline)
        arrays = {}
        for prop in _properties(points[0]):
            arrays[prop.identifier] = np.empty(len(points) * _width(prop), dtype=_TYPES[prop.type])
            points.foreach_get(prop.identifier, arrays[prop.identifier])
        settings = {prop.identifier: getattr(spline, prop.identifier) for prop in _properties(spline)}
        if spline.type != "NURBS":
            del settings["order_u"]  # means nothing, and is made valid when it is set
        return cls(spline.type, len(points), settings, arrays)

    def put(self, spline: "bpy.types.Spline") -> None:
        """Fill a spline of this type with this many points."""
        for name, array in self.points.items():
            _points(spline).foreach_set(name, array)
        for name, value in self.settings.items():
            setattr(spline, name, value)


class Snapshot:
    """The splines and the bevel of curve data at one time."""

    def __init__(self, data: "bpy.types.Curve") -> None:
        self._splines = [_Spline.of(spline) for spline in data.splines]
        self._active = next((k for k, spline in enumerate(data.splines) if spline == data.splines.active), None)
        self._bevel = {name: getattr(data, name) for name in _BEVEL}

    def restore(self, data: "bpy.types.Curve") -> None:
        """Put everything back; splines are made anew only if their types or numbers of points differ."""
        if shape(data) != [(spline.type, spline.count) for spline in self._splines]:
            self._rebuild(data)
        for spline, kept in zip(data.splines, self._splines, strict=True):
            kept.put(spline)
        for name, value in self._bevel.items():
            setattr(data, name, value)
        if self._active is not None:
            data.splines.active = data.splines[self._active]
        data.update_tag()

    def _rebuild(self, data: "bpy.types.Curve") -> None:
        data.splines.clear()
        for kept in self._splines:
            spline = data.splines.new(kept.type)
            _points(spline).add(kept.count - 1)


def shape(data: "bpy.types.Curve") -> list[tuple[str, int]]:
    """Type and number of points of every spline."""
    return [(spline.type, len(_points(spline))) for spline in data.splines]


@contextmanager
def outside_edit_mode(obj: "bpy.types.Object | None") -> Iterator[None]:
    """Change a curve that may just have been opened for editing: close it, and open it again afterwards."""
    import bpy

    mode = obj.mode if obj is not None else "OBJECT"
    if mode == "OBJECT":
        yield
        return
    bpy.ops.object.mode_set(mode="OBJECT")
    yield
    bpy.ops.object.mode_set(mode=mode)
    bpy.ops.ed.undo_push(message="Relaxation Ended")


def _points(spline: "bpy.types.Spline") -> Any:
    return spline.bezier_points if spline.type == "BEZIER" else spline.points


def _properties(owner: "bpy.types.bpy_struct") -> list["bpy.types.Property"]:
    """Everything that can be written but what belongs to surfaces; the type of a spline is set when it is made."""
    properties = (p for p in owner.bl_rna.properties if p.type in _TYPES and not p.is_readonly)
    return [p for p in properties if p.identifier != "type" and not p.identifier.endswith("_v")]


def _width(prop: "bpy.types.Property") -> int:
    """Numbers in one value; only vectors have several."""
    return max(getattr(prop, "array_length", 1), 1)
