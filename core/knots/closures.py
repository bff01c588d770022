"""Open curves closed at random: how often each knot type comes out, for chains that have no ends in nature."""

from collections import Counter

import numpy as np

from ..base import CurveError, checked
from ..curve import Curve, Mesh
from .knot_type import knot_type


@checked
def closed_far_away(curve: Curve, direction: tuple[float, ...] | None = None) -> Curve:
    """Join the ends of open components far out in a direction, of length 1; both of a component go there straight.

    By default that is halfway between those in which its ends lie from the centre of the vertices.  Closed components
    stay.  The knot type is the closed curve's; for arcs whose ends are deep inside, it depends on where they leave.
    """
    middle = curve.vertices.mean(axis=0)
    radius = float(np.linalg.norm(curve.vertices - middle, axis=1).max())
    parts = []
    for k, (part, closed) in enumerate(zip(curve.components, curve.mesh.closed, strict=True)):
        ends, way = part[[-1, 0]], np.array(direction)
        if direction is None:
            units = (ends - middle) / np.maximum(np.linalg.norm(ends - middle, axis=1), 1e-300)[:, None]
            way = units.sum(axis=0)
            if np.linalg.norm(way) < 1e-6:  # ends are opposite: any way across will do
                way = np.eye(curve.dimension)[np.abs(units[0]).argmin()]
                way = way - (way @ units[0]) * units[0]
            way /= np.linalg.norm(way)
        # as far beyond the curve as it is large, and each component further out, so that none meet there
        away = (3.0 + k) * radius - (ends - middle) @ way
        parts.append(part if closed else np.concatenate([part, ends + away[:, None] * way]))
    return Curve(np.concatenate(parts), Mesh(tuple(map(len, parts))))


@checked
def closures(curve: Curve, count: int, seed: int = 0) -> Counter[str]:
    """Close the open components of a curve in space in ``count`` random directions, and count the types.

    Directions are uniform on the sphere, and follow from the seed (E. J. Janse van Rensburg et al., *J. Phys. A* 25,
    1992; K. C. Millett, A. Dobay, A. Stasiak, *Macromolecules* 38, 2005).  Raises CurveError if no component is open,
    the curve is not in space, or the count is not 1 to 100,000.
    """
    if curve.mesh.all_closed:
        raise CurveError("all components are closed; closures are of open ones")
    if curve.dimension != 3:
        raise CurveError(f"closures are of curves in space, and this one is in dimension {curve.dimension}")
    if not 1 <= count <= 100_000:
        raise CurveError(f"the number of closures is {count}; give 1 to 100000")
    directions = np.random.default_rng(seed).normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    return Counter(str(knot_type(closed_far_away(curve, (x, y, z)))) for x, y, z in directions.tolist())
