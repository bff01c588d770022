"""Blends: materials that change into others, keyed like the motion of their wearer, and goals, which cause them.

A blend is a copy of a material whose tree also holds the nodes of the others, with keyed shares of their shaders:
a material like any other, which is shown and rendered everywhere. It takes a slot after those that the curve data
has, so that these are unchanged when it goes.
"""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from typing import Any

import bpy
import numpy as np

from ...core import Curve, Iterate
from ...core.types import FloatArray
from ..engine.key_options import Timing
from ..engine.motion import Keys
from .exchange import Reference, read_link
from .keyframes import FCurves, own_action

_SLOT = "mobius_flow_slot"  # custom property of blends: the slot that splines had before
_SHADERS = ("Surface", "Volume")  # inputs of a material's output that can be mixed
_FLAT = ("diffuse_color", "metallic", "roughness")  # what Solid shading shows
_LOOKS = ("name", "label", "width", "mute", "hide")
_NEAR = 1e-6  # lengths of a curve: places that are stored in 32 bits are as far apart


def worn(obj: bpy.types.Object, spline: bpy.types.Spline) -> bpy.types.Material | None:
    """The material that a spline is drawn in; None for Blender's own."""
    slots = obj.material_slots
    return slots[min(spline.material_index, len(slots) - 1)].material if slots else None


def put_on(data: bpy.types.Curve, spline: bpy.types.Spline, material: bpy.types.Material | None) -> None:
    """Let a spline be drawn in a material, which gets a slot after the existing ones unless it has one."""
    if material not in list(data.materials):
        data.materials.append(material)
    spline.material_index = list(data.materials).index(material)


def take_off(data: bpy.types.Curve) -> None:
    """Give splines back the slots that they had before they wore blends, and remove the blends' slots."""
    slots = [None if each is None else each.get(_SLOT) for each in data.materials]
    for spline in data.splines:
        if spline.material_index < len(slots) and slots[spline.material_index] is not None:
            spline.material_index = slots[spline.material_index]
    for number in reversed([number for number, slot in enumerate(slots) if slot is not None]):
        blend = data.materials.pop(index=number)
        if not blend.users:
            actions = [owner.animation_data.action for owner in (blend, blend.node_tree) if owner.animation_data]
            bpy.data.batch_remove([blend, *(each for each in actions if each is not None and each.users == 1)])


def blend(
    materials: Sequence[bpy.types.Material | None], slot: int, frames: FloatArray, timing: Timing
) -> bpy.types.Material:
    """A material that is each of some at its own frame, ascending, (materials,); ``slot``: what `take_off` restores."""
    plain = bpy.data.materials.new("Default")
    chain = [each or plain for each in materials]
    for each in chain:
        if each.node_tree is None:  # from Blender 5.0 on there is one from the start, and the switch is deprecated
            each.use_nodes = True
    made = chain[0].copy()
    made.name, made[_SLOT] = " to ".join(each.name for each in chain), slot
    back = timing.way_back(frames)

    def key(block: bpy.types.ID, path: str, axis: int, values: FloatArray) -> None:
        there = np.concatenate([values, values[::-1][len(values) - len(back) :]])
        FCurves(block, f"{made.name} Colors").add(path, axis, np.concatenate([frames, back]), there)

    for block in (made, made.node_tree):
        if block.animation_data is not None and block.animation_data.action is not None:
            own_action(block)
    for name in _FLAT:
        values = np.array([getattr(each, name) for each in chain]).reshape(len(chain), -1)
        for axis in np.flatnonzero(np.ptp(values, axis=0)):
            key(made, name, int(axis), values[:, axis])
    for number, other in enumerate(chain[1:], 1):
        for path in _mix(made.node_tree, other.node_tree, f"To {other.name}"):
            key(made.node_tree, path, 0, (np.arange(len(chain)) >= number).astype(np.float64))
    bpy.data.materials.remove(plain)
    return made


def _mix(tree: bpy.types.NodeTree, other: bpy.types.NodeTree, name: str) -> list[str]:
    """Mix another tree's shaders into those of one; return where the tree keeps the shares of the other's shaders."""
    output, copies, paths = tree.get_output_node("ALL"), copied(other, tree), []
    theirs = copies.get(other.get_output_node("ALL"))
    for socket in _SHADERS:
        ends = [node.inputs[socket] for node in (output, theirs) if node is not None]
        if output is None or not any(end.is_linked for end in ends):
            continue
        mix = tree.nodes.new("ShaderNodeMixShader")
        mix.name, mix.location = f"{name} {socket}", (output.location[0], output.location[1] + 200)
        for end, entry in zip(ends, mix.inputs[1:], strict=False):
            if end.is_linked:
                tree.links.new(end.links[0].from_socket, entry)
        tree.links.new(mix.outputs[0], output.inputs[socket])
        paths.append(f'nodes["{mix.name}"].inputs[0].default_value')
    for copy in copies.values():
        if copy.type == "OUTPUT_MATERIAL":
            tree.nodes.remove(copy)
    return paths


