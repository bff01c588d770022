"""All splines of a curve as they are, to be put back bit for bit or made into polygons."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...core import Curve
from ..engine.refinement import Places, along, places

if TYPE_CHECKING:
    import bpy

Values = dict[str, Any]
_TYPES: dict[str, Any] = {"BOOLEAN": np.int32, "INT": np.int32, "FLOAT": np.float32, "ENUM": np.int32}
_BEVEL = ("bevel_depth", "bevel_resolution", "use_fill_caps")
_POINT_VALUES = ("radius", "tilt", "weight_softbody")


@dataclass(frozen=True, eq=False)
class _Spline:
    """One spline: its own settings, and an array for every setting of its points."""

    type: str
    count: int
    settings: Values
    points: dict[str, npt.NDArray[Any]]

    @classmethod
    def of(cls, spline: "bpy.types.Spline") -> "_Spline":
        points = control_points(spline)
        arrays = {}
        for prop in _properties(points[0]) if len(points) else ():
            arrays[prop.identifier] = np.empty(len(points) * _width(prop), dtype=_TYPES[prop.type])
            points.foreach_get(prop.identifier, arrays[prop.identifier])
        settings = {prop.identifier: getattr(spline, prop.identifier) for prop in _properties(spline)}
        if spline.type != "NURBS":
            del settings["order_u"]  # means nothing, and is made valid when it is set
        return cls(spline.type, len(points), settings, arrays)

    @property
    def closed(self) -> bool:
        """Whether it is cyclic."""
        return bool(self.settings["use_cyclic_u"])

    def put(self, spline: "bpy.types.Spline") -> None:
        """Fill a spline of this type with this many points."""
        for name, array in self.points.items():
            control_points(spline).foreach_set(name, array)
        for name, value in self.settings.items():
            setattr(spline, name, value)

    @classmethod
    def from_values(cls, values: Values) -> "_Spline":
        """What `to_values` was called for."""
        points = {name: _array(value) for name, value in values["points"].items()}
        return cls(values["type"], values["count"], values["settings"].to_dict(), points)

    def to_values(self) -> Values:
        """All of it as custom properties can keep it in a file."""
        return {"type": self.type, "count": self.count, "settings": self.settings, "points": self.points}

    def polygon(self, size: int, place: Places) -> "_Spline":
        """A polygon of ``size`` points drawn for this spline, refined; where its points are is left open."""
        values = {name: along(self.points[name], size, self.closed) for name in _POINT_VALUES}
        settings = {name: value for name, value in self.settings.items() if name != "order_u"}
        points = {name: place.values(array).astype(np.float32) for name, array in values.items()}
        return _Spline("POLY", len(place.edge), settings, points)


class Snapshot:
    """The splines and the bevel of curve data at one time."""

    def __init__(self, splines: Sequence[_Spline], active: int | None, bevel: Values) -> None:
        self._splines, self._active, self._bevel = splines, active, bevel

    @classmethod
    def of(cls, data: "bpy.types.Curve") -> "Snapshot":
        """Take down what curve data is now."""
        active = next((k for k, spline in enumerate(data.splines) if spline == data.splines.active), None)
        bevel = {name: getattr(data, name) for name in _BEVEL}
        return cls([_Spline.of(spline) for spline in data.splines], active, bevel)

    @classmethod
    def from_values(cls, values: Values) -> "Snapshot":
        """What `to_values` was called for, from the custom property that it was put into."""
        splines = [_Spline.from_values(each) for each in values["splines"]]
        return cls(splines, values.get("active"), values["bevel"].to_dict())

    def to_values(self) -> Values:
        """All of it as custom properties can keep it in a file."""
        values: Values = {"splines": [spline.to_values() for spline in self._splines], "bevel": self._bevel}
        return values if self._active is None else values | {"active": self._active}

    def restore(self, data: "bpy.types.Curve") -> None:
        """Put everything back."""
        self.restore_splines(data)
        for name, value in self._bevel.items():
            setattr(data, name, value)

    def restore_splines(self, data: "bpy.types.Curve") -> None:
        """Put the splines back; the bevel stays as it is."""
        self._put(data, self._splines)

    def make_polygons(self, data: "bpy.types.Curve", original: Curve, refined: Curve) -> None:
        """Make splines poly splines with as many points as the refined curve has, if they are not yet.

        New points have values in between. All other properties stay; where the points are is left open.

        Parameters
        ----------
        data
            The curve data that this was taken from.
        original
            The polygons drawn for the splines.
        refined
            The same with more vertices.
        """
        pieces = zip(self._splines, original.mesh.component_sizes, places(original, refined), strict=True)
        polygons = [spline.polygon(size, place) for spline, size, place in pieces]
        if shape(data) != _shape_of(polygons):
            self._put(data, polygons)

    def _put(self, data: "bpy.types.Curve", splines: Sequence[_Spline]) -> None:
        """Fill curve data; its splines are made anew only if they cannot become these by more points alone."""
        if not _grows(shape(data), _shape_of(splines)):
            data.splines.clear()
            for kept in splines:
                data.splines.new(kept.type)
        for spline, kept in zip(data.splines, splines, strict=True):
            control_points(spline).add(kept.count - len(control_points(spline)))
            kept.put(spline)
        if self._active is not None:
            data.splines.active = data.splines[self._active]
        data.update_tag()


@dataclass(frozen=True)
class SplineShape:
    """What a spline is but for where its points are: its type, their number, and whether it is closed."""

    type: str
    count: int
    closed: bool


def shape(data: "bpy.types.Curve") -> list[SplineShape]:
    """What every spline is."""
    return [SplineShape(each.type, len(control_points(each)), bool(each.use_cyclic_u)) for each in data.splines]


def _grows(old: list[SplineShape], new: list[SplineShape]) -> bool:
    """Whether splines of one shape become those of another without fewer points or another type."""
    return len(old) == len(new) and all(
        before.type == after.type and before.count <= after.count for before, after in zip(old, new, strict=True)
    )


def _shape_of(splines: Sequence[_Spline]) -> list[SplineShape]:
    return [SplineShape(each.type, each.count, each.closed) for each in splines]


@contextmanager
def outside_edit_mode(objects: Sequence["bpy.types.Object"]) -> Iterator[None]:
    """Change curves of which some may just have been opened for editing: close them, and open them again afterwards."""
    import bpy

    mode = next((obj.mode for obj in objects if obj.mode != "OBJECT"), "OBJECT")
    if mode == "OBJECT":
        yield
        return
    bpy.ops.object.mode_set(mode="OBJECT")
    try:
        yield
    finally:
        bpy.ops.object.mode_set(mode=mode)
        bpy.ops.ed.undo_push(message="Relaxation Ended")


def _array(kept: Any) -> npt.NDArray[Any]:
    """A custom property's numbers, in the type that they were given in."""
    return np.array(kept, dtype={"f": np.float32, "i": np.int32}[kept.typecode])


def control_points(spline: "bpy.types.Spline") -> Any:
    """The points of a spline of any type."""
    return spline.bezier_points if spline.type == "BEZIER" else spline.points


def _properties(owner: "bpy.types.bpy_struct") -> list["bpy.types.Property"]:
    """Everything that can be written but what belongs to surfaces; the type of a spline is set when it is made."""
    properties = (p for p in owner.bl_rna.properties if p.type in _TYPES and not p.is_readonly)
    return [p for p in properties if p.identifier != "type" and not p.identifier.endswith("_v")]


def _width(prop: "bpy.types.Property") -> int:
    """Numbers in one value; only vectors have several."""
    return max(getattr(prop, "array_length", 1), 1)
