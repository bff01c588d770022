"""What a curve must not touch: a still surface of triangles, or polylines."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .errors import CurveError
from .types import FloatArray, IntArray, frozen


@dataclass(frozen=True, eq=False)
class Obstacle:
    """A set of triangles or segments in space, which share vertices.

    Parameters
    ----------
    vertices
        Positions in the user's units, shape (k, 3).
    faces
        Indices of each simplex's vertices, shape (f, 3) for triangles or (f, 2) for segments.
    name
        What users call it.

    Raises
    ------
    CurveError
        If a coordinate is not finite, an index has no vertex, a shape is wrong, or a simplex is degenerate; the message
        says which.
    """

    vertices: FloatArray
    faces: IntArray
    name: str

    def __init__(self, vertices: npt.ArrayLike, faces: npt.ArrayLike, name: str = "obstacle") -> None:
        points, simplices = np.array(vertices, dtype=np.float64), np.array(faces, dtype=np.intp)
        if points.ndim != 2 or points.shape[1] != 3:
            raise CurveError(f"{name}: vertices have shape {points.shape}; they must be an array (k, 3)")
        if simplices.ndim != 2 or simplices.shape[1] not in (2, 3):
            raise CurveError(f"{name}: faces have shape {simplices.shape}; they must be an array (f, 3) or (f, 2)")
        object.__setattr__(self, "vertices", frozen(points))
        object.__setattr__(self, "faces", frozen(simplices))
        object.__setattr__(self, "name", name)

    @property
    def corners(self) -> FloatArray:
        """The simplices' vertices, shape (f, 3, 3) or (f, 2, 3)."""
        return frozen(self.vertices[self.faces])
