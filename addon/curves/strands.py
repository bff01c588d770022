"""What objects show as curves, as arrays: splines, hair curves, strokes and edges of meshes; and copies of the latter.

Whatever is no curve object goes through hair curves, which Blender's nodes make polygons of, with all attributes.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import bpy
import numpy as np
import numpy.typing as npt

from ...core import Curve, CurveError, Mesh
from ...core.base import BoolArray, FloatArray, Message
from ...core.keys.markers import on_refined
from ...core.keys.placement import Link, Placement
from .assets import add_nodes, drop_nodes
from .moving import what_deforms
from .sizes import placement
from .splines import coordinates, read, sampled, shape, smooth_splines

KINDS = {"CURVES", "GREASEPENCIL", "MESH"}  # of objects that are read besides curve objects
_MOST = 1000  # strands of one of them: a relaxation would never get anywhere with a fur of 100,000 hairs
_NODES = "Möbius Flow Strands"
_LAYER, _VERTEX = "mobius_flow_layer", "mobius_flow_vertex"  # attributes: number of a stroke's layer, and of a point
_USUAL = {"radius": 0.01, "opacity": 1.0, "fill_opacity": 1.0, "aspect_ratio": 1.0, "u_scale": 1.0}  # of strokes
_FIELDS: dict[str, tuple[str, int, Any]] = {  # of types of attributes: where values are, numbers of each, what they are
    "FLOAT": ("value", 1, np.float32),
    "FLOAT2": ("vector", 2, np.float32),
    "FLOAT_VECTOR": ("vector", 3, np.float32),
    "FLOAT_COLOR": ("color", 4, np.float32),
    "BYTE_COLOR": ("color", 4, np.float32),
    "QUATERNION": ("value", 4, np.float32),
    "INT": ("value", 1, np.int32),
    "INT8": ("value", 1, np.int32),
    "INT32_2D": ("value", 2, np.int32),
    "BOOLEAN": ("value", 1, np.bool_),
}


class Attribute(NamedTuple):
    """Values of all points, or of all curves."""

    type: str
    domain: str
    values: npt.NDArray[Any]  # (items,) or (items, numbers)


@dataclass(frozen=True, eq=False)
class Strands:
    """The polygons that an object shows, in its coordinates, and their attributes where it is no curve object."""

    components: Sequence[FloatArray]  # (n, 3) each
    closed: tuple[bool, ...]
    attributes: Mapping[str, Attribute] = field(default_factory=dict)
    materials: Sequence[bpy.types.Material | None] = ()
    own: bool = True  # those of its own data, on which modifiers act, rather than what these make

    @classmethod
    def of(cls, obj: bpy.types.Object) -> "Strands":
        """Read an object that is not being edited; smooth curves become the polygons that are drawn for them.

        What deforms curves, or makes them, is taken into account where it is no curve object. Raises CurveError if
        there are no curves or too many, one has too few points, or coordinates are not finite or as good as infinite.
        """
        if obj.type == "CURVE":
            frames = sampled(obj) if smooth_splines(obj.data) else [coordinates(each) for each in obj.data.splines]
            found = cls([each.astype(np.float64) for each in frames], tuple(flag for *_, flag in shape(obj.data)))
        else:
            found = cls((), ()) if what_deforms(obj) else _read(obj, True)
            found = found if found.components else _read(obj, False)
            if not found.components or (len(obj.modifiers) and _shows_nothing(obj)):
                sentence = "'{name}' shows no curves; draw some, or see what its modifiers do"
                raise CurveError(Message(sentence, name=obj.name))
        for k, (points, closed) in enumerate(zip(found.components, found.closed, strict=True), 1):
            if len(points) < (fewest := 3 if closed else 2):
                sentence = "Spline {number} of '{name}' has fewer than {fewest} points; give it more, or delete it"
                raise CurveError(Message(sentence, number=k, name=obj.name, fewest=fewest))
            bad = np.flatnonzero(~(np.abs(points) < 1e30).all(axis=1))  # Blender clamps infinite ones to the largest
            if bad.size:
                sentence = (
                    "Point {point} of spline {spline} of '{name}' is not finite, or further away than anything; repair"
                    " or delete it"
                )
                raise CurveError(Message(sentence, point=bad[0] + 1, spline=k, name=obj.name))
        return found

    @property
    def mesh(self) -> Mesh:
        return Mesh(tuple(map(len, self.components)), self.closed)

    def refined(self, drawn: Curve, refined: Curve) -> dict[str, Attribute]:
        """The attributes at the points of a refined link; ``drawn``: these polygons, wherever they are."""
        made = dict(self.attributes)
        for name, (kind, domain, values) in made.items():
            if domain == "POINT":
                pieces = (
                    on_refined(values[s], drawn.edge_lengths[a], refined.edge_lengths[b], closed)
                    for s, a, b, closed in zip(
                        drawn.mesh.slices, drawn.mesh.edge_slices, refined.mesh.edge_slices, self.closed, strict=True
                    )
                )
                made[name] = Attribute(kind, domain, np.concatenate(list(pieces)).astype(values.dtype))
        made["position"] = Attribute("FLOAT_VECTOR", "POINT", refined.vertices.astype(np.float32))
        made[_VERTEX] = Attribute("INT", "POINT", np.arange(len(refined), dtype=np.int32))
        return made


def read_link(objects: Sequence[bpy.types.Object]) -> tuple[Curve, Link]:
    """Read objects in world space, one component for each curve, and where they are stored; raises as `Strands.of`."""
    placements, each = tuple(map(placement, objects)), list(map(Strands.of, objects))
    world = [place.to_world(c) for place, strands in zip(placements, each, strict=True) for c in strands.components]
    link = Link(placements, tuple(len(strands.components) for strands in each))
    return Curve.from_components(world, [flag for strands in each for flag in strands.closed]), link


def line_edges(mesh: bpy.types.Mesh) -> BoolArray:
    """Which edges of a mesh are curves, (edges,): those selected, or all without faces; none if these branch."""
    chosen = read(mesh.edges, "select", dtype=bool) if mesh.polygons else np.ones(len(mesh.edges), dtype=bool)
    ends = read(mesh.edges, "vertices", 2, np.int32)[chosen]
    return np.asarray(chosen & bool((np.bincount(ends.ravel()) <= 2).all()))


def _read(obj: bpy.types.Object, own: bool) -> Strands:
    """The polygons of an object's own data, or of what its modifiers make of that."""
    drawn = obj.type == "CURVES" and own
    made, shown = [data := obj.data.copy() if drawn else bpy.data.hair_curves.new("Sampled")], obj
    try:
        if drawn:
            shown = None
        elif obj.type == "GREASEPENCIL":
            source, shown = obj if own else obj.evaluated_get(bpy.context.evaluated_depsgraph_get()), None
            _draw(data, source.data)
        elif own:
            made += [mesh := obj.data.copy(), shown := bpy.data.objects.new("Sampled", mesh)]
            chosen = line_edges(mesh)
            if len(chosen) and not chosen.any():
                sentence = "Edges of '{name}' branch, or none is selected beside faces; choose loops or paths"
                raise CurveError(Message(sentence, name=obj.name))
            _give(mesh, {"mobius_flow_chosen": Attribute("BOOLEAN", "EDGE", chosen)})
        _check_count(obj, data)
        made.append(bare := bpy.data.objects.new("Sampled", data))
        add_nodes(bare, _NODES, *filter(None, [shown]))
        bpy.context.scene.collection.objects.link(bare)
        result = bare.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        _check_count(obj, result)
        attributes = _attributes(result) if len(result.curves) else {}
        sizes = [each.points_length for each in result.curves]
    finally:
        for block in reversed(made):
            bpy.data.batch_remove([block])
        drop_nodes(_NODES)
        bpy.context.view_layer.update()
    if not attributes:
        return Strands((), ())
    for name in ("curve_type", "mobius_flow_poly", "mobius_flow_chosen"):  # all are polygons now
        attributes.pop(name, None)
    if "radius" not in attributes and obj.type != "MESH":  # edges of meshes have no thickness of their own
        attributes["radius"] = Attribute("FLOAT", "POINT", np.full(sum(sizes), _USUAL["radius"], dtype=np.float32))
    components = np.split(attributes["position"].values.astype(np.float64), np.cumsum(sizes)[:-1])
    closed = attributes["cyclic"].values if "cyclic" in attributes else np.zeros(len(sizes), dtype=bool)
    worn = obj if own else obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    materials = [each and each.original for each in worn.data.materials]
    return Strands(components, tuple(closed.tolist()), attributes, materials, own)


