"""A modifier of tube meshes that computes numbers of their curve at any frame, with nothing but Blender's own nodes.

The numbers refer to the middles of the rings as shown, and so hold between keys too, and need no extension.
"""

from typing import Any

import bpy

from ...core.curve.distances import STRAND_RATIO
from ...core.keys.colours import COMPONENT, DISTANCE

ARC_LENGTH, CURVATURE = "arc_length", "curvature"
RING, CLOSED = "ring", "closed"  # attributes that the nodes read: which vertex of the curve, and whether that is closed
_NAME = "Möbius Flow Attributes"
_FAR = 1e30


def add(tube: bpy.types.Object) -> None:
    """Give a tube's mesh, whose vertices have `RING`, `CLOSED` and `COMPONENT`, the modifier."""
    tree = bpy.data.node_groups.get(_NAME) or _tree()
    tube.modifiers.new(_NAME, "NODES").node_group = tree


class _Nodes:
    """Makes nodes; their inputs and outputs are sockets, in the order in which Blender shows them."""

    def __init__(self, tree: bpy.types.NodeTree) -> None:
        self.tree = tree

    def __call__(self, kind: str, *values: Any, out: int = 0, **settings: Any) -> Any:
        """Make a node; None leaves an input as it is."""
        node = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        for socket, value in zip((each for each in node.inputs if each.enabled), values, strict=False):
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, socket)
            elif value is not None:
                socket.default_value = value
        return [each for each in node.outputs if each.enabled][out]

    def math(self, operation: str, *values: Any) -> Any:
        return self("ShaderNodeMath", *values, operation=operation)

    def vector(self, operation: str, *values: Any) -> Any:
        return self("ShaderNodeVectorMath", *values, operation=operation)

    def both(self, *values: Any, operation: str = "AND") -> Any:
        return self("FunctionNodeBooleanMath", *values, operation=operation)

    def chosen(self, which: Any, no: Any, yes: Any, kind: str = "FLOAT") -> Any:
        return self("GeometryNodeSwitch", which, no, yes, input_type=kind)

    def stored(self, geometry: Any, name: str, value: Any) -> Any:
        return self("GeometryNodeStoreNamedAttribute", geometry, None, name, value, data_type="FLOAT", domain="POINT")

    def named(self, name: str) -> Any:
        return self("GeometryNodeInputNamedAttribute", name, data_type="FLOAT")

    def sampled(self, curve: Any, value: Any, point: Any, kind: str) -> Any:
        return self("GeometryNodeSampleIndex", curve, value, point, data_type=kind, domain="POINT")


def _tree() -> bpy.types.NodeTree:
    tree = bpy.data.node_groups.new(_NAME, "GeometryNodeTree")
    tree.is_modifier = True
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    given, made, node = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput"), _Nodes(tree)
    tube = given.outputs[0]
    # the curve through the middles of all rings
    ring, here = node.named(RING), node("GeometryNodeInputPosition")
    total = node("GeometryNodeAccumulateField", here, ring, out=2, data_type="FLOAT_VECTOR", domain="POINT")
    count, before = (node("GeometryNodeAccumulateField", 1.0, ring, out=k, data_type="FLOAT") for k in (2, 1))
    middle = node.vector("SCALE", total, node.math("DIVIDE", 1.0, count))
    first = node("FunctionNodeCompare", before, 0.5, operation="LESS_THAN")
    points = node("GeometryNodeMeshToPoints", tube, first, middle)
    curve = node("GeometryNodePointsToCurves", points, node.named(COMPONENT), ring)
    closed = node("FunctionNodeCompare", node.named(CLOSED), 0.5, operation="GREATER_THAN")
    curve = node("GeometryNodeSetSplineCyclic", curve, None, closed)
    # the corner at each point: the next point, or the one before, is at ends of open splines the point itself
    here, beside = node("GeometryNodeInputPosition"), []
    for offset in (-1, 1):
        inside, there = (node("GeometryNodeOffsetPointInCurve", None, offset, out=k) for k in (0, 1))
        beside.append(node.chosen(inside, here, node.sampled(curve, here, there, "FLOAT_VECTOR"), "VECTOR"))
    arc = node("GeometryNodeSplineParameter", out=1)
    curve = node.stored(curve, ARC_LENGTH, arc)
    # curvature: the angle by which the polygon turns, over half the length of both edges; at open ends 0
    edges = [node.vector("SUBTRACT", b, a) for a, b in ((beside[0], here), (here, beside[1]))]
    lengths = [node.vector("LENGTH", each) for each in edges]
    u, v = (node.vector("NORMALIZE", each) for each in edges)
    ways = [node.vector("LENGTH", node.vector(what, v, u)) for what in ("SUBTRACT", "ADD")]
    angle = node.math("MULTIPLY", node.math("ARCTAN2", *ways), 4.0)
    inner = node.math("GREATER_THAN", node.math("MINIMUM", *lengths), 0.0)
    curvature = node.math("MULTIPLY", inner, node.math("DIVIDE", angle, node.math("ADD", *lengths)))
    curve = node.stored(curve, CURVATURE, curvature)
    curve = _with_distances(node, curve, (beside[0], here, beside[1]), arc)
    for name in (ARC_LENGTH, CURVATURE, DISTANCE):
        tube = node.stored(tube, name, node.sampled(curve, node.named(name), node.named(RING), "FLOAT"))
    tree.links.new(tube, made.inputs[0])
    return tree


