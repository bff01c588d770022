"""What curve objects were at one time, to see whether they still are, whether undone, done again or edited since."""

import hashlib
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .snapshot import control_points, shape

if TYPE_CHECKING:
    import bpy


class Imprint:
    """The points and the number of keys of curve objects now; cheap enough to compare at every redraw."""

    def __init__(self, objects: Sequence["bpy.types.Object"]) -> None:
        self._digests = {obj.session_uid: _digest(obj.data) for obj in objects}

    def fits(self, obj: "bpy.types.Object | None") -> bool:
        """Whether an object is one of these, and as it was then."""
        if obj is None or obj.type != "CURVE":
            return False
        return self._digests.get(obj.session_uid) == _digest(obj.data)


def _digest(data: "bpy.types.Curve") -> bytes:
    keys = len(data.shape_keys.key_blocks) if data.shape_keys else 0
    hashed = hashlib.blake2b(repr((shape(data), keys)).encode(), digest_size=16)
    for spline in data.splines:
        points = control_points(spline)
        width = 3 if spline.type == "BEZIER" else 4
        coordinates = np.empty(width * len(points), dtype=np.float32)
        points.foreach_get("co", coordinates)
        hashed.update(coordinates.tobytes())
    return hashed.digest()
