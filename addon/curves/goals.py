"""What curves become in a morph, one after the other: where they pass by, and the materials that they take on there."""

from collections.abc import Sequence

import bpy
import numpy as np

from ...core import Curve, Iterate
from ...core.types import FloatArray
from ..engine.key_options import Timing
from ..engine.motion import Keys
from . import blends
from .exchange import read_link
from .reference import Reference

_NEAR = 1e-6  # lengths of a curve: places that are stored in 32 bits are as far apart


class Goals:
    """Curve objects that a curve in the world becomes; raises CurveError if their splines cannot be read.

    ``curves``: what they are in the world, by their names.
    """

    def __init__(self, objects: Sequence[bpy.types.Object], moving: Curve) -> None:
        self.curves = {obj.name: _held(read_link([obj])[0], moving) for obj in objects}
        self._objects = [Reference(obj) for obj in objects]
        # the iterate in which each is reached, and which of its splines each component is then
        self._reached: list[tuple[int, list[int]]] = []

    def note(self, iterate: Iterate) -> None:
        """Note it if an iterate is the next of them."""
        left = list(self.curves.values())[len(self._reached) :]
        if left and iterate.index and (components := _components(iterate.curve, left[0])):
            self._reached.append((iterate.index, components))

    def paint(self, objects: Sequence[bpy.types.Object], keys: Keys, frames: FloatArray, timing: Timing) -> None:
        """Let the splines of keyed objects take on the materials of the goals on the way there.

        ``frames``: those of the keys. Without an animation they have the last one's. Goals that are gone change none.
        """
        times = np.interp([0, *(index for index, _ in self._reached)], [key.time for key in keys.keys], frames)
        made: dict[object, bpy.types.Material] = {}
        splines = [(obj, spline) for obj in objects for spline in obj.data.splines]
        for number, (obj, spline) in enumerate(splines):
            chain = [blends.worn(obj, spline)]
            for goal, (_, components) in zip(self._objects, self._reached, strict=False):
                chain.append(_material(goal.get(), components[number], chain[-1]))
            if all(each == chain[0] for each in chain):
                continue
            which = obj.name, spline.material_index, *chain
            if len(frames) == 1:
                made[which] = chain[-1]
            elif which not in made:
                made[which] = blends.blend(chain, spline.material_index, times, timing)
            blends.put_on(obj.data, spline, made[which])


def _held(goal: Curve, moving: Curve) -> Curve:
    """A goal whose ends are exactly where those of another curve are if they are there but for Blender's rounding."""
    ends, there = goal.mesh.ends, moving.vertices[moving.mesh.ends]
    vertices = goal.vertices.copy()
    if vertices[ends].shape != there.shape or np.abs(vertices[ends] - there).max(initial=0.0) > _NEAR * moving.length:
        return goal
    vertices[ends] = there
    return goal.with_vertices(vertices)


def _material(
    goal: bpy.types.Object | None, spline: int, before: bpy.types.Material | None
) -> bpy.types.Material | None:
    """The material of one of a goal's splines; that before if there is no such spline any more."""
    if goal is None or goal.type != "CURVE" or spline >= len(goal.data.splines):
        return before
    return blends.worn(goal, goal.data.splines[spline])


def _components(curve: Curve, goal: Curve) -> list[int]:
    """The component of the goal that each of a curve is, whose vertices may have another order; empty if it is not."""
    if sorted(curve.mesh.component_sizes) != sorted(goal.mesh.component_sizes):
        return []
    names = [{tuple(point) for point in part.tolist()} for part in goal.components]
    parts = [{tuple(point) for point in part.tolist()} for part in curve.components]
    return [names.index(part) for part in parts] if all(part in names for part in parts) else []
