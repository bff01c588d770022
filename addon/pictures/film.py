"""An empty scene filled with a relaxation: the keyed curve as a tube, and a stage around it."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from ...core import Curve, Iterate, MobiusFlowError
from ...core.curve import Mesh
from ...core.types import FloatArray
from ..curves import keyframes
from ..curves.exchange import new_curve_data
from ..curves.fcurves import all_fcurves, mirror
from ..engine.key_options import Output, Timing
from ..engine.motion import Keys, Motion
from ..engine.placement import Frame, Link, Placement
from ..engine.rounded import tube_radii
from ..engine.size import Measure
from . import camera, stage
from .looks import DEFAULT, LOOKS
from .materials import colour_components

if TYPE_CHECKING:
    import bpy

_BEVEL_RESOLUTION = 5
_FRAMES_PER_SIZE = 20  # in which the fastest vertex goes as far as the curve is wide
_FILM = (72, 720)  # frames in motion, at least and at most
_PAUSE = 6  # frames at rest before the motion begins
_END = 12  # frames at rest after it
_FAR = 8.0  # a curve further from the origin, in its own sizes, gets its own origin: 32 bits are few
_SIZES = (1e-3, 1e3)  # between these Blender works well


@dataclass(frozen=True)
class Playing:
    """How a relaxation is played in a scene or a film."""

    look: str | None = None  # one of `LOOKS`; None: the default one, and films drawn plainly
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
        """None of both for a curve of everyday size near the origin."""
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

    ``measure`` is what stays as it is, see `Motion`.
    """
    start = iterates[0].curve
    check_dimension(start)
    origin = Origin.of(spatial(start.vertices))
    motion = Motion(origin.link(start.mesh), measure=measure)
    for iterate in iterates:
        motion.add(iterate)
    return motion, origin


def compose(
    scene: "bpy.types.Scene", keys: Keys, frames: FloatArray, mesh: Mesh, playing: Playing, origin: Origin | None = None
) -> None:
    """Put a keyed curve on a look's stage, by default near the scene's origin, and fit the scene's frames to it."""
    import bpy

    points, look = [key.points for key in keys.keys], playing.look or DEFAULT
    radii = tube_radii(mesh, [each.astype(np.float64) for each in points], frames)
    radii = np.full_like(radii, radii.min()) if playing.constant_radius else radii
    data = new_curve_data("Curve", mesh)
    data.bevel_depth, data.bevel_resolution = float(radii.max()), _BEVEL_RESOLUTION
    data.use_fill_caps = True  # at the ends of arcs
    obj = stage.add(scene.collection, "Curve", data)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    output = Output.SHAPE_KEYS if len(points) > 1 else Output.RESULT
    for _ in keyframes.writing(obj, keys, frames, output, radii / radii.max()):
        pass
    alone = len(mesh.component_sizes) == 1
    colour_components(data, look=look, along=_mean_shares(mesh, points) if alone else None)
    ground = stage.Stage.around(points, stage.flat_up(points[-1].astype(np.float64)))
    size = scene.render.resolution_x, scene.render.resolution_y
    floor = stage.build(scene.collection, ground, LOOKS[look])
    scene.camera = camera.follow(scene.collection, size, ground, floor, points, radii.max(axis=1), frames)
    if playing.timing.loop:
        for curve in all_fcurves():
            mirror(curve, frames[-1] + playing.timing.hold_end)
    scene.world = scene.world or bpy.data.worlds.new("World")
    stage.add_sky(scene.world, LOOKS[look])
    stage.light_workbench(scene, stage.towards_key(ground, LOOKS[look]))
    if origin is not None:
        _put(scene, origin)
    scene.frame_start, scene.frame_end = round(frames[0]), int(np.ceil(frames[-1]))
    scene.frame_set(scene.frame_start)


def _mean_shares(mesh: Mesh, points: Sequence[Frame]) -> FloatArray:
    """The share of the length at each vertex of a closed or open component, and at its end; the mean of all keys."""
    lengths = np.array([Curve(each.astype(np.float64), mesh).edge_lengths for each in points])
    passed = np.cumsum((lengths / lengths.sum(axis=1, keepdims=True)).mean(axis=0))
    return np.concatenate([[0.0], passed / passed[-1]])


def _put(scene: "bpy.types.Scene", origin: Origin) -> None:
    """Move and scale everything in a scene from the curve's coordinates to the world's."""
    if origin.scale == 1.0 and not origin.location.any():
        return
    objects = list(scene.objects)
    root = stage.add(scene.collection, "Stage", None)
    root.location, root.scale = origin.location, 3 * [origin.scale]
    for obj in objects:
        obj.parent = root
        if obj.type == "LIGHT":
            obj.data.energy *= origin.scale**2
        elif obj.type == "CAMERA":
            obj.data.clip_start *= origin.scale
            obj.data.clip_end *= origin.scale
            obj.data.dof.aperture_fstop /= origin.scale
