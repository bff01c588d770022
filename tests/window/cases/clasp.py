"""A clasp of two arcs with pinned ends comes to rest; by hand it is untied over an end, in twelve pictures."""

from itertools import pairwise
from typing import Any

import bpy
import numpy as np
from case import Steps, picture, until
from hands import addon, here, key, open_sidebar, region, window
from scene import clear, is_, obj, run, state

from .hand import let_go, move_to, press, resting

# where the hand pulls the tip of the longer arc: out between the other's ends, up over one of them, and back
_WAY = np.array([(1.0, 0, 0), (2.2, 0, 0.0), (2.2, 0, 1.3), (0.0, 0, 1.6), (-2.4, 0, 1.0)])
_PICTURES = 12
_BETWEEN = 8  # places of the mouse from picture to picture


def case() -> Steps:
    clear()
    hooks()
    yield from open_sidebar()
    with here():
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(type="ORBITUP", angle=-0.4)
        bpy.ops.view3d.view_orbit(type="ORBITLEFT", angle=0.25)
        bpy.ops.view3d.view_selected()
        yield
        assert bpy.ops.curve.mobius_flow_grab("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield from until(lambda: run() is not None and run().shown is not None, "a run")
    yield from until(resting, "the clasp to rest", 120)
    curve = run().session.in_view
    assert clasped(curve), "the energy does not untie it"
    main = region("WINDOW")

    def seen(places: np.ndarray) -> np.ndarray:
        flat, _, _ = addon("live.drag").projected(main, places)
        return np.round(flat).astype(int) + np.array([main.x, main.y])

    yield from picture("clasp-01")
    tip = curve.mesh.slices[0].start + int(np.argmax(curve.vertices[curve.mesh.slices[0], 0]))
    yield from press(*map(int, seen(curve.vertices[tip : tip + 1])[0]))
    yield from until(lambda: run().drag is not None, "the tip to be held")
    steps = (_PICTURES - 2) * _BETWEEN
    way = seen(np.stack([np.interp(np.linspace(0, 4, steps), np.arange(5), column) for column in _WAY.T], axis=1))
    for k, (x, y) in enumerate(way):
        yield from move_to(int(x), int(y))
        before = run().last.index  # where the arc is taut it may be at rest after one
        yield from until(lambda before=before: run().last.index > before + 2 or resting(), "the arc to follow", 20)
        if k % _BETWEEN == _BETWEEN - 1:
            yield from picture(f"clasp-{2 + k // _BETWEEN:02d}")
    yield from let_go(*map(int, way[-1]))
    last = run().last.index
    yield from until(lambda: run().last.index > last and resting(), "the arcs to come to rest", 120)
    yield from picture(f"clasp-{_PICTURES}", differs_from="clasp-01")
    assert not clasped(run().session.in_view), "it is untied"
    yield from key("RETURN")
    yield from is_("done")
    assert addon("live.registry").latest().report.certified, state()
    assert addon("curves.pins").count(obj().data) == 4


def hooks() -> None:
    """Two arcs that hook each other, with pinned ends: a long one at the left, a short one at the right."""
    half = np.array([(-1.4, 0.35), (-1.9, 1.0), (-1.6, 1.9), (-0.6, 2.0), (0.2, 1.3), (0.7, 0.5), (0.85, 0.0)])
    flat = np.concatenate([half, half[-2::-1] * [1, -1]])
    turn = np.linspace(np.pi / 2, -np.pi / 2, 13)
    long = [(x, y, 0.0) for x, y in flat]
    short = [(1.3, 0.0, 0.45), *((0.15 - 0.45 * np.cos(a), 0.0, 0.45 * np.sin(a)) for a in turn), (1.3, 0.0, -0.45)]
    data = bpy.data.curves.new("Clasp", "CURVE")
    data.dimensions, data.bevel_depth, data.bevel_resolution, data.use_fill_caps = "3D", 0.09, 5, True
    for points in (long, short):
        spline = data.splines.new("POLY")
        spline.points.add(len(points) - 1)
        spline.points.foreach_set("co", np.pad(points, ((0, 0), (0, 1)), constant_values=1.0).ravel())
        chosen = np.zeros(len(points), dtype=bool)
        chosen[[0, -1]] = True
        addon("curves.pins").pin(spline, chosen)
    made = bpy.data.objects.new("Clasp", data)
    window().scene.collection.objects.link(made)
    window().view_layer.objects.active = made
    made.select_set(True)
    with here():
        bpy.ops.curve.mobius_flow_color_components()
        bpy.context.space_data.shading.color_type = "MATERIAL"
        bpy.ops.ed.undo_push(message="Clasp added")


def clasped(link: Any) -> bool:
    """Whether the second arc passes through the triangles between the first one and the middle of its ends."""
    long, short = (link.vertices[piece] for piece in link.mesh.slices)
    middle = 0.5 * (long[0] + long[-1])
    passes = 0
    for a, b in pairwise(long - middle):
        side = (short - middle) @ np.cross(a, b)
        for k in np.flatnonzero(side[:-1] * side[1:] < 0):
            point = short[k] + side[k] / (side[k] - side[k + 1]) * (short[k + 1] - short[k]) - middle
            s, t = np.linalg.lstsq(np.stack([a, b], axis=1), point, rcond=None)[0]
            passes += s >= 0 and t >= 0 and s + t <= 1
    return passes % 2 == 1
