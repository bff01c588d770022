"""Open curves made closed, far away from where they are, so that they have a knot type."""

import numpy as np

from .curve import Curve
from .mesh import Mesh

_FAR = 4.0  # radii of the curve; further out for each component, so that they do not meet there
_TURN = np.pi / 8  # between vertices far away: their edges do not come near the curve


def closed_far_away(curve: Curve) -> Curve:
    """Join the ends of open components: they go straight away from the centre of the vertices, then around it far out.

    Closed components stay.  The knot type is the closed curve's; for arcs whose ends are deep inside, it depends on
    where they leave, as with every closure.
    """
    center = curve.vertices.mean(axis=0)
    radius = float(np.linalg.norm(curve.vertices - center, axis=1).max())
    parts = []
    for k, (part, closed) in enumerate(zip(curve.components, curve.mesh.closed, strict=True)):
        if closed:
            parts.append(part)
            continue
        first, last = ((p - center) / (np.linalg.norm(p - center) or 1.0) for p in (part[0], part[-1]))
        across = first - (first @ last) * last
        if np.linalg.norm(across) < 1e-6:  # any way round will do
            across = np.eye(curve.dimension)[np.abs(last).argmin()]
            across -= (across @ last) * last
        across /= np.linalg.norm(across)
        angle = np.arctan2(first @ across, first @ last) % (2 * np.pi)
        turns = np.linspace(0.0, angle, max(int(np.ceil(angle / _TURN)), 1) + 1)[:, None]
        way = np.cos(turns) * last + np.sin(turns) * across
        parts.append(np.concatenate([part, center + _FAR * (1 + 0.25 * k) * radius * way]))
    return Curve(np.concatenate(parts), Mesh(tuple(map(len, parts))))
