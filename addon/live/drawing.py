"""Lines, areas and text on the screen, in pixels of a region."""

import blf
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from ...core.types import FloatArray
from ..engine.colours import Colour

_FONT = 0  # Blender's own


def area(low: tuple[float, float], high: tuple[float, float], colour: Colour) -> None:
    """Fill a rectangle, given by two corners; the colour has an alpha."""
    (x0, y0), (x1, y1) = low, high
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    gpu.state.blend_set("ALPHA")
    shader.uniform_float("color", tuple(colour))
    batch_for_shader(shader, "TRI_FAN", {"pos": [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]}).draw(shader)
    gpu.state.blend_set("NONE")


def line(points: FloatArray, colour: Colour, width: float, kind: str = "LINE_STRIP") -> None:
    """Draw a line through points, (k, 2), or a line for every pair of them (``LINES``); ``width`` in pixels."""
    if len(points) < 2:
        return
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    gpu.state.blend_set("ALPHA")
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width)
    shader.uniform_float("color", (*colour[:3], 1.0))
    corners = np.pad(np.asarray(points, dtype=np.float32), ((0, 0), (0, 1)))
    batch_for_shader(shader, kind, {"pos": corners}).draw(shader)
    gpu.state.blend_set("NONE")


def text(words: str, place: tuple[float, float], colour: Colour, size: float, share: float = 0.0) -> None:
    """Write words; ``share`` of their width lies left of the place."""
    blf.size(_FONT, size)
    blf.color(_FONT, *colour[:3], 1.0)
    blf.position(_FONT, place[0] - share * blf.dimensions(_FONT, words)[0], place[1], 0.0)
    blf.draw(_FONT, words)
