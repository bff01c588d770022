"""What is drawn over the 3D views: the energy of the run that the panel shows, places of trouble, and pinned points."""

import logging
from collections.abc import Sequence

import blf
import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from ...core.base import FloatArray
from ...core.keys.colours import Colour, legible
from ...core.keys.placement import Frame, Placement
from ..curves import pins
from ..engine.rest import plot
from ..translations import iface_
from . import registry
from .drag import projected
from .run import LiveRun
from .selection import curves_at_hand

_LINE = 2.0  # this and other sizes in pixels, at the usual scale of the interface
_FONT = 0  # Blender's own
GOLD = (1.0, 0.75, 0.1)
_DIAMOND = 7.0 * np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])  # around pinned points
_log = logging.getLogger(__name__)
_handles: list[object] = []


def register() -> None:
    _handles.append(bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL"))


def unregister() -> None:
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")


def _draw() -> None:
    """Draw everything in the current view; a view that cannot be drawn into is left alone."""
    try:
        context = bpy.context
        run = registry.shown(context.active_object)
        if context.region is None or not context.space_data.overlay.show_overlays:
            return
        _pins(context)
        if run is not None:
            _marks(context, run)
            curve = run.session.in_view if run.drag is not None else None
            if run.drag is not None and curve is not None:
                # mark the strand that is held, and draw a line from there to the place it is pulled to
                ends, _, in_front = projected(context.region, np.stack([run.drag.held(curve), run.drag.target]))
                scale = context.preferences.system.ui_scale
                if in_front.all():
                    line(ends[0] + scale * _ring(7.0), GOLD, scale * _LINE)
                    line(ends, GOLD, scale * _LINE)
            if context.scene.mobius_flow_panel.show_plot and run.energies:
                _plot(context, run)
    except Exception:  # whatever happens to windows, files and graphics cards must not interrupt anybody
        _log.debug("nothing was drawn over the view", exc_info=True)


def _tooltip(preferences: bpy.types.Preferences) -> tuple[float, float, Colour, Colour]:
    """The interface's scale, and the font's size, the ground and the words' colour as tooltips have them."""
    scale, colours = preferences.system.ui_scale, preferences.themes[0].user_interface.wcol_tooltip
    return scale, 0.9 * scale * preferences.ui_styles[0].widget.points, colours.inner, colours.text


def label(words: str, place: FloatArray) -> None:
    """Write words right of a place in the region, on the ground that tooltips have."""
    scale, font, ground, ink = _tooltip(bpy.context.preferences)
    blf.size(_FONT, font)
    gap, size = scale * 10.0, np.array(blf.dimensions(_FONT, words))
    low = place + gap
    area(tuple(low), tuple(low + size + 2 * gap), (*ground[:3], 0.85))
    text(words, tuple(low + gap), ink, font)


def _plot(context: bpy.types.Context, run: LiveRun) -> None:
    """Draw the plot in the lower right corner, unless the view is too small for anything else."""
    scale, font, ground, ink = _tooltip(context.preferences)
    size, padding, caption = scale * np.array([280.0, 120.0]), scale * 10.0, scale * 18.0
    outer = size + 2 * padding + np.array([0.0, caption])
    region = context.region
    sidebars = [each for each in context.area.regions if each.type == "UI" and each.width > 1]  # may lie over the view
    right = min([region.width, *(each.x - region.x for each in sidebars if each.x > region.x)])
    low = scale * 16.0 * np.array([-1.0, 1.0]) + np.array([right - outer[0], 0.0])
    if low[0] < 0 or 2 * outer[1] > region.height:
        return
    area(tuple(low), tuple(low + outer), (*ground[:3], 0.85))
    origin, (way, level) = low + padding, plot(run.energies, run.target, *size)
    if run.target is not None and level is not None:
        # draw a dashed line with its label above it, at the left, where the energy is still high
        start, ends = origin + np.array([0.0, level]), np.arange(0.0, size[0], scale * 4.0)
        across = ends[: len(ends) // 2 * 2]
        pale = [0.5 * (a + b) for a, b in zip(ground[:3], ink[:3], strict=True)]
        line(start + np.column_stack([across, np.zeros(len(across))]), pale, scale, kind="LINES")
        text(iface_(run.target.label), (start[0], start[1] + 4 * scale), ink, font)
    line(origin + way, legible(context.preferences.themes[0].view_3d.object_active, ground), scale * _LINE)
    assert run.last is not None, "it has energies"
    x, y = (origin + np.array([0.0, size[1] + 0.5 * caption])).tolist()
    text(iface_("{measure} {energy:.4f}", measure=run.measure, energy=run.energies[-1]), (x, y), ink, font)
    text(iface_("Step {index}", index=run.last.index), (x + size[0], y), ink, font, share=1.0)


def _marks(context: bpy.types.Context, run: LiveRun) -> None:
    scale = context.preferences.system.ui_scale
    for there in _seen(context, [(obj, spot.marks) for obj, spot in run.spots.items()]):
        line(there + scale * _ring(14.0), (0.95, 0.25, 0.2), scale * _LINE)


def _ring(radius: float) -> FloatArray:
    turns = np.linspace(0.0, 2.0 * np.pi, 33)
    return np.asarray(radius * np.column_stack([np.cos(turns), np.sin(turns)]))


def _pins(context: bpy.types.Context) -> None:
    """Mark the pinned points of the curves at hand, all in one batch: there may be thousands."""
    scale = context.preferences.system.ui_scale
    there = _seen(context, [(obj, pins.places(obj.data)) for obj in curves_at_hand(context)])
    corners = scale * np.stack([_DIAMOND, np.roll(_DIAMOND, -1, axis=0)], axis=1).reshape(-1, 2)
    line((there[:, None] + corners).reshape(-1, 2), GOLD, scale * _LINE, kind="LINES")


def _seen(context: bpy.types.Context, places: Sequence[tuple[bpy.types.Object, Frame | FloatArray]]) -> FloatArray:
    """The positions of objects' places, (k, 3) each, in the current view, of those that are in front; (n, 2)."""
    world = [Placement.from_matrix(obj.matrix_world).to_world(each.astype(np.float64)) for obj, each in places]
    there, _, in_front = projected(context.region, np.concatenate([np.empty((0, 3)), *world]))
    return np.asarray(there[in_front])


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
