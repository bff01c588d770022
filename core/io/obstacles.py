"""Obstacles from files: polylines, and meshes, cut into triangles, as Wavefront OBJ, and any curve file."""

import os
from collections.abc import Sequence
from itertools import accumulate, pairwise
from pathlib import Path

import numpy as np

from ..base import CurveError, CurveFileError, checked
from ..curve import Obstacle
from . import load_curve
from .obj import check_known, index_of, parsed
from .source import Source

Point = Sequence[float]
Triangle = tuple[int, int, int]


@checked
def read_obstacle(path: str | os.PathLike[str]) -> Obstacle:
    """Read an obstacle, which gets the file's name; coordinates are in the user's units.

    In an ``.obj`` file faces ``f`` count, polygons cut into triangles, and polylines ``l``, open ones too; in any other
    curve file its polygons. A CurveFileError names the file, the line where there is one, and the reason.
    """
    path = Path(path)
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise CurveFileError(path, "is not a regular file; obstacles are not read from pipes or devices")
    if path.suffix.lower() == ".obj":
        source = Source.load(path)
        content = parsed(source)
        most = 1 << 24  # squares of numbers of corners, which cutting into triangles takes time like: seconds
        for face, work in zip(content.faces, accumulate(len(face.words) ** 2 for face in content.faces), strict=True):
            if work > most:
                reason = (
                    f"a face with {len(face.words)} corners takes too long to cut into triangles after those before"
                )
                raise source.error(f"{reason} it; triangulate the mesh before exporting it", face.line)
        triangles: list[Triangle] = []
        for face in content.faces:
            if len(face.words) < 3:
                raise source.error("a face (f) needs at least three vertices", face.line)
            corners = [index_of(source, word, face.line, face.known) for word in face.words]
            check_known(source, max(corners), len(content.points), face.line)
            found = triangulated([content.points[k] for k in corners])
            triangles += ((corners[a], corners[b], corners[c]) for a, b, c in found)
        segments = [(link.tail, link.head) for link in content.links]
        if not triangles and not segments:
            raise source.error("no face (f) and no polyline (l) found; an obstacle is made of these")
        mixed = [*triangles, *((i, j, j) for i, j in segments)]
        try:
            return Obstacle(content.points, mixed if triangles else segments, source.path.name)
        except CurveError as error:
            raise source.error(str(error).removeprefix(f"{source.path.name}: ")) from error
    curve = load_curve(path).curve
    if curve.dimension != 3:
        raise CurveFileError(path, f"its points have {curve.dimension} coordinates; obstacles are in space")
    return Obstacle(curve.vertices, np.stack([curve.mesh.tails, curve.mesh.heads], axis=1), path.name)


def triangulated(points: Sequence[Point]) -> list[Triangle]:
    """Cut a polygon into triangles of its own vertices by clipping ears, as seen along the axis nearest to its normal.

    From k ≥ 3 points in space, in order, to the indices of the k − 2 triangles' vertices.  Where the points are not in
    a plane, or the polygon crosses itself or has no area, there is no right answer; triangles still span all vertices.
    """
    planes = [[(p[i], p[j]) for p in points] for i, j in ((1, 2), (2, 0), (0, 1))]
    areas = [sum(_turn(plane[0], a, b) for a, b in pairwise(plane)) for plane in planes]
    largest = max(range(3), key=lambda axis: abs(areas[axis]))
    flat = [(x, y) if areas[largest] > 0 else (y, x) for x, y in planes[largest]]  # going round to the left
    before, after = [len(points) - 1, *range(len(points) - 1)], [*range(1, len(points)), 0]

    def is_convex(k: int) -> bool:
        return _turn(flat[before[k]], flat[k], flat[after[k]]) > 0.0

    left, triangles = dict.fromkeys(range(len(points))), list[Triangle]()
    others = {k for k in left if not is_convex(k)}  # if any vertex lies in a corner, one of these does

    def holds_others(u: Point, v: Point, w: Point) -> bool:
        """Whether a corner holds one of the others, on its edges or in it, but for those at its vertices."""
        return any(
            _turn(u, v, p) >= 0.0 and _turn(v, w, p) >= 0.0 and _turn(w, u, p) >= 0.0 and p not in (u, v, w)
            for p in map(flat.__getitem__, others)
        )

    candidates = [*left]  # cutting off an ear makes new ones of its neighbours only
    while len(left) > 3:
        # Where there is no ear, the polygon crosses itself or has no area, and any corner will do.
        sure = not candidates
        k = next(iter(left)) if sure else candidates.pop()
        i, j = before[k], after[k]
        if not sure and (k not in left or k in others or holds_others(flat[i], flat[k], flat[j])):
            continue
        triangles.append((i, k, j))
        after[i], before[j] = j, i
        del left[k]
        others.discard(k)
        for neighbour in (i, j):
            (others.discard if is_convex(neighbour) else others.add)(neighbour)
        candidates += (i, j)
    i, j, k = left
    return [*triangles, (i, j, k)]


def _turn(a: Point, b: Point, c: Point) -> float:
    """Twice the area of a triangle in the plane: positive if it goes round to the left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
