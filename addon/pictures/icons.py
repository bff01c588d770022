"""Icons of the table's knots, drawn when they are first asked for."""

from functools import cache

import bpy
import bpy.utils.previews
import numpy as np

from ...core.knots import smooth_knot
from ...core.types import FloatArray
from ..engine.knot_list import thumbnail
from ..engine.placement import Frame

_ICON, _IMAGE = 32, 96  # pixels, in menus and in galleries


def icon(name: str) -> int:
    """Number of the icon of a knot of the table; 0, which is no icon, where Blender has no window."""
    drawn = _drawn()
    if name not in drawn:
        preview, curve = drawn.new(name), smooth_knot(name)
        preview.icon_size, preview.image_size = (_ICON, _ICON), (_IMAGE, _IMAGE)
        preview.icon_pixels_float.foreach_set(_pixels(thumbnail(curve, _ICON)))
        preview.image_pixels_float.foreach_set(_pixels(thumbnail(curve, _IMAGE)))
    return int(drawn[name].icon_id)


def forget() -> None:
    """Remove all icons: Blender does not do so by itself."""
    if _drawn.cache_info().currsize:
        bpy.utils.previews.remove(_drawn())
        _drawn.cache_clear()


@cache
def _drawn() -> bpy.utils.previews.ImagePreviewCollection:
    return bpy.utils.previews.new()


def _pixels(picture: FloatArray) -> Frame:
    return picture.astype(np.float32).ravel()
