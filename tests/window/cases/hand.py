"""A hand in the view: strands are dragged, pinned and taken back, a clasp is untied, strokes become knots."""

from itertools import pairwise
from typing import Any

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from case import Steps, picture, until
from hands import addon, button, click, core, here, key, open_sidebar, region, view, window
from interruption import undo
from mathutils import Vector
from scene import add, clear, is_, iterate, latest, look, obj, points, ready, run, state, undone

# where the hand pulls the tip of the longer arc: out between the other's ends, up over one of them, and back
_WAY = np.array([(1.0, 0, 0), (2.2, 0, 0.0), (2.2, 0, 1.3), (0.0, 0, 1.6), (-2.4, 0, 1.0)])
_PICTURES = 12
_BETWEEN = 8  # places of the mouse from picture to picture


def dragging() -> Steps:
    """Strands follow; what was dragged is taken back by undo and Esc; the view can still be turned."""
    yield from ready("3_1", 0)
    window().scene.mobius_flow.tolerance = 1e-3
    before = points()
    yield from button("curve.mobius_flow_grab")
    yield from until(lambda: run() is not None, "a run")
    yield from until(resting, "the knot to rest and wait", 120)
    assert run() is not None, state()
    yield from look()
    yield from picture("hand-1-resting")
    at_rest = points()

    start = pixel(0)
    yield from press(*start)
    yield from until(lambda: run().drag is not None, "a strand to be held")
    for k in range(1, 13):
        yield from move_to(start[0] + 12 * k, start[1] + 4 * k)
        yield from picture(f"hand-2-{k:02d}", differs_from="hand-1-resting" if k > 6 else "")
    yield from until(lambda: np.linalg.norm(np.subtract(held(), (start[0] + 144, start[1] + 48))) < 40, "the strand")
    yield from let_go(start[0] + 144, start[1] + 48)
    yield from until(resting, "the knot to rest again")
    yield from picture("hand-3-released", differs_from="hand-1-resting")

    yield from drag(pixel(10))
    undo()
    yield from until(lambda: run().drags == 1 and resting(), "Edit > Undo to take the second drag back")
    yield from key("Z", ctrl=True)
    yield from until(lambda: np.array_equal(points(), at_rest), "the drag to be taken back")
    assert run() is not None, state()
    start = pixel(20)
    yield from press(*start)
    yield from move_to(start[0] + 60, start[1])
    yield from key("ESC", over=(start[0] + 60, start[1]))
    yield from until(lambda: np.array_equal(points(), at_rest), "Esc to take the drag back")
    assert run() is not None, "Esc takes back the drag alone"
    yield from let_go(start[0] + 60, start[1])

    yield from press(*pixel(40))
    end = pixel(40)[0] + 60, pixel(40)[1] + 30
    yield from move_to(*end)
    yield from until(lambda: np.linalg.norm(np.subtract(held(), end)) < 40, "the strand to come along")
    yield from let_go(*end, ctrl=True)
    yield from until(lambda: addon("curves.pins").count(obj().data) == 1, "a pin")
    yield from picture("hand-4-pinned", differs_from="hand-3-released")

    turned = matrix()
    main = region("WINDOW")
    middle = main.x + main.width // 2, main.y + main.height // 2
    for kind, value, dx in (("MIDDLEMOUSE", "PRESS", 0), ("MOUSEMOVE", "NOTHING", 80), ("MIDDLEMOUSE", "RELEASE", 80)):
        yield from send(kind, value, middle[0] + dx, middle[1])
    yield from until(lambda: not np.allclose(matrix(), turned), "the view to be turned")

    yield from key("RETURN")
    yield from is_("done")
    assert latest().report.certified
    assert addon("curves.pins").count(obj().data) == 1
    yield from picture("hand-5-kept")
    yield from undone(lambda: np.array_equal(points(), before), "all of it")


def untying() -> Steps:
    """A clasp of two arcs with pinned ends comes to rest; by hand it is untied over an end, in twelve pictures."""
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
    yield from picture("clasp-01")
    tip = curve.mesh.slices[0].start + int(np.argmax(curve.vertices[curve.mesh.slices[0], 0]))
    yield from press(*pixel(tip))
    yield from until(lambda: run().drag is not None, "the tip to be held")
    steps = (_PICTURES - 2) * _BETWEEN
    way = seen(np.stack([np.interp(np.linspace(0, 4, steps), np.arange(5), column) for column in _WAY.T], axis=1))
    for k, (x, y) in enumerate(way):
        yield from move_to(x, y)
        before = run().last.index  # where the arc is taut it may be at rest after one
        yield from until(lambda before=before: run().last.index > before + 2 or resting(), "the arc to follow", 20)
        if k % _BETWEEN == _BETWEEN - 1:
            yield from picture(f"clasp-{2 + k // _BETWEEN:02d}")
    yield from let_go(*way[-1])
    last = run().last.index
    yield from until(lambda: run().last.index > last and resting(), "the arcs to come to rest", 120)
    yield from picture(f"clasp-{_PICTURES}", differs_from="clasp-01")
    assert not clasped(run().session.in_view), "it is untied"
    yield from key("RETURN")
    yield from is_("done")
    assert latest().report.certified, state()
    assert addon("curves.pins").count(obj().data) == 4


