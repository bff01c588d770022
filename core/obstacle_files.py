"""Obstacles from files: meshes and polylines as Wavefront OBJ, and any curve file."""

import os
from collections.abc import Sequence
from itertools import accumulate
from pathlib import Path

import numpy as np

from .arguments import checked
from .curve.io import load_curve
from .curve.io.obj import Content, Face, check_known, index_of, parsed
from .curve.io.source import Source
from .errors import CurveError, CurveFileError
from .obstacle import Obstacle
from .triangulation import Triangle, triangulated

_MAX_CUTTING = 1 << 24  # squares of the faces' numbers of corners, together: seconds; one face of 4,096 corners


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
        return _from_obj(Source.load(path))
    curve = load_curve(path).curve
    if curve.dimension != 3:
        raise CurveFileError(path, f"its points have {curve.dimension} coordinates; obstacles are in space")
    return Obstacle(curve.vertices, np.stack([curve.mesh.tails, curve.mesh.heads], axis=1), path.name)


def _from_obj(source: Source) -> Obstacle:
    content = parsed(source)
    _check_corners(source, content.faces)
    triangles = [triangle for face in content.faces for triangle in _triangles(source, content, face)]
    segments = [(link.tail, link.head) for link in content.links]
    if not triangles and not segments:
        raise source.error("no face (f) and no polyline (l) found; an obstacle is made of these")
    simplices: Sequence[tuple[int, ...]] = [*triangles, *((i, j, j) for i, j in segments)] if triangles else segments
    try:
        return Obstacle(content.points, simplices, source.path.name)
    except CurveError as error:
        raise source.error(str(error).removeprefix(f"{source.path.name}: ")) from error


def _check_corners(source: Source, faces: Sequence[Face]) -> None:
    """Refuse faces that would take long to cut into triangles, which takes time like the square of their corners."""
    for face, work in zip(faces, accumulate(len(face.words) ** 2 for face in faces), strict=True):
        if work > _MAX_CUTTING:
            raise source.error(
                f"a face with {len(face.words)} corners takes too long to cut into triangles after those before it; "
                "triangulate the mesh before exporting it",
                face.line,
            )


def _triangles(source: Source, content: Content, face: Face) -> list[Triangle]:
    if len(face.words) < 3:
        raise source.error("a face (f) needs at least three vertices", face.line)
    corners = [index_of(source, word, face.line, face.known) for word in face.words]
    check_known(source, max(corners), len(content.points), face.line)
    found = triangulated([content.points[k] for k in corners])
    return [(corners[a], corners[b], corners[c]) for a, b, c in found]
