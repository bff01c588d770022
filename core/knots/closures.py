"""Open curves closed at random: how often each knot type comes out, for chains that have no ends in nature."""

from collections import Counter

import numpy as np

from ..base import CurveError, checked
from ..collision import check_embedded
from ..curve import Curve, Mesh
from .knot_type import knot_type


@checked
def closed_far_away(curve: Curve, direction: tuple[float, ...] | None = None) -> Curve:
    """Join the ends of open components far out: they go there straight, away from the centre of the vertices.

    With a direction, of length 1, both go that way.  Closed components stay.  The knot type is the closed curve's; for
    arcs whose ends are deep inside, it depends on where they leave, as with every closure.  Raises CurveError if the
    curve touches itself, or would where it is closed.
    """
    middle = curve.vertices.mean(axis=0)
    radius = float(np.linalg.norm(curve.vertices - middle, axis=1).max())
    parts = []
    for k, (part, closed) in enumerate(zip(curve.components, curve.mesh.closed, strict=True)):
        ends, far = part[[-1, 0]], part[:0]  # each component goes further out, so that none meet there
        if not closed and direction is not None:
            away = (3.0 + k) * radius - (ends - middle) @ direction
            far = ends + away[:, None] * np.array(direction)
        elif not closed:
            last, first = (ends - middle) / np.maximum(np.linalg.norm(ends - middle, axis=1), 1e-300)[:, None]
            between = last + first
            if np.linalg.norm(between) < 1e-6:  # any way round will do: where the curve extends least
                spread = curve.vertices - middle
                between = np.linalg.eigh(spread.T @ spread)[1][:, 0]
                between = between if abs(between @ last) < 0.9 else np.eye(curve.dimension)[np.abs(last).argmin()]
                between = between - (between @ last) * last
            # lines to a corner that is this far out do not come near the curve
            corner = 1.5 * between / np.linalg.norm(between)
            far = middle + (4.0 + k) * radius * np.stack([last, corner, first])
        parts.append(np.concatenate([part, far]))
    whole = Curve(np.concatenate(parts), Mesh(tuple(map(len, parts))))
    try:
        check_embedded(whole)
    except CurveError:
        check_embedded(curve)
        sentence = "ways from the ends of components to each other, far out, meet; close them at random instead"
        raise CurveError(sentence) from None
    return whole


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