def _shows_nothing(obj: bpy.types.Object) -> bool:
    """Whether modifiers delete all of a visible object, and make nothing in its place."""
    sizes = [
        len(getattr(each.object.data, "points", getattr(each.object.data, "vertices", [obj])))
        for each in bpy.context.evaluated_depsgraph_get().object_instances
        if each.object.original == obj or (each.parent is not None and each.parent.original == obj)
    ]
    return bool(sizes) and not any(sizes)


def _check_count(obj: bpy.types.Object, data: Any) -> None:
    if len(data.curves) > _MOST:
        sentence = "'{name}' has {count} curves, and at most {most} are relaxed together; make an object of a few"
        raise CurveError(Message(sentence, name=obj.name, count=len(data.curves), most=_MOST))


def _drawings(data: Any) -> dict[int, Any]:
    """The drawings of strokes that are shown now, by the numbers of their layers."""

    def hidden(layer: Any) -> bool:
        return layer is not None and (layer.hide or hidden(layer.parent_group))

    frames = {k: layer.current_frame() for k, layer in enumerate(data.layers) if not hidden(layer)}
    return {k: frame.drawing for k, frame in frames.items() if frame is not None and len(frame.drawing.strokes)}


def _draw(data: Any, source: Any) -> None:
    """Make hair curves of the strokes that are shown, in the object's coordinates."""
    drawings = _drawings(source)
    sizes = {k: np.diff(read(each.curve_offsets, "value", dtype=np.int32)) for k, each in drawings.items()}
    if sizes:
        data.add_curves(np.concatenate(list(sizes.values())).tolist())
    every = {k: _attributes(each) for k, each in drawings.items()}
    for k, attributes in every.items():
        kind, domain, points = attributes["position"]
        place = Placement.from_matrix(source.layers[k].matrix_local)
        attributes["position"] = Attribute(kind, domain, place.to_world(points.astype(np.float64)).astype(np.float32))
        attributes[_LAYER] = Attribute("INT", "CURVE", np.full(len(sizes[k]), k, dtype=np.int32))
    shapes = {name: each for attributes in every.values() for name, each in attributes.items()}
    for name, (kind, domain, values) in shapes.items():
        counts = {k: len(sizes[k]) if domain == "CURVE" else int(sizes[k].sum()) for k in every}
        usual = np.full_like(values[:1], _USUAL.get(name, 0))  # in layers that have no such attribute
        parts = [each[name].values if name in each else usual.repeat(counts[k], axis=0) for k, each in every.items()]
        shapes[name] = Attribute(kind, domain, np.concatenate(parts))
    types = shapes.pop("curve_type").values if "curve_type" in shapes else np.ones(len(data.curves))
    shapes["mobius_flow_poly"] = Attribute("BOOLEAN", "CURVE", types == 1)  # the nodes set that in all versions
    for number, name in ((0, "CATMULL_ROM"), (2, "BEZIER"), (3, "NURBS")):
        if (types == number).any() and hasattr(data, "set_types"):
            data.set_types(type=name, indices=np.flatnonzero(types == number).tolist())
    _give(data, shapes)


