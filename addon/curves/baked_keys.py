"""The keys of baked curve objects, read, changed and written back, and what is proved of the motions between them."""

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from ...core import Curve, MobiusFlowError
from ...core.collision import is_free
from ...core.curve import Mesh
from ...core.messages import Message
from ...core.types import FloatArray
from ..engine.placement import Frame, Link, Placement
from ..engine.words import named
from . import bake
from .exchange import closed
from .rewriting import keyed_points, move_keys, scale_tube

if TYPE_CHECKING:
    import bpy


class BakedKeys:
    """What baked curve objects are at each of their keys.

    Parameters
    ----------
    objects
        Baked curve objects, their transforms evaluated.

    Attributes
    ----------
    mesh
        Connectivity of all their splines as one link.
    link
        Where its vertices are stored.
    frames
        The vertices at each key as stored, (n, 3).

    Raises
    ------
    MobiusFlowError
        If they have not equally many keys, so that they were not baked together.
    """

    def __init__(self, objects: Sequence["bpy.types.Object"]) -> None:
        self._objects = objects
        sizes = [[len(spline.points) for spline in obj.data.splines] for obj in objects]
        open_too = tuple(flag for obj in objects for flag in closed(obj.data))
        self.mesh = Mesh(tuple(size for each in sizes for size in each), open_too)
        placements = tuple(Placement.from_matrix(obj.matrix_world) for obj in objects)
        self.link = Link(placements, tuple(map(len, sizes)))
        keys = [keyed_points(obj.data) for obj in objects]
        if len({len(each) for each in keys}) > 1:
            title = named([obj.name for obj in objects])
            raise MobiusFlowError(Message("{names} were not baked together; select one of them at a time", names=title))
        self.frames: list[Frame] = [np.concatenate(each) for each in zip(*keys, strict=True)]

    @property
    def curves(self) -> list[Curve]:
        """The link at each key, in the world."""
        return [Curve(self._world(frame), self.mesh) for frame in self.frames]

    def _world(self, frame: Frame) -> FloatArray:
        pieces, points = zip(self.link.placements, self.link.slices(self.mesh), strict=True), frame.astype(np.float64)
        return np.concatenate([placement.to_world(points[vertices]) for placement, vertices in pieces])

    def rewrite(self, curves: Sequence[Curve], factors: FloatArray | None = None) -> None:
        """Give the keys other shapes, in the world, and what is drawn around them other sizes, by factors, (keys,)."""
        self.frames = [self.link.to_stored(self.mesh, curve.vertices).astype(np.float32) for curve in curves]
        for obj, vertices in zip(self._objects, self.link.slices(self.mesh), strict=True):
            move_keys(obj.data, [frame[vertices] for frame in self.frames])
            if factors is not None:
                scale_tube(obj.data, factors)
            bake.renew(obj.data)

    @property
    def unproved(self) -> int:
        """Number of straight motions from key to key, as stored, that are not proved free of contact."""
        common = [self.link.to_common(self.mesh, frame) for frame in self.frames]
        return sum(not is_free(self.mesh, a, b) for a, b in pairwise(common))
