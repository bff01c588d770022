"""Two polygons with the vertices of both: those of each that the other one lacks are put on its edges."""

import numpy as np

from ..types import FloatArray
from .curve import Curve
from .mesh import Mesh
from .smooth import arc_lengths, at_shares

TOGETHER = 0.3  # mean edges that vertices of the two may be apart to be one


def refined_alike(x: Curve, y: Curve, begins: tuple[float, ...]) -> tuple[Curve, Curve]:
    """Two curves with the same components on one mesh, vertices at equal shares of length.

    ``begins``: the share of the length of each component of ``y`` at which that of ``x`` has its first vertex.
    """
    parts = [_alike(x, y, k, begin) for k, begin in enumerate(begins)]
    mesh = Mesh(tuple(len(points) for points, _ in parts), x.mesh.closed)
    return Curve(np.concatenate([p for p, _ in parts]), mesh), Curve(np.concatenate([q for _, q in parts]), mesh)


def _alike(x: Curve, y: Curve, component: int, begin: float) -> tuple[FloatArray, FloatArray]:
    closed = x.mesh.closed[component]
    shares = [arc_lengths(each.components[component]) / each.component_lengths[component] for each in (x, y)]
    near = TOGETHER / max(map(len, shares))
    if closed:
        shares[0] = (shares[0] + begin + near) % 1.0 - near  # so that the first of all has whom to be one with
    events = sorted((share, which, k) for which in (0, 1) for k, share in enumerate(shares[which].tolist()))
    nodes: list[dict[int, int]] = []  # the vertex of each curve that there is at one
    places: list[float] = []
    for share, which, k in events:
        if nodes and which not in nodes[-1] and len(nodes[-1]) == 1 and share - places[-1] < near:
            nodes[-1][which] = k
        else:
            nodes.append({which: k})
            places.append(share)
    found = []
    for which, (curve, first) in enumerate(((x, begin), (y, 0.0))):
        part, own = curve.components[component], np.array(places)
        points = at_shares(part, closed, (own - first) % 1.0 if closed else own)
        has = [node for node, vertices in enumerate(nodes) if which in vertices]
        points[has] = part[[nodes[node][which] for node in has]]
        found.append(points)
    return found[0], found[1]
