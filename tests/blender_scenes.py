"""Curve objects for tests, what they look like when evaluated, and what is in a file."""

import re
from collections.abc import Sequence
from pathlib import Path

import bpy
import numpy as np
from shapes import hopf_link, torus_trefoil


def add_curve(
    components: Sequence[np.ndarray], name: str = "Knot", kind: str = "POLY", cyclic: bool = True
) -> bpy.types.Object:
    """An active, selected curve object with these splines."""
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    for points in components:
        spline = data.splines.new(kind)
        spline.use_cyclic_u = cyclic
        if kind == "BEZIER":
            spline.bezier_points.add(len(points) - 1)
            spline.bezier_points.foreach_set("co", np.ravel(points))
        else:
            spline.points.add(len(points) - 1)
            spline.points.foreach_set("co", np.column_stack([points, np.ones(len(points))]).ravel())
    return show(bpy.data.objects.new(name, data))


def show(obj: bpy.types.Object) -> bpy.types.Object:
    """Put an object into the scene, selected and active."""
    bpy.context.scene.collection.objects.link(obj)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    return obj


def add_trefoil(n: int = 30) -> bpy.types.Object:
    return add_curve([torus_trefoil(n).vertices])


def add_hopf_link(n: int = 24) -> bpy.types.Object:
    vertices = hopf_link(n).vertices
    return add_curve([vertices[:n], vertices[n:]])


def relax(**options: object) -> bpy.types.Object:
    """Relax the active object; it is drawn as a line, so that its evaluated mesh shows its points."""
    obj = bpy.context.object
    assert bpy.ops.curve.mobius_flow_relax(**{"fit_bevel": False} | options) == {"FINISHED"}
    return obj


def linked(path: Path, kind: str, name: str) -> bpy.types.ID:
    """A datablock of the open file, which is saved as a library and linked into an empty one."""
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(str(path), link=True) as (_, wanted):
        setattr(wanted, kind, [name])
    (block,) = getattr(wanted, kind)
    return block


def stored(data: bpy.types.Curve) -> np.ndarray:
    """The points of all splines as stored; (n, 3)."""
    arrays = []
    for spline in data.splines:
        points = np.empty(4 * len(spline.points), dtype=np.float32)
        spline.points.foreach_get("co", points)
        arrays.append(points.reshape(-1, 4)[:, :3])
    return np.concatenate(arrays)


def values(spline: bpy.types.Spline, name: str) -> np.ndarray:
    array = np.empty(len(spline.points), dtype=np.float32)
    spline.points.foreach_get(name, array)
    return array


def evaluated(obj: bpy.types.Object, frame: float | None = None) -> np.ndarray:
    """The vertices that Blender shows of an object, in its own coordinates; without bevel the points; (n, 3)."""
    if frame is not None:
        bpy.context.scene.frame_set(int(np.floor(frame)), subframe=float(frame - np.floor(frame)))
    shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = shown.to_mesh()
    points = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", points)
    shown.to_mesh_clear()
    return points.reshape(-1, 3)


def place(obj: bpy.types.Object) -> None:
    """Move, turn and stretch an object."""
    obj.location, obj.rotation_euler, obj.scale = (1, 2, 3), (0.3, 0.2, 0.1), (2, 1, 0.5)
    bpy.context.view_layer.update()


def drawn(obj: bpy.types.Object) -> np.ndarray:
    """Vertices of what is drawn of an object, a tube for instance, in the world; (n, 3)."""
    shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return in_world(shown, evaluated(obj))


def in_world(obj: bpy.types.Object, points: np.ndarray) -> np.ndarray:
    matrix = np.array(obj.matrix_world, dtype=np.float64)
    return points.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]


def fcurves(block: bpy.types.ID) -> list[bpy.types.FCurve]:
    """The F-curves of a datablock's action in all versions of Blender."""
    action = block.animation_data.action
    if not hasattr(action, "slots"):
        return list(action.fcurves)
    (layer,) = action.layers
    (strip,) = layer.strips
    return list(strip.channelbag(block.animation_data.action_slot).fcurves)


def contents() -> dict[str, object]:
    """All that a refused operator must leave alone: the datablocks' names, and all there is to know of curves."""
    collections = {name: getattr(bpy.data, name) for name in dir(bpy.data)}
    blocks = {
        name: sorted(block.name for block in blocks)
        for name, blocks in collections.items()
        if isinstance(blocks, bpy.types.bpy_prop_collection)
    }
    objects = {obj.name: (str(obj.matrix_world), obj.select_get()) for obj in bpy.context.view_layer.objects}
    return blocks | {"splines": {data.name: _curve(data) for data in bpy.data.curves}, "transforms": objects}


def _curve(data: bpy.types.Curve) -> tuple[object, ...]:
    splines = [(spline.type, spline.use_cyclic_u, *map(_point, _points(spline))) for spline in data.splines]
    keys = [block.name for block in data.shape_keys.key_blocks] if data.shape_keys else None
    return data.dimensions, data.bevel_depth, data.bevel_resolution, keys, bool(data.animation_data), splines


def _points(spline: bpy.types.Spline) -> bpy.types.bpy_prop_collection:
    return spline.bezier_points if spline.type == "BEZIER" else spline.points


def _point(point: bpy.types.SplinePoint | bpy.types.BezierSplinePoint) -> str:
    return f"{tuple(point.co)} {point.radius} {point.tilt} {point.weight_softbody}"


def sentence(error: RuntimeError) -> str:
    """What a failed operator says, without what Blender puts before it; it must be one line."""
    text = re.sub(r"^(Error: |Operator \S+ )", "", str(error)).strip()
    assert "\n" not in text
    assert "Traceback" not in text
    return text
