"""Objects that show curves without being curve objects, a trefoil and an open curve each, for tests."""

import bmesh
import bpy
import numpy as np
from blender_scenes import show
from shapes import torus_trefoil

KNOT = torus_trefoil(24).vertices.astype(np.float32)
ARC = np.column_stack([np.linspace(-1, 1, 9), 0.2 * np.cos(np.arange(9)), np.full(9, 3.0)]).astype(np.float32)
POINTS = np.concatenate([KNOT, ARC])
SIZES = [len(KNOT), len(ARC)]
TINT, THICK = np.linspace(0, 1, len(POINTS)).astype(np.float32), np.linspace(0.02, 0.05, len(POINTS)).astype(np.float32)
STROKES = bpy.app.version >= (4, 3)


def fill(owner, thick=True):
    """Give points, or what has them, attributes."""
    owner.attributes["position"].data.foreach_set("vector", POINTS.ravel())
    owner.attributes.new("tint", "FLOAT", "POINT").data.foreach_set("value", TINT)
    if thick:
        owner.attributes.new("radius", "FLOAT", "POINT").data.foreach_set("value", THICK)


def wear(data):
    data.materials.append(bpy.data.materials.new("Own"))
    return show(bpy.data.objects.new("Source", data))


def add_hair(kind="POLY"):
    """Hair curves; where scripts cannot say of what kind they are, they are Catmull-Rom splines."""
    data = bpy.data.hair_curves.new("Source")
    data.add_curves(SIZES)
    data.attributes.new("cyclic", "BOOLEAN", "CURVE").data.foreach_set("value", [True, False])
    fill(data)
    data.attributes.new("strand", "INT", "CURVE").data.foreach_set("value", [7, 8])
    if hasattr(data, "set_types"):
        data.set_types(type=kind)
        if kind == "BEZIER":
            for name, shift in (("handle_left", -0.1), ("handle_right", 0.1)):
                handles = data.attributes.new(name, "FLOAT_VECTOR", "POINT").data
                handles.foreach_set("vector", (POINTS + np.float32(shift)).ravel())
    return wear(data)


def add_strokes():
    """Strokes in two layers, the second of which is moved."""
    data = (bpy.data.grease_pencils_v3 if hasattr(bpy.data, "grease_pencils_v3") else bpy.data.grease_pencils).new(
        "Source"
    )
    first = 0
    for size, closed in zip(SIZES, (True, False), strict=True):
        layer, part = data.layers.new("Layer"), slice(first, first := first + size)
        drawing = layer.frames.new(1).drawing
        drawing.add_strokes([size])
        layer.translation = (0, 0, 0 if closed else 1)
        points = POINTS[part] - np.array(layer.translation, dtype=np.float32)
        drawing.attributes["position"].data.foreach_set("vector", points.ravel())
        drawing.attributes.new("cyclic", "BOOLEAN", "CURVE").data.foreach_set("value", [closed])
        drawing.attributes.new("tint", "FLOAT", "POINT").data.foreach_set("value", TINT[part])
        drawing.attributes.new("radius", "FLOAT", "POINT").data.foreach_set("value", THICK[part])
    return wear(data)


def add_edges():
    data = bpy.data.meshes.new("Source")
    n, m = SIZES
    ring, path = [(k, (k + 1) % n) for k in range(n)], [(n + k, n + k + 1) for k in range(m - 1)]
    data.from_pydata(POINTS.tolist(), [*ring, *path], [])
    fill(data)
    return wear(data)


def add_loop():
    """A wall along the knot, the lower loop of whose edges is selected."""
    data, made, n = bpy.data.meshes.new("Source"), bmesh.new(), len(KNOT)
    low, high = ([made.verts.new(point) for point in KNOT + np.float32([0, 0, z])] for z in (0, 0.1))
    for k in range(n):
        made.faces.new((low[k - 1], low[k], high[k], high[k - 1]))
    for edge in made.edges:
        edge.select = not set(edge.verts) & set(high)
    made.to_mesh(data)
    made.free()
    return wear(data)


def nodes(kind, **values):
    """A tree of one node between its input and its output."""
    tree = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    first, node, last = (tree.nodes.new(each) for each in ("NodeGroupInput", kind, "NodeGroupOutput"))
    for name, value in values.items():
        node.inputs[name].default_value = value
    if node.inputs and node.inputs[0].type == "GEOMETRY":
        tree.links.new(first.outputs[0], node.inputs[0])
    tree.links.new(node.outputs[0], last.inputs[0])
    return tree


def add_made():
    """Hair curves that nodes move, so that what they show is read."""
    obj = add_hair()
    obj.modifiers.new("Nodes", "NODES").node_group = nodes("GeometryNodeSetPosition", Offset=(0, 0, 2))
    return obj


KINDS = {
    "poly": add_hair,
    "Catmull-Rom": lambda: add_hair("CATMULL_ROM"),
    "Bézier": lambda: add_hair("BEZIER"),
    "NURBS": lambda: add_hair("NURBS"),
    "made": add_made,
    "edges": add_edges,
    "loop": add_loop,
    **({"strokes": add_strokes} if STROKES else {}),
}


def points(obj, name="position", field="vector", width=3):
    """What is shown of an object: an attribute of all points, in its coordinates; (n, width)."""
    data = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    layers = getattr(data, "layers", ())
    owners = [layer.frames[0].drawing for layer in layers if len(layer.frames)] or [data]
    arrays = [np.empty(width * len(owner.attributes[name].data), dtype=np.float32) for owner in owners]
    for owner, array in zip(owners, arrays, strict=True):
        owner.attributes[name].data.foreach_get(field, array)
    return np.concatenate(arrays).reshape(-1, width)
