"""Where on which objects something is the matter, in coordinates that go with the objects."""

from dataclasses import dataclass

import numpy as np

from ...core import Curve
from ...core.errors import Place
from ...core.types import FloatArray
from .placement import Link


@dataclass(frozen=True, eq=False)
class Spot:
    """Points of one object.

    Attributes
    ----------
    member
        Number of the object among those that are relaxed together.
    points
        The points to select, in the object's coordinates; shape (k, 3).
    marks
        The places to mark, likewise; one for the object at which the place is, none for others.
    """

    member: int
    points: FloatArray
    marks: FloatArray


def spots(place: Place, curve: Curve, link: Link) -> list[Spot]:
    """The spots of a place on a curve in the world, object by object, that with the mark first."""
    vertices = list(place.vertices) or [_nearest(place, curve)]
    stored = link.to_stored(curve.mesh, curve.vertices)
    members = [next(k for k, part in enumerate(link.slices(curve.mesh)) if v < part.stop) for v in vertices]
    mark = link.placements[members[0]].to_local(np.array([place.position]))
    return [
        Spot(
            member,
            stored[[v for v, owner in zip(vertices, members, strict=True) if owner == member]],
            mark if member == members[0] else mark[:0],
        )
        for member in dict.fromkeys(members)
    ]


def _nearest(place: Place, curve: Curve) -> int:
    return int(np.linalg.norm(curve.vertices - place.position, axis=1).argmin())


def at(points: FloatArray, wanted: FloatArray) -> FloatArray:
    """Which points, (n, 3), are nearest to one of those wanted, (k, 3), or in the same place as it is; shape (n,)."""
    distances = np.linalg.norm(points[:, None] - wanted[None], axis=2)
    return np.asarray((distances <= distances.min(axis=0)).any(axis=1))
