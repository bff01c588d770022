"""The tube drawn around curve objects: as thick as it can be without touching.

A bevel belongs to the artist until somebody asks to have it fitted. Fitted depths are recorded on the curve data. A
curve with one of these depths, even one that undo or *Clear* has brought back, is fitted again when it is relaxed; a
curve whose depth has been changed since has a bevel of the artist's own.
"""

from collections.abc import Sequence

import bpy
import numpy as np

from ...core import Curve, Obstacle
from ...core.base import FloatArray
from ...core.keys.tube import free_radius, radius_beside, thickest_radius
from . import bake
from .recorded import Recorded, drawn_radius, in_world
from .sizes import placement
from .splines import SOURCE, radii

_FITTED = "mobius_flow_tube"  # custom property of curve data: depths that were fitted
_CONSTANT = "mobius_flow_tube_constant"  # another one: whether they were fitted to be as thick at all keys


def can_fit(data: bpy.types.Curve) -> bool:
    """Whether a curve is drawn as a line or a plain round tube; any other shape is the user's own."""
    plain = data.bevel_mode == "ROUND" and data.taper_object is None and not data.extrude and not data.offset
    return SOURCE not in data and plain and all((radii(spline) == 1).all() for spline in data.splines)


def is_fitted(data: bpy.types.Curve) -> bool:
    """Whether a curve is drawn as the tube that was fitted to it."""
    return data.bevel_depth in list(data.get(_FITTED, ()))


def is_constant(data: bpy.types.Curve) -> bool:
    """Whether a curve is drawn as a tube that was fitted to all its keys, and is as thick at each of them."""
    return bool(is_fitted(data) and data.get(_CONSTANT))


def fitting_radius(curve: Curve, obstacles: Sequence[Obstacle] = ()) -> float:
    """The largest radius that is free of contact, but not so large that the tube no longer looks like a curve."""
    return radius_beside(curve, free_radius(curve, thickest_radius(curve)), obstacles)


def own_radii(objects: Sequence[bpy.types.Object]) -> tuple[float, ...]:
    """Radius of the artist's bevel around each spline, in the world; empty if there is none around some of them."""
    own = [
        0.0 if is_fitted(obj.data) else drawn_radius(obj) * float(radii(spline).max())
        for obj in objects
        for spline in obj.data.splines
    ]
    return tuple(own) if min(own) > 0.0 else ()


def fit(data: bpy.types.Curve, radius: float, constant: bool | None = None) -> None:
    """Draw a curve as the tube that fits, and note that it is one; ``constant``: whether it was fitted to all keys."""
    draw(data, radius)
    data[_FITTED] = sorted({*data.get(_FITTED, ()), data.bevel_depth})
    if constant is not None:
        data[_CONSTANT] = constant


def rope_radii(objects: Sequence[bpy.types.Object]) -> FloatArray:
    """Radius at each key, in the world, of the rope that objects were baked as together; empty if they are none."""
    ropes = np.array([bake.rope(obj.data) * placement(obj).stretch for obj in objects])
    if not (ropes.min() > 0.0 and np.ptp(ropes) <= 1e-6 * ropes.min()):
        return np.empty(0)
    return float(ropes.min()) * np.array([size.factor for size in bake.sizes(objects[0].data)])


def draw(data: bpy.types.Curve, radius: float) -> None:
    if not data.bevel_depth:
        data.bevel_resolution, data.use_fill_caps = 6, True  # caps, which closed splines do not need
    data.bevel_depth = radius


def fit_tubes(objects: Sequence[bpy.types.Object], constant: bool = False) -> None:
    """Fit the bevels of curve objects that are shown together; ``constant``: as thick at all keys as where it is least.

    Where all have the same number of shape keys, tubes are fitted at each of them, and otherwise at the end. Those that
    were baked together are drawn as the rope that they are. Raises CurveError if their splines cannot be read, or touch
    at a key: no tube is thin enough then.
    """
    recorded = [Recorded.of(obj) for obj in objects]
    keys = [each.keys for each in recorded]
    if len({len(shapes) for shapes in keys}) > 1:
        keys = [shapes[-1:] for shapes in keys]
    links = [in_world(objects, recorded, shapes) for shapes in zip(*keys, strict=True)]
    rope = rope_radii(objects)
    fitting = rope[-len(links) :] if len(rope) else np.array([fitting_radius(link) for link in links])
    fitting = np.full_like(fitting, fitting.min()) if constant else fitting
    for obj in objects:
        data, wanted = obj.data, fitting / placement(obj).stretch
        wanted = wanted / [size.factor for size in bake.sizes(data)]  # which the tube is shown in too
        fit(data, float(wanted[-1]), constant)
        for k, block in enumerate(data.shape_keys.key_blocks if data.shape_keys else ()):
            relative = wanted[min(k, len(wanted) - 1)] / wanted[-1]
            block.data.foreach_set("radius", np.full(len(block.data), relative, dtype=np.float32))
        data.update_tag()
