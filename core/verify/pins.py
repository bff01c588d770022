"""Whether pins hold: a vertex has the very coordinates of each, in all frames of a stage the same vertex."""

from dataclasses import dataclass

import numpy as np

from ..types import FloatArray, IntArray


class LostPinError(Exception):
    """A pin is not, or no longer, where a vertex is; the message says which."""


@dataclass(frozen=True, eq=False)
class HeldVertices:
    """The vertices of one stage that must not move."""

    vertices: IntArray  # their indices, in the order of the pins; shape (k,)
    points: FloatArray  # the places of the pins, shape (k, m)

    @classmethod
    def among(cls, frame: FloatArray, points: FloatArray) -> "HeldVertices":
        """The vertices of a stage's first frame, shape (n, m), at points, shape (k, m).

        Raises
        ------
        LostPinError
            If there is no vertex at one of them.
        """
        places = {tuple(vertex): k for k, vertex in enumerate(frame.tolist())}
        found = [places.get(tuple(point), -1) for point in points.tolist()]
        if -1 in found:
            raise LostPinError(f"no vertex is at pin {found.index(-1) + 1} (counted from 1)")
        return cls(np.array(found, dtype=np.intp), points)

    def check(self, frame: FloatArray) -> None:
        """Raise a LostPinError if one of them is elsewhere in a later frame; so it stays on the straight way there."""
        moved = np.flatnonzero((frame[self.vertices] != self.points).any(axis=1)) if len(self.points) else self.vertices
        if moved.size:
            vertex = self.vertices[moved[0]] + 1
            raise LostPinError(f"vertex {vertex} leaves pin {moved[0] + 1} (counted from 1)")
