"""Markers: points on a polygon, always as many, that follow it through changes of its mesh.

Blender's keys need the same points throughout. On each mesh every vertex is a marker, and the others have places on
edges: so all move straight where vertices do. Where a vertex is left out, its marker stays on the edge; where one is
put in, a marker of that edge becomes it, and only if none is left, all earlier shapes get one more.
"""

from collections.abc import Sequence

import numpy as np

from ...core.types import FloatArray, IntArray
from .interpolation import interpolated


class Markers:
    """Those of one component.

    A place is the number of a vertex and, after the point, a part of the edge to the next one. Places ascend; round a
    closed polygon the first one comes again in the end, a turn later. The first one is the first vertex at the start.
    """

    def __init__(self, size: int, closed: bool) -> None:
        self.closed, self._size = closed, size
        # places on each mesh of the markers that there were then,
        self._places: list[FloatArray] = [np.arange(size + closed, dtype=float)]
        # where there came more, the number of the mesh, and the places of all among those that there were before
        self._more: list[tuple[int, FloatArray]] = []

    def __len__(self) -> int:
        return len(self._places[-1]) - self.closed

    def change(self, here: Sequence[int], there: Sequence[int], size: int) -> None:
        """Go on to a mesh of so many vertices, of which some, ``there``, are vertices ``here`` of the last one."""
        places, old = self._places[-1], np.array(here)
        turn = len(places) - 1
        index = np.searchsorted(places, old + self._size * (old < places[0]))
        first = int(index.argmin())
        index, new = np.roll(index, -first), np.roll(there, -first)
        new = new + size * (new < new[0])
        if self.closed:
            index, new = np.append(index, index[0] + turn), np.append(new, new[0] + size)
        parts, wanted = np.diff(index), np.diff(new)
        pieces = np.maximum(parts, wanted)
        before = np.append(np.repeat(index[:-1], pieces) + _cut(parts, pieces), index[-1])
        after = np.append(np.repeat(new[:-1], pieces) + _cut(wanted, pieces), new[-1])
        if self.closed:  # begin with the first marker again
            cut = np.searchsorted(before, turn)
            before = np.concatenate([before[cut:-1] - turn, before[: cut + 1]])
            after = np.concatenate([after[cut:-1] - size, after[: cut + 1]])
            after -= size * np.floor(after[0] / size)
        if len(before) > len(places):
            self._more.append((len(self._places), before))
        self._places.append(after)
        self._size = size

    def back(self, stage: int, size: int) -> None:
        """Go back to one of the meshes, of so many vertices, as if there had been none after it."""
        del self._places[stage + 1 :]
        self._more = [(number, before) for number, before in self._more if number <= stage]
        self._size = size

    def on(self, vertices: FloatArray, stage: int) -> FloatArray:
        """All markers on a polygon with one of the meshes, (n, m) to (markers, m)."""
        stage %= len(self._places)  # the last is −1 too
        at = np.arange(len(self), dtype=float)
        for number, before in reversed(self._more):
            if number > stage:
                at = np.interp(at, np.arange(len(before)), before)
        places = np.interp(at, np.arange(len(self._places[stage])), self._places[stage])
        return interpolated(np.concatenate([vertices, vertices[:1]]), places % len(vertices))


def _cut(parts: IntArray, pieces: IntArray) -> FloatArray:
    """Cut each stretch of so many parts into as many pieces or more, about evenly: at which parts these begin.

    Where a part begins a piece does; shape (all pieces,).
    """
    p, q = np.repeat(pieces, pieces), np.repeat(parts, pieces)
    k = np.arange(len(p)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    part = ((k + 1) * q - 1) // p
    low, high = part * p // q, (part + 1) * p // q
    return np.asarray(part + (k - low) / (high - low))
