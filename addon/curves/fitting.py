"""Tubes fitted to curve objects that are shown together: as thick as they can be without touching."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...core import Curve, CurveError
from ...core.collision import check_embedded
from ...core.messages import Message
from ...core.types import FloatArray
from ..engine.words import in_blenders_words, spline_names
from . import bevel
from .exchange import stretch
from .recorded import Recorded, in_world

if TYPE_CHECKING:
    import bpy


def fit_tubes(objects: Sequence["bpy.types.Object"]) -> float:
    """Fit the bevels of curve objects and return the last radius in the world.

    Where all have the same number of shape keys, tubes are fitted at each of them, and otherwise at the end.

    Raises
    ------
    CurveError
        If their splines cannot be read, or touch themselves or each other at a key: no tube is thin enough then.
    """
    recorded = [Recorded.of(obj) for obj in objects]
    keys = [each.keys for each in recorded]
    if len({len(shapes) for shapes in keys}) > 1:
        keys = [shapes[-1:] for shapes in keys]
    links = [in_world(objects, recorded, shapes) for shapes in zip(*keys, strict=True)]
    splines = spline_names([obj.name for obj in objects], [len(each.mesh.component_sizes) for each in recorded])
    for link in links:
        _check_apart(link, splines)
    radii = np.array([bevel.fitting_radius(link) for link in links])
    for obj in objects:
        _draw(obj.data, radii / stretch(obj))
    return float(radii[-1])


def _check_apart(link: Curve, splines: Sequence[Message]) -> None:
    """Raise a CurveError, which names the splines, if a link touches itself."""
    try:
        check_embedded(link)
    except CurveError as error:
        raise CurveError(in_blenders_words(str(error), splines)) from error


def _draw(data: "bpy.types.Curve", radii: FloatArray) -> None:
    bevel.fit(data, float(radii[-1]))
    for k, block in enumerate(data.shape_keys.key_blocks if data.shape_keys else ()):
        relative = radii[min(k, len(radii) - 1)] / radii[-1]
        block.data.foreach_set("radius", np.full(len(block.data), relative, dtype=np.float32))
    data.update_tag()