def drawing() -> Steps:
    """The tool of the toolbar: a stroke becomes a knot, a click swaps the strands of a crossing, Enter relaxes."""
    clear()
    with here():
        view().spaces.active.show_region_toolbar = True
        bpy.ops.view3d.view_axis(type="TOP")
        bpy.ops.wm.tool_set_by_id(name="mobius_flow.knot")
    yield
    yield from picture("tool-1-chosen")
    yield from stroke()
    yield from until(lambda: obj() is not None and obj().name == "Drawn m3_1", "the drawn trefoil")
    yield from picture("tool-2-drawn", differs_from="tool-1-chosen")
    yield from click(*crossing())
    yield from until(lambda: obj().name == "Drawn Unknot", "a crossing to be swapped")
    yield from picture("tool-3-swapped", differs_from="tool-2-drawn")
    yield from undone(lambda: obj().name == "Drawn m3_1", "that")
    yield from click(*crossing())
    yield from until(lambda: obj().name == "Drawn Unknot", "a crossing to be swapped again")
    yield from key("RETURN")
    yield from is_("done")
    yield from picture("tool-4-relaxed", differs_from="tool-3-swapped")
    with here():
        bpy.ops.wm.tool_set_by_id(name="builtin.select_box")


PARTS = (dragging, untying, drawing)


def drag(start: tuple[int, int]) -> Steps:
    """Pull a strand a little, and let it go."""
    yield from press(*start)
    yield from until(lambda: run().drag is not None, "a strand to be held")
    yield from move_to(start[0] + 60, start[1])
    yield from let_go(start[0] + 60, start[1])


def resting() -> bool:
    """Whether the run waits for the hand."""
    last = latest().last if latest() else None
    return iterate() > 0 and latest().shown is last and bool(last.path) and last.step_size == 0.0


def seen(places: np.ndarray) -> list[tuple[int, int]]:
    """Where places, (k, 3), are seen, in the window."""
    main = region("WINDOW")
    flat, _, _ = addon("live.drag").projected(main, places)
    return [(round(main.x + x), round(main.y + y)) for x, y in flat]


def pixel(vertex: int) -> tuple[int, int]:
    """Where a vertex is seen."""
    return seen(run().session.in_view.vertices[vertex : vertex + 1])[0]


def held() -> tuple[int, int]:
    """Where the strand that is held is seen."""
    return seen(run().drag.held(run().session.in_view)[None])[0]


def matrix() -> np.ndarray:
    """That of the view."""
    return np.array(region("WINDOW").data.view_matrix)


def send(kind: str, value: str, x: int, y: int, **more: bool) -> Steps:
    """Send an event of the mouse."""
    window().event_simulate(type=kind, value=value, x=x, y=y, **more)
    yield


def move_to(x: int, y: int) -> Steps:
    """Move the mouse."""
    yield from send("MOUSEMOVE", "NOTHING", x, y)


def press(x: int, y: int) -> Steps:
    """Move there and press the left button."""
    yield from move_to(x, y)
    yield from send("LEFTMOUSE", "PRESS", x, y)


def let_go(x: int, y: int, ctrl: bool = False) -> Steps:
    """Release the left button."""
    yield from send("LEFTMOUSE", "RELEASE", x, y, ctrl=ctrl)


def hooks() -> None:
    """Two arcs that hook each other, with pinned ends: a long one at the left, a short one at the right."""
    half = np.array([(-1.4, 0.35), (-1.9, 1.0), (-1.6, 1.9), (-0.6, 2.0), (0.2, 1.3), (0.7, 0.5), (0.85, 0.0)])
    flat = np.concatenate([half, half[-2::-1] * [1, -1]])
    turn = np.linspace(np.pi / 2, -np.pi / 2, 13)
    long = [(x, y, 0.0) for x, y in flat]
    short = [(1.3, 0.0, 0.45), *((0.15 - 0.45 * np.cos(a), 0.0, 0.45 * np.sin(a)) for a in turn), (1.3, 0.0, -0.45)]
    made = add("Clasp", long, short, cyclic=False, bevel=0.09)
    made.data.bevel_resolution, made.data.use_fill_caps = 5, True
    for spline in made.data.splines:
        addon("curves.pins").pin(spline, addon("curves.pins").ends(spline))
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


def stroke() -> Steps:
    """Draw a curve with three crossings around the middle of the view, left of the sidebar."""
    main = region("WINDOW")
    middle = np.array([main.x + 0.4 * main.width, main.y + 0.5 * main.height])
    t = 2 * np.pi * np.linspace(0.1, 1.03, 60)  # it closes itself
    points = middle + 0.11 * main.height * np.stack(
        [np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t)], axis=1
    )
    places = points.astype(int).tolist()
    yield from press(*places[0])
    for place in places:
        yield from move_to(*place)
    for _ in range(20):  # time to find its name
        yield
    yield from picture("tool-1-named", differs_from="tool-1-chosen")
    yield from let_go(*places[-1])


def crossing() -> tuple[int, int]:
    """Where the knot's first crossing is in the window."""
    values = np.array(obj().data["mobius_flow_plane"])
    plane = core("keys.planes").DrawingPlane(values[:3], values[3:].reshape(3, 3))
    curve = core().Curve.from_components(addon("curves.strands").Strands.of(obj()).components)
    drawing = core("knots").Drawing.seen(curve.with_vertices((curve.vertices - plane.origin) @ plane.axes.T))
    place = plane.raised(np.column_stack([drawing.crossings[:1], [0.0]]))[0]
    main = region("WINDOW")
    there = location_3d_to_region_2d(main, view().spaces.active.region_3d, obj().matrix_world @ Vector(place))
    return int(main.x + there[0]), int(main.y + there[1])