def _with_distances(node: _Nodes, curve: Any, corner: tuple[Any, Any, Any], arc: Any) -> Any:
    """Store the distances to the nearest other strands, measured to their edges: at each point the least one so far."""
    component, (_, here, _) = node("GeometryNodeCurveOfPoint"), corner
    curve = node.stored(curve, DISTANCE, _FAR)
    count = node("GeometryNodeAttributeDomainSize", curve, component="CURVE")
    start, end = (node.tree.nodes.new(f"GeometryNodeRepeat{side}") for side in ("Input", "Output"))
    start.pair_with_output(end)
    end.repeat_items.clear()
    end.repeat_items.new("GEOMETRY", "Geometry")
    end.repeat_items.new("INT", "Point")
    node.tree.links.new(count, start.inputs["Iterations"])
    node.tree.links.new(curve, start.inputs["Geometry"])
    inner, point = start.outputs["Geometry"], start.outputs["Point"]
    # whether a strand passes the point
    places = [node.sampled(inner, each, point, "FLOAT_VECTOR") for each in corner]
    before, there, after = (node.vector("DISTANCE", here, each) for each in places)
    passes = [node("FunctionNodeCompare", there, each, operation="LESS_EQUAL") for each in (before, after)]
    along = node.math("ABSOLUTE", node.math("SUBTRACT", arc, node.sampled(inner, arc, point, "FLOAT")))
    other_way = node.math("SUBTRACT", node("GeometryNodeSplineLength"), along)
    round_ = node("GeometryNodeInputSplineCyclic")
    along = node.chosen(round_, along, node.math("MINIMUM", along, other_way))
    apart = node("FunctionNodeCompare", along, node.math("MULTIPLY", there, STRAND_RATIO), operation="GREATER_THAN")
    its = node.sampled(inner, component, point, "FLOAT")
    other = node("FunctionNodeCompare", component, its, operation="NOT_EQUAL")
    passing = node.both(node.both(*passes), node.both(apart, other, operation="OR"))
    to_edges = []
    for neighbour in (places[0], places[2]):
        edge, way = (node.vector("SUBTRACT", each, places[1]) for each in (neighbour, here))
        square = node.math("MAXIMUM", node.vector("DOT_PRODUCT", edge, edge), 1.0 / _FAR)
        part = node("ShaderNodeClamp", node.math("DIVIDE", node.vector("DOT_PRODUCT", way, edge), square))
        to_edges.append(node.vector("DISTANCE", way, node.vector("SCALE", edge, part)))
    distance = node.chosen(passing, _FAR, node.math("MINIMUM", *to_edges))
    least = node.math("MINIMUM", node.named(DISTANCE), distance)
    node.tree.links.new(node.stored(inner, DISTANCE, least), end.inputs["Geometry"])
    node.tree.links.new(node.math("ADD", point, 1.0), end.inputs["Point"])
    # where nothing passes, the longest distance there is, or else the size of the whole
    curve, known = end.outputs["Geometry"], node.named(DISTANCE)
    some = node("FunctionNodeCompare", known, 0.5 * _FAR, operation="LESS_THAN")
    longest = node("GeometryNodeAttributeStatistic", curve, some, known, out=4, data_type="FLOAT", domain="POINT")
    box = [node("GeometryNodeBoundBox", curve, False, out=k) for k in (1, 2)]
    any_ = node("FunctionNodeCompare", longest, 0.0, operation="GREATER_THAN")
    most = node.chosen(any_, node.vector("DISTANCE", *box), longest)
    return node.stored(curve, DISTANCE, node.math("MINIMUM", known, most))
