"""A modifier of tube meshes that computes numbers of their curve at any frame, with nothing but Blender's own nodes.

The numbers refer to the middles of the rings as shown, and so hold between keys too, and need no extension.
"""

from typing import Any

import bpy

from ...core.curve.distances import STRAND_RATIO
from ..engine.colours import COMPONENT, DISTANCE

ARC_LENGTH, CURVATURE = "arc_length", "curvature"
RING, CLOSED = "ring", "closed"  # attributes that the nodes read: which vertex of the curve, and whether that is closed
_NAME = "Möbius Flow Attributes"
_FAR = 1e30


def add(tube: bpy.types.Object) -> None:
    """Give a tube's mesh, whose vertices have `RING`, `CLOSED` and `COMPONENT`, the modifier."""
    tree = bpy.data.node_groups.get(_NAME) or _tree()
    tube.modifiers.new(_NAME, "NODES").node_group = tree


def _tree() -> bpy.types.NodeTree:
    tree = bpy.data.node_groups.new(_NAME, "GeometryNodeTree")
    tree.is_modifier = True
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    given, made = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    tree.links.new(_Nodes(tree).on_tube(given.outputs[0]), made.inputs[0])
    return tree


class _Nodes:
    """Makes nodes; their inputs and outputs are sockets, in the order in which Blender shows them."""

    def __init__(self, tree: bpy.types.NodeTree) -> None:
        self._tree = tree

    def __call__(self, kind: str, *values: Any, out: int = 0, **settings: Any) -> Any:
        """Make a node; None leaves an input as it is."""
        node = self._tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        for socket, value in zip((each for each in node.inputs if each.enabled), values, strict=False):
            if isinstance(value, bpy.types.NodeSocket):
                self._tree.links.new(value, socket)
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

    def on_tube(self, tube: Any) -> Any:
        """The tube with the numbers of its curve."""
        curve = self.on_curve(self._middles(tube))
        for name in (ARC_LENGTH, CURVATURE, DISTANCE):
            value = self.sampled(curve, self.named(name), self.named(RING), "FLOAT")
            tube = self.stored(tube, name, value)
        return tube

    def _middles(self, tube: Any) -> Any:
        """The curve through the middles of all rings."""
        ring, place = self.named(RING), self("GeometryNodeInputPosition")
        total = self("GeometryNodeAccumulateField", place, ring, out=2, data_type="FLOAT_VECTOR", domain="POINT")
        count, before = (self("GeometryNodeAccumulateField", 1.0, ring, out=k, data_type="FLOAT") for k in (2, 1))
        middle = self.vector("SCALE", total, self.math("DIVIDE", 1.0, count))
        first = self("FunctionNodeCompare", before, 0.5, operation="LESS_THAN")
        points = self("GeometryNodeMeshToPoints", tube, first, middle)
        curve = self("GeometryNodePointsToCurves", points, self.named(COMPONENT), ring)
        closed = self("FunctionNodeCompare", self.named(CLOSED), 0.5, operation="GREATER_THAN")
        return self("GeometryNodeSetSplineCyclic", curve, None, closed)

    def on_curve(self, curve: Any) -> Any:
        """The curve with all attributes."""
        here = self("GeometryNodeInputPosition")
        before, after = self._beside(curve, here, -1), self._beside(curve, here, 1)
        arc, component = self("GeometryNodeSplineParameter", out=1), self("GeometryNodeCurveOfPoint")
        curve = self.stored(curve, ARC_LENGTH, arc)
        curve = self.stored(curve, CURVATURE, self._curvature(before, here, after))
        return self._distances(curve, (before, here, after), arc, component)

    def sampled(self, curve: Any, value: Any, point: Any, kind: str) -> Any:
        return self("GeometryNodeSampleIndex", curve, value, point, data_type=kind, domain="POINT")

    def _beside(self, curve: Any, here: Any, offset: int) -> Any:
        """The position of the next point, or of the one before; at ends of open splines the point itself."""
        inside, there = (self("GeometryNodeOffsetPointInCurve", None, offset, out=k) for k in (0, 1))
        return self.chosen(inside, here, self.sampled(curve, here, there, "FLOAT_VECTOR"), "VECTOR")

    def _curvature(self, before: Any, here: Any, after: Any) -> Any:
        """The angle by which the polygon turns, over half the length of both edges; at open ends 0."""
        edges = [self.vector("SUBTRACT", b, a) for a, b in ((before, here), (here, after))]
        lengths = [self.vector("LENGTH", each) for each in edges]
        u, v = (self.vector("NORMALIZE", each) for each in edges)
        ways = [self.vector("LENGTH", self.vector(what, v, u)) for what in ("SUBTRACT", "ADD")]
        angle = self.math("MULTIPLY", self.math("ARCTAN2", *ways), 4.0)
        inner = self.math("GREATER_THAN", self.math("MINIMUM", *lengths), 0.0)
        return self.math("MULTIPLY", inner, self.math("DIVIDE", angle, self.math("ADD", *lengths)))

    def _distances(self, curve: Any, corner: tuple[Any, Any, Any], arc: Any, component: Any) -> Any:
        """Store the distances to the nearest other strands: at each point the least one so far."""
        curve = self.stored(curve, DISTANCE, _FAR)
        count = self("GeometryNodeAttributeDomainSize", curve, component="CURVE")
        start, end = (self._tree.nodes.new(f"GeometryNodeRepeat{side}") for side in ("Input", "Output"))
        start.pair_with_output(end)
        end.repeat_items.clear()
        end.repeat_items.new("GEOMETRY", "Geometry")
        end.repeat_items.new("INT", "Point")
        self._tree.links.new(count, start.inputs["Iterations"])
        self._tree.links.new(curve, start.inputs["Geometry"])
        inner, point = start.outputs["Geometry"], start.outputs["Point"]
        found = self.math("MINIMUM", self.named(DISTANCE), self._distance(inner, point, corner, arc, component))
        self._tree.links.new(self.stored(inner, DISTANCE, found), end.inputs["Geometry"])
        self._tree.links.new(self.math("ADD", point, 1.0), end.inputs["Point"])
        return self._bounded(end.outputs["Geometry"])

    def _distance(self, curve: Any, point: Any, corner: tuple[Any, Any, Any], arc: Any, component: Any) -> Any:
        """The distance to the strand that passes a point, measured to its edges there; far away if none passes."""

        def at(value: Any, kind: str = "FLOAT") -> Any:
            return self.sampled(curve, value, point, kind)

        here = corner[1]
        places = [at(each, "FLOAT_VECTOR") for each in corner]
        before, there, after = (self.vector("DISTANCE", here, each) for each in places)
        passes = [self("FunctionNodeCompare", there, each, operation="LESS_EQUAL") for each in (before, after)]
        along = self.math("ABSOLUTE", self.math("SUBTRACT", arc, at(arc)))
        length = self("GeometryNodeSplineLength")
        other_way = self.math("SUBTRACT", length, along)
        round_ = self("GeometryNodeInputSplineCyclic")
        along = self.chosen(round_, along, self.math("MINIMUM", along, other_way))
        apart = self("FunctionNodeCompare", along, self.math("MULTIPLY", there, STRAND_RATIO), operation="GREATER_THAN")
        other = self("FunctionNodeCompare", component, at(component), operation="NOT_EQUAL")
        passing = self.both(self.both(*passes), self.both(apart, other, operation="OR"))
        edges = [self._to_edge(here, places[1], each) for each in (places[0], places[2])]
        return self.chosen(passing, _FAR, self.math("MINIMUM", *edges))

    def _to_edge(self, here: Any, start: Any, end: Any) -> Any:
        edge, way = self.vector("SUBTRACT", end, start), self.vector("SUBTRACT", here, start)
        square = self.math("MAXIMUM", self.vector("DOT_PRODUCT", edge, edge), 1.0 / _FAR)
        part = self("ShaderNodeClamp", self.math("DIVIDE", self.vector("DOT_PRODUCT", way, edge), square))
        scaled = self.vector("SCALE", edge, part)
        return self.vector("DISTANCE", way, scaled)

    def _bounded(self, curve: Any) -> Any:
        """Where nothing passes, the longest distance there is, or else the size of the whole."""
        known = self.named(DISTANCE)
        some = self("FunctionNodeCompare", known, 0.5 * _FAR, operation="LESS_THAN")
        longest = self("GeometryNodeAttributeStatistic", curve, some, known, out=4, data_type="FLOAT", domain="POINT")
        box = [self("GeometryNodeBoundBox", curve, False, out=k) for k in (1, 2)]
        any_ = self("FunctionNodeCompare", longest, 0.0, operation="GREATER_THAN")
        most = self.chosen(any_, self.vector("DISTANCE", *box), longest)
        return self.stored(curve, DISTANCE, self.math("MINIMUM", known, most))
