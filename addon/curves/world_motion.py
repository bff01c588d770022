"""Where curve objects are in the world while their animation plays, and how thick they are drawn."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...core.types import FloatArray
from ..engine.placement import Placement
from .exchange import stretch
from .moving import what_moves
from .recorded import Recorded

if TYPE_CHECKING:
    import bpy


@dataclass(frozen=True, eq=False)
class WorldMotion:
    """Several curve objects in time; between its frames points move straight, or nearly so where something moves them.

    Attributes
    ----------
    frames
        Ascending scene frames; (frames,).
    points
        Points of all objects at each of them; (n, 3).
    radii
        Radius of the thickest tube at each of them; (frames,).
    """

    frames: FloatArray
    points: list[FloatArray]
    radii: FloatArray

    @classmethod
    def of(cls, scene: "bpy.types.Scene", objects: Sequence["bpy.types.Object"]) -> "WorldMotion":
        """Look at curve objects at all their keys; where something moves them, at all frames of the scene too.

        Modifiers are not looked at. Raises CurveError if splines cannot be read.
        """
        recorded = [Recorded.of(obj) for obj in objects]
        moving = any(what_moves(obj) for obj in objects)
        frames = _frames(scene, recorded, moving)
        placements = _placements(scene, objects, frames if moving else frames[:1])
        points, radii = [], []
        for obj, each in zip(objects, recorded, strict=True):
            stored, thickness = _at(each.frames, each.points, frames), _at(each.frames, each.radii, frames)
            there = placements[obj.name] if moving else placements[obj.name] * len(frames)
            points.append([place.to_world(shape) for place, shape in zip(there, stored, strict=True)])
            radii.append(drawn_radius(obj) * thickness.max(axis=1))
        return cls(frames, [np.concatenate(shapes) for shapes in zip(*points, strict=True)], np.max(radii, axis=0))


def _frames(scene: "bpy.types.Scene", recorded: Sequence[Recorded], moving: bool) -> FloatArray:
    keyed = [each.frames for each in recorded if len(each.frames) > 1]
    every = [np.arange(scene.frame_start, scene.frame_end + 1, dtype=np.float64)] if moving else []
    return np.unique(np.concatenate([*keyed, *every])) if keyed or every else np.array([float(scene.frame_start)])


def _at(frames: FloatArray, values: FloatArray, wanted: FloatArray) -> FloatArray:
    """Values that are known at some frames, linear in between and constant outside, at others; (wanted, ...)."""
    place = np.interp(wanted, frames, np.arange(len(frames)))
    before = place.astype(np.intp)
    after = np.minimum(before + 1, len(frames) - 1)
    share = (place - before).reshape(-1, *[1] * (values.ndim - 1))
    return np.asarray((1 - share) * values[before] + share * values[after])


def _placements(
    scene: "bpy.types.Scene", objects: Sequence["bpy.types.Object"], frames: FloatArray
) -> dict[str, list[Placement]]:
    """Places of objects by their names, at each of some frames; at a single one as they are now."""
    found: dict[str, list[Placement]] = {obj.name: [] for obj in objects}
    with frame_kept(scene):
        for frame in frames:
            if len(frames) > 1:
                scene.frame_set(int(frame // 1), subframe=float(frame % 1))
            for obj in objects:
                found[obj.name].append(Placement.from_matrix(obj.matrix_world))
    return found


@contextmanager
def frame_kept(scene: "bpy.types.Scene") -> Iterator[None]:
    """Put a scene's frame back at the end."""
    frame, subframe = scene.frame_current, scene.frame_subframe
    try:
        yield
    finally:
        if (scene.frame_current, scene.frame_subframe) != (frame, subframe):
            scene.frame_set(frame, subframe=subframe)


def drawn_radius(obj: "bpy.types.Object") -> float:
    """How far what is drawn around an object's curve reaches from it where the radius is 1, in the world."""
    data = obj.data
    return float((data.bevel_depth + data.extrude + abs(data.offset)) * stretch(obj))
