"""Goals: the curve objects that a curve becomes, one after the other, and whose materials it takes on."""

from collections.abc import Sequence

import bpy
import numpy as np

from ...core import Curve, Iterate
from ...core.base import FloatArray
from ...core.keys.key_options import Timing
from ...core.keys.recording import Keys
from .keyframes import CONSTANT, add_keys, there_and_back
from .splines import Reference
from .strands import read_link


class Goals:
    """Curve objects that a curve in the world becomes; raises CurveError if their splines cannot be read.

    ``curves``: what they are in the world, by their names.
    """

    def __init__(self, objects: Sequence[bpy.types.Object], moving: Curve) -> None:
        self.curves: dict[str, Curve] = {}
        there = moving.vertices[moving.mesh.ends]
        for obj in objects:
            goal, _ = read_link([obj])
            ends, vertices = goal.mesh.ends, goal.vertices.copy()
            # move ends that differ only by the rounding to 32 bits exactly onto those of the curve
            same = vertices[ends].shape == there.shape
            if same and np.abs(vertices[ends] - there).max(initial=0.0) <= 1e-6 * moving.length:
                vertices[ends] = there
            self.curves[obj.name] = goal.with_vertices(vertices)
        self._objects = [Reference(obj) for obj in objects]
        # the iterate that reaches each goal, and the goal's spline that each component is then
        self._reached: list[tuple[int, list[int]]] = []

    @property
    def iterates(self) -> list[int]:
        """The numbers of the iterates that have reached a goal."""
        return [index for index, _ in self._reached]

    @property
    def objects(self) -> list[bpy.types.Object]:
        """Those that are still there."""
        return [obj for each in self._objects if (obj := each.get()) is not None]

    def note(self, iterate: Iterate) -> None:
        """Note whether an iterate is the next goal, whatever the order of its components and their vertices."""
        left = list(self.curves.values())[len(self._reached) :]
        both = [each.components for each in (iterate.curve, *left[:1])]
        if iterate.index and left and len({tuple(sorted(map(len, each))) for each in both}) == 1:
            parts, names = ([{tuple(point) for point in part.tolist()} for part in each] for each in both)
            if all(part in names for part in parts):
                self._reached.append((iterate.index, [names.index(part) for part in parts]))

    def paint(self, objects: Sequence[bpy.types.Object], keys: Keys, frames: FloatArray, timing: Timing) -> None:
        """Let the splines of keyed objects change to the materials of each goal at the key that reaches it.

        ``frames``: of the keys. Without an animation splines get the last goal's. Materials that an object has not got
        take slots after its own, so that these are unchanged when they go. Goals that are gone change nothing.
        """
        times = np.interp([0, *self.iterates], [key.time for key in keys.keys], frames)
        splines = [(obj, k, spline) for obj in objects for k, spline in enumerate(obj.data.splines)]
        for number, (obj, k, spline) in enumerate(splines):
            slots = [min(spline.material_index, max(len(obj.material_slots) - 1, 0))]
            for reference, (_, components) in zip(self._objects, self._reached, strict=False):
                slots.append(slots[-1])
                goal = reference.get()
                there = goal.data.splines if goal is not None and goal.type == "CURVE" else ()
                if components[number] < len(there):
                    # a curve without slots is drawn in Blender's own material, which then takes the first
                    own, worn = ([each.material for each in one.material_slots] or [None] for one in (obj, goal))
                    material = worn[min(there[components[number]].material_index, len(worn) - 1)]
                    if own[slots[-1]] == material:
                        continue
                    for new in [*([] if obj.material_slots else [None]), *([] if material in own else [material])]:
                        obj.data.materials.append(new)
                    slots[-1] = [*own, material].index(material)
            if len(frames) == 1:
                spline.material_index = slots[-1]
            elif len(set(slots)) > 1:
                keyed = there_and_back(times, np.array(slots, dtype=np.float64), timing)
                add_keys(obj.data, f"{obj.name} Materials", f"splines[{k}].material_index", 0, *keyed, CONSTANT)

    def hide(self, objects: Sequence[bpy.types.Object]) -> None:
        """Hide the goals that objects have reached, since both would flicker in one place, and leave those selected."""
        for goal, _ in zip(self._objects, self._reached, strict=False):
            if (obj := goal.get()) is not None and obj.name in bpy.context.view_layer.objects:
                obj.hide_set(True)
                obj.hide_render = True
        if self._reached and objects:
            objects[0].select_set(True)
            bpy.context.view_layer.objects.active = objects[0]
