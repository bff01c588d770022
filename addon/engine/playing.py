"""How a relaxation is played in a scene of its own: where its curve is put, when it moves, and how it looks."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...core import Curve, Iterate, MobiusFlowError
from ...core.curve import Mesh
from ...core.types import FloatArray
from .key_options import Timing
from .motion import Motion
from .placement import Link, Placement
from .size import Measure

_FRAMES_PER_SIZE = 20  # in which the fastest vertex goes as far as the curve is wide
_FILM = (72, 720)  # frames in motion, at least and at most
_PAUSE = 6  # frames at rest before the motion begins
_END = 12  # frames at rest after it
_FAR = 8.0  # a curve further from the origin, in its own sizes, gets its own origin: 32 bits are few
_SIZES = (1e-3, 1e3)  # between these Blender works well


@dataclass(frozen=True)
class Playing:
    """How a relaxation is played in a scene or a film."""

    look: str | None = None  # one of `pictures.looks`; None: the default one, and films drawn plainly
    loop: bool = False  # there and back
    constant_radius: bool = False  # the tube is as thick at all keys as at the one where it is thinnest
    timing: Timing = field(default_factory=Timing)  # that of the keys

    def timed(self, motion: Motion) -> "Playing":
        """Let a curve move about evenly, no faster than can be followed, and rest for a moment before and after."""
        low, high = _FILM
        moving = round(min(max(_FRAMES_PER_SIZE * motion.way, low), high))
        length = (_PAUSE + moving + _END) * (1 + self.loop) + (not self.loop)
        return replace(self, timing=Timing(length=length, hold_start=_PAUSE, hold_end=_END, loop=self.loop))


@dataclass(frozen=True, eq=False)
class Origin:
    """Where a curve's object is put and how it is scaled: x_world = location + scale · x_local."""

    location: FloatArray
    scale: float

    @classmethod
    def of(cls, vertices: FloatArray) -> "Origin":
        """The origin for a curve: neither moved nor scaled if it has everyday size and is near the origin."""
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        size = float((high - low).max())
        near = np.abs(0.5 * (low + high)).max() <= _FAR * size
        scale = 1.0 if _SIZES[0] <= size <= _SIZES[1] else float(2.0 ** np.round(np.log2(size)))
        location = np.zeros(3) if near and scale == 1.0 else (0.5 * (low + high)).astype(np.float32).astype(float)
        return cls(location, scale)

    def link(self, mesh: Mesh) -> Link:
        return Link((Placement(self.scale * np.eye(3), self.location),), (len(mesh.component_sizes),))


def spatial(vertices: FloatArray) -> FloatArray:
    """Vertices of a curve in the plane or in space, shape (n, 3)."""
    return np.pad(vertices, ((0, 0), (0, 3 - vertices.shape[1])))


def check_dimension(curve: Curve) -> None:
    """Raise a MobiusFlowError if a curve is not in the plane or in space."""
    if curve.dimension > 3:
        raise MobiusFlowError(f"the curve has {curve.dimension} coordinates; Blender shows curves in 2 or 3 dimensions")


def recorded(iterates: Sequence[Iterate], measure: Measure = Measure.LENGTH) -> tuple[Motion, Origin]:
    """Collect the iterates of a run in the numbers that Blender will store; raises MobiusFlowError if it cannot.

    ``measure``: what stays constant, see `Motion`.
    """
    start = iterates[0].curve
    check_dimension(start)
    origin = Origin.of(spatial(start.vertices))
    motion = Motion(origin.link(start.mesh), measure=measure)
    for iterate in iterates:
        motion.add(iterate)
    return motion, origin
