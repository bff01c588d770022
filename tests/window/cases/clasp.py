"""A clasp is untied by hand: the free end of a hook is dragged out of a bight that is pinned, in twelve pictures."""

import bpy
import numpy as np
from case import Steps, picture, until
from hands import addon, here, key, open_sidebar, region, window
from scene import clear, is_, obj, run, state

from .hand import let_go, move_to, press

# where the hand goes: back below the bight, up through it, and away to the right
_WAY = np.array([(1.6, 0, -0.6), (-1.2, 0, -1.0), (-1.4, 0, 1.1), (0.6, 0, 1.8), (2.6, 0, 1.9)])
_PICTURES = 12
_BETWEEN = 8  # places of the mouse from picture to picture


def case() -> Steps:
    clear()
    hooks()
    yield from open_sidebar()
    with here():
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(type="ORBITUP", angle=-0.35)
        bpy.ops.view3d.view_orbit(type="ORBITLEFT", angle=0.3)
        bpy.ops.view3d.view_selected()
        yield
        assert bpy.ops.curve.mobius_flow_grab("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield from until(lambda: run() is not None and run().shown is not None, "a run")
    free = run().group.in_view.mesh.slices[1].stop - 1
    main = region("WINDOW")

    def seen(places: np.ndarray) -> np.ndarray:
        flat, _, _ = addon("live.drag").projected(main, places)
        return np.round(flat + [main.x, main.y]).astype(int)

    start = seen(run().group.in_view.vertices[free - 1 : free])[0]
    yield from press(*start)
    yield from until(lambda: run().drag is not None, "the hook to be held")
    steps = (_PICTURES - 2) * _BETWEEN
    way = seen(np.stack([np.interp(np.linspace(0, 4, steps), np.arange(5), column) for column in _WAY.T], axis=1))
    for k, (x, y) in enumerate(way):
        if k % _BETWEEN == 0:
            yield from picture(f"clasp-{1 + k // _BETWEEN:02d}")
        yield from move_to(int(x), int(y))
        before = run().last.index
        yield from until(lambda before=before: run().last.index > before + 1, "the hook to follow", 20)
    yield from picture(f"clasp-{_PICTURES - 1}")
    yield from let_go(*map(int, way[-1]))
    last = run().last.index
    yield from until(lambda: run().last.index > last + 20 or run().last.step_size == 0.0, "the arcs to relax on", 120)
    yield from picture(f"clasp-{_PICTURES}", differs_from="clasp-01")

    curve = run().group.in_view
    bight, hook = (curve.vertices[piece] for piece in curve.mesh.slices)
    assert not encloses(bight, hook), "the hook is out"
    yield from key("RETURN")
    yield from is_("done")
    assert addon("live.registry").latest().report.certified, state()
    assert addon("curves.pins").count(obj().data) == 3


def hooks() -> None:
    """A bight from the left, both ends pinned, and a hook around it from the right, pinned at its far end."""
    turn = np.linspace(np.pi / 2, -np.pi / 2, 13)
    bight = [(-3.0, 0.6, 0.0), *((0.2 + 0.6 * np.cos(a), 0.6 * np.sin(a), 0.0) for a in turn), (-3.0, -0.6, 0.0)]
    hook = [(3.2, 0.0, 0.6), *((-0.2 - 0.6 * np.cos(a), 0.0, 0.6 * np.sin(a)) for a in turn), (1.6, 0.0, -0.6)]
    data = bpy.data.curves.new("Clasp", "CURVE")
    data.dimensions, data.bevel_depth, data.bevel_resolution, data.use_fill_caps = "3D", 0.09, 5, True
    for points, pinned in ((bight, (0, -1)), (hook, (0,))):
        spline = data.splines.new("POLY")
        spline.points.add(len(points) - 1)
        spline.points.foreach_set("co", np.pad(points, ((0, 0), (0, 1)), constant_values=1.0).ravel())
        chosen = np.zeros(len(points), dtype=bool)
        chosen[list(pinned)] = True
        addon("curves.pins").pin(spline, chosen)
    made = bpy.data.objects.new("Clasp", data)
    window().scene.collection.objects.link(made)
    window().view_layer.objects.active = made
    made.select_set(True)
    with here():
        bpy.ops.curve.mobius_flow_color_components()
        bpy.context.space_data.shading.color_type = "MATERIAL"
        bpy.ops.ed.undo_push(message="Clasp added")


def encloses(bight: np.ndarray, hook: np.ndarray) -> bool:
    """Whether a hook passes through the triangles between a bight and the middle of its ends."""
    middle = 0.5 * (bight[0] + bight[-1])
    for a, b in zip(bight[:-1], bight[1:], strict=True):
        normal = np.cross(a - middle, b - middle)
        side = (hook - middle) @ normal
        for k in np.flatnonzero(side[:-1] * side[1:] < 0):
            point = hook[k] + side[k] / (side[k] - side[k + 1]) * (hook[k + 1] - hook[k]) - middle
            s, t = np.linalg.lstsq(np.stack([a - middle, b - middle], axis=1), point, rcond=None)[0]
            if s >= 0 and t >= 0 and s + t <= 1:
                return True
    return False
