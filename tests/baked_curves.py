"""Curves that are baked, again, further and no more, and what is left of the keys."""

from pathlib import Path

import bpy
import numpy as np
from blender_scenes import add_curve, add_hopf_link, fcurves, stored

SHORT = {"max_iterations": 5, "fit_bevel": False}


def again(**options: object) -> None:
    assert bpy.ops.curve.mobius_flow_bake_again(**SHORT | options) == {"FINISHED"}


def go_on(**options: object) -> None:
    assert bpy.ops.curve.mobius_flow_continue(**SHORT | options) == {"FINISHED"}


def clear() -> None:
    assert bpy.ops.curve.mobius_flow_clear() == {"FINISHED"}


def reopen(path: Path) -> bpy.types.Object:
    """Save the file, close it, open it again, and select what was selected."""
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return bpy.context.object


def blocks() -> list[list[str]]:
    """Names of all there is that keys are made of."""
    return [sorted(block.name for block in each) for each in (bpy.data.curves, bpy.data.shape_keys, bpy.data.actions)]


def last_frame(obj: bpy.types.Object) -> float:
    return float(curve_of(obj).keyframe_points[-1].co[0])


def curve_of(obj: bpy.types.Object) -> bpy.types.FCurve:
    (curve,) = fcurves(obj.data.shape_keys)
    return curve


def two_rings() -> list[bpy.types.Object]:
    vertices = add_hopf_link(24)
    points = stored(vertices.data)
    bpy.data.objects.remove(vertices)
    for block in (*bpy.data.curves,):
        bpy.data.curves.remove(block)
    pair = [add_curve([part], name) for part, name in zip(np.split(points, 2), "AB", strict=True)]
    pair[1].location.x = 0.25
    pair[0].rotation_euler.z = 0.5
    bpy.context.view_layer.update()
    return pair