def _attributes(owner: Any) -> dict[str, Attribute]:
    found = {}
    for each in owner.attributes:
        if each.data_type in _FIELDS and not each.name.startswith("."):  # selections and the like
            name, width, dtype = _FIELDS[each.data_type]
            found[each.name] = Attribute(each.data_type, each.domain, read(each.data, name, width, dtype))
    return found


def _give(owner: Any, attributes: Mapping[str, Attribute]) -> None:
    for name, (kind, domain, values) in attributes.items():
        attribute = owner.attributes.get(name) or owner.attributes.new(name, kind, domain)
        if attribute.data_type == kind and attribute.domain == domain:
            attribute.data.foreach_set(_FIELDS[kind][0], values.ravel())


def copied(source: bpy.types.Object, strands: Strands, drawn: Curve, refined: Curve) -> bpy.types.ID:
    """Data like an object's with a refined link in place of its curves, for `add_nodes` to move.

    ``drawn``: the link before, wherever it is; ``refined``: in the object's coordinates.
    """
    attributes, sizes = strands.refined(drawn, refined), refined.mesh.component_sizes
    if source.type == "GREASEPENCIL":
        data, layers = source.data.copy(), attributes.pop(_LAYER).values
        points = layers.repeat(sizes)
        for k, layer in enumerate(data.layers):
            for frame in list(layer.frames):
                layer.frames.remove(frame.frame_number)
            layer.translation = layer.rotation = (0.0, 0.0, 0.0)
            layer.scale = (1.0, 1.0, 1.0)
            if (layers == k).any():
                drawing = layer.frames.new(min(bpy.context.scene.frame_start, 0)).drawing
                drawing.add_strokes([size for size, of in zip(sizes, layers, strict=True) if of == k])
                chosen = {"POINT": points == k, "CURVE": layers == k}
                _give(drawing, {n: Attribute(t, d, v[chosen[d]]) for n, (t, d, v) in attributes.items()})
                drawing.tag_positions_changed()
        return data
    if source.type == "MESH" and strands.own:
        data = bpy.data.meshes.new(source.data.name)
        ends = np.column_stack([refined.mesh.tails, refined.mesh.heads])
        data.from_pydata(refined.vertices.tolist(), ends.tolist(), [])
        attributes = {name: each for name, each in attributes.items() if each.domain == "POINT"}
    else:
        data = bpy.data.hair_curves.new(source.data.name)
        data.add_curves(list(sizes))
    _give(data, attributes)
    for material in strands.materials:
        data.materials.append(material)
    return data
