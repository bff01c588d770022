"""Polygons in space cut into triangles, as for the faces of a mesh."""

from collections.abc import Sequence
from itertools import pairwise

Point = Sequence[float]
Triangle = tuple[int, int, int]


def triangulated(points: Sequence[Point]) -> list[Triangle]:
    """Cut a polygon into triangles of its own vertices by clipping ears, as seen along the axis nearest to its normal.

    Parameters
    ----------
    points
        Its vertices in order, k ≥ 3 points in space. Where they are not in a plane, or the polygon crosses itself or
        has no area, there is no right answer; the triangles still span all vertices.

    Returns
    -------
    The indices of the k − 2 triangles' vertices.
    """
    flat = _flat(points) if len(points) > 3 else []
    left = list(range(len(points)))
    triangles: list[Triangle] = []
    while len(left) > 3:
        k = next((k for k in range(len(left)) if _is_ear(flat, left, k)), 1)
        triangles.append(_corner(left, k))
        del left[k]
    return [*triangles, _corner(left, 1)]


def _flat(points: Sequence[Point]) -> list[Point]:
    """The polygon along the axis nearest to its area vector, going round to the left."""
    planes = [[(p[i], p[j]) for p in points] for i, j in ((1, 2), (2, 0), (0, 1))]
    areas = [sum(_turn(plane[0], a, b) for a, b in pairwise(plane)) for plane in planes]
    largest = max(range(3), key=lambda axis: abs(areas[axis]))
    return [(x, y) if areas[largest] > 0 else (y, x) for x, y in planes[largest]]


def _turn(a: Point, b: Point, c: Point) -> float:
    """Twice the area of a triangle in the plane: positive if it goes round to the left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _corner(left: list[int], k: int) -> Triangle:
    return left[k - 1], left[k], left[(k + 1) % len(left)]


def _is_ear(flat: list[Point], left: list[int], k: int) -> bool:
    """Whether a corner is convex and no other vertex lies in its triangle."""
    corner = _corner(left, k)
    u, v, w = (flat[each] for each in corner)
    if _turn(u, v, w) <= 0.0:
        return False
    others = (flat[each] for each in left if each not in corner)
    return not any(_turn(u, v, p) >= 0.0 and _turn(v, w, p) >= 0.0 and _turn(w, u, p) >= 0.0 for p in others)
