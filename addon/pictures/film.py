"""An empty scene filled with a relaxation: the keyed curve as a tube, and a stage around it."""

from pathlib import Path

import bpy
import numpy as np

from ...core import Curve
from ...core.base.types import FloatArray
from ...core.curve import Mesh
from ...core.keys.key_options import Output
from ...core.keys.motion import Keys, Playing
from ...core.keys.placement import Origin
from ...core.keys.tube import tube_radii
from ..curves import keyframes
from ..curves.keyframes import all_fcurves, mirror
from ..curves.splines import new_curve_data
from . import rendering, stage
from .looks import DEFAULT, LOOKS
from .materials import bundled, colour_components


def empty_scene() -> bpy.types.Scene:
    """An empty factory scene, which replaces what is open in Blender."""
    with rendering.quiet():
        bpy.ops.wm.read_factory_settings(use_empty=True)
    return bpy.context.scene


def save(path: Path) -> None:
    with rendering.quiet():
        bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=True)


def compose(
    scene: bpy.types.Scene,
    keys: Keys,
    frames: FloatArray,
    mesh: Mesh,
    playing: Playing,
    origin: Origin | None = None,
    cut_out: bool = False,
) -> None:
    """Put a keyed curve on a look's stage, by default near the scene's origin, and fit the scene's frames to it.

    ``cut_out``: it is seen down the third axis, and nothing of the floor is in the picture but shadows.
    """
    points, look = [key.points for key in keys.keys], playing.look or DEFAULT
    radii = tube_radii(mesh, [each.astype(np.float64) for each in points], frames)
    radii = np.full_like(radii, radii.min()) if playing.constant_radius else radii
    data = new_curve_data("Curve", mesh)
    data.bevel_depth, data.bevel_resolution = float(radii.max()), 5
    data.use_fill_caps = True  # at the ends of arcs
    obj = stage.add(scene.collection, "Curve", data)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    output = Output.SHAPE_KEYS if len(points) > 1 else Output.RESULT
    for _ in keyframes.writing(obj, keys, frames, output, radii / radii.max()):
        pass
    along = None
    if len(mesh.component_sizes) == 1:
        # the share of the length at each vertex, and at its end; the mean of all keys
        lengths = np.array([Curve(each.astype(np.float64), mesh).edge_lengths for each in points])
        passed = np.cumsum((lengths / lengths.sum(axis=1, keepdims=True)).mean(axis=0))
        along = np.concatenate([[0.0], passed / passed[-1]])
    colour_components(data, look=look, along=along)
    # up is where the last shape extends least, rather up than down
    least = np.linalg.svd(points[-1] - points[-1].mean(axis=0, dtype=np.float64), full_matrices=False)[2][2]
    ground = stage.Stage.around(points, None if cut_out else least * np.sign(least[np.abs(least).argmax()]))
    size = scene.render.resolution_x, scene.render.resolution_y
    floor = stage.build(scene.collection, ground, LOOKS[look])
    floor.is_shadow_catcher = scene.render.film_transparent = cut_out
    scene.camera = stage.follow(scene.collection, size, ground, floor, points, radii.max(axis=1), frames)
    if playing.timing.loop:
        for curve in all_fcurves():
            mirror(curve, frames[-1] + playing.timing.hold_end)
    scene.world = bundled("worlds", LOOKS[look].label)
    scene.world.name = "World"
    key = next(each for each in scene.collection.objects if each.type == "LIGHT")
    stage.light_workbench(scene, key.matrix_world.col[2][:3])
    if origin is not None and (origin.scale != 1.0 or origin.location.any()):
        # move and scale everything from the curve's coordinates to the world's
        objects = list(scene.objects)
        root = stage.add(scene.collection, "Stage", None)
        root.location, root.scale = origin.location, 3 * [origin.scale]
        for each in objects:
            each.parent = root
            if each.type == "LIGHT":
                each.data.energy *= origin.scale**2
            elif each.type == "CAMERA":
                each.data.clip_start *= origin.scale
                each.data.clip_end *= origin.scale
                each.data.dof.aperture_fstop /= origin.scale
    scene.frame_start, scene.frame_end = round(frames[0]), int(np.ceil(frames[-1]))
    scene.frame_set(scene.frame_start)