def copied(source: bpy.types.NodeTree, tree: bpy.types.NodeTree) -> dict[bpy.types.Node, bpy.types.Node]:
    """Copy all nodes of a tree, with their links, into another one; return the copy of each.

    Kinds of nodes that no running extension knows are left out: they do nothing.
    """
    known = [node for node in source.nodes if hasattr(bpy.types, node.bl_idname)]
    copies = {node: tree.nodes.new(node.bl_idname) for node in known}
    common = _settings(bpy.types.Node)
    for node, copy in copies.items():
        _imitate(node, copy, [*_LOOKS, *(each for each in _settings(node) if each not in common)])
        for side in ("inputs", "outputs"):
            for one, other in zip(getattr(node, side), getattr(copy, side), strict=False):
                _imitate(one, other, ["default_value"])
    for node, copy in copies.items():
        copy.parent = copies.get(node.parent)
        copy.location = node.location  # which is relative to the parent's
    for link in source.links:
        if link.from_node in copies and link.to_node in copies:
            start = list(link.from_node.outputs).index(link.from_socket)
            end = list(link.to_node.inputs).index(link.to_socket)
            tree.links.new(copies[link.from_node].outputs[start], copies[link.to_node].inputs[end])
    return copies


def _settings(owner: Any) -> list[str]:
    return [prop.identifier for prop in owner.bl_rna.properties]


def _imitate(one: Any, other: Any, names: Iterable[str]) -> None:
    """Copy some settings of a thing to another of its kind, with the ramps and curves in them."""
    for name in names:
        value, prop = getattr(one, name, None), one.bl_rna.properties.get(name)
        if prop is None or name == "rna_type":
            continue
        if not prop.is_readonly:
            with suppress(TypeError, ValueError):  # what another setting rules out
                setattr(other, name, value)
        elif name in ("elements", "curves", "points"):
            _imitate_all(value, getattr(other, name))
        elif prop.type == "POINTER" and value is not None:
            _imitate(value, getattr(other, name), _settings(value))
    if hasattr(other, "initialize"):  # curves are tables, made when they change
        other.update()


def _imitate_all(parts: Any, others: Any) -> None:
    """The same for the stops of a color ramp, and for curves and their points."""
    while len(others) > len(parts):
        others.remove(others[-1])
    for k, part in enumerate(parts):
        if k == len(others):
            others.new(*(part.location if hasattr(part, "location") else (part.position,)))
        _imitate(part, others[k], _settings(part))


class Goals:
    """Curve objects that a curve in the world becomes; raises CurveError if their splines cannot be read.

    ``curves``: what they are in the world, by their names.
    """

    def __init__(self, objects: Sequence[bpy.types.Object], moving: Curve) -> None:
        self.curves = {obj.name: _held(read_link([obj])[0], moving) for obj in objects}
        self._objects = [Reference(obj) for obj in objects]
        # the iterate that reaches each goal, and the goal's spline that each component is then
        self._reached: list[tuple[int, list[int]]] = []

    def note(self, iterate: Iterate) -> None:
        left = list(self.curves.values())[len(self._reached) :]
        if left and iterate.index and (components := _components(iterate.curve, left[0])):
            self._reached.append((iterate.index, components))

    def paint(self, objects: Sequence[bpy.types.Object], keys: Keys, frames: FloatArray, timing: Timing) -> None:
        """Let the splines of keyed objects take on the materials of the goals on the way there.

        ``frames``: of the keys. Without an animation splines get the last goal's. Goals that are gone change nothing.
        """
        times = np.interp([0, *(index for index, _ in self._reached)], [key.time for key in keys.keys], frames)
        made: dict[object, bpy.types.Material] = {}
        splines = [(obj, spline) for obj in objects for spline in obj.data.splines]
        for number, (obj, spline) in enumerate(splines):
            chain = [worn(obj, spline)]
            for goal, (_, components) in zip(self._objects, self._reached, strict=False):
                chain.append(_material(goal.get(), components[number], chain[-1]))
            if all(each == chain[0] for each in chain):
                continue
            which = obj.name, spline.material_index, *chain
            if len(frames) == 1:
                made[which] = chain[-1]
            elif which not in made:
                made[which] = blend(chain, spline.material_index, times, timing)
            put_on(obj.data, spline, made[which])


def _held(goal: Curve, moving: Curve) -> Curve:
    """A goal, with its ends moved exactly onto those of another curve if they differ only by Blender's rounding."""
    ends, there = goal.mesh.ends, moving.vertices[moving.mesh.ends]
    vertices = goal.vertices.copy()
    if vertices[ends].shape != there.shape or np.abs(vertices[ends] - there).max(initial=0.0) > _NEAR * moving.length:
        return goal
    vertices[ends] = there
    return goal.with_vertices(vertices)


def _material(
    goal: bpy.types.Object | None, spline: int, before: bpy.types.Material | None
) -> bpy.types.Material | None:
    """The material of one of a goal's splines, or the one before if that spline is gone."""
    if goal is None or goal.type != "CURVE" or spline >= len(goal.data.splines):
        return before
    return worn(goal, goal.data.splines[spline])


def _components(curve: Curve, goal: Curve) -> list[int]:
    """The goal's component that each component of a curve is, whatever its order of vertices; empty if it is not."""
    if sorted(curve.mesh.component_sizes) != sorted(goal.mesh.component_sizes):
        return []
    names = [{tuple(point) for point in part.tolist()} for part in goal.components]
    parts = [{tuple(point) for point in part.tolist()} for part in curve.components]
    return [names.index(part) for part in parts] if all(part in names for part in parts) else []
