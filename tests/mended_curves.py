"""Curves that are refused, and what takes that out of the way."""

import bpy
from blender_scenes import add_curve
from mobius_flow.addon.live.requirements import RELAXABLE, Remedy
from shapes import torus_trefoil

SHAPE = torus_trefoil(12).vertices


def call(remedy: Remedy) -> set[str]:
    return set(bpy.ops.curve.mobius_flow_mend(remedy=remedy.name))


def mend(remedy: Remedy) -> None:
    """See that it is this remedy that is offered next, and take it."""
    bpy.context.view_layer.update()
    assert RELAXABLE(bpy.context).remedy is remedy
    assert call(remedy) == {"FINISHED"}
    bpy.context.view_layer.update()


def may_be_relaxed() -> None:
    bpy.context.view_layer.update()
    assert RELAXABLE(bpy.context) is None
    assert bpy.ops.curve.mobius_flow_relax(max_iterations=1, sample_splines=True) == {"FINISHED"}


def two(**options: object) -> list[bpy.types.Object]:
    """Two selected curves side by side."""
    return [add_curve([SHAPE + shift], name, **options) for name, shift in (("A", 0), ("B", 9))]


def with_material(obj: bpy.types.Object) -> bpy.types.Object:
    obj.data.materials.append(bpy.data.materials.new("Gold"))
    return obj
