"""The tool of the toolbar: a stroke becomes a knot, a click swaps the strands of a crossing, Enter relaxes."""

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from case import Steps, picture, until
from hands import addon, click, core, here, key, region, view, window
from mathutils import Vector
from scene import clear, is_, obj

OPEN = 0.93  # of the way round: the stroke closes itself


def case() -> Steps:
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
    yield from key("Z", ctrl=True)
    yield from until(lambda: obj().name == "Drawn m3_1", "undo of that")
    yield from click(*crossing())
    yield from until(lambda: obj().name == "Drawn Unknot", "a crossing to be swapped again")
    yield from key("RETURN")
    yield from is_("done")
    yield from picture("tool-4-relaxed", differs_from="tool-3-swapped")
    with here():
        bpy.ops.wm.tool_set_by_id(name="builtin.select_box")


def stroke() -> Steps:
    """Draw a curve with three crossings around the middle of the view, left of the sidebar."""
    main = region("WINDOW")
    middle = np.array([main.x + 0.4 * main.width, main.y + 0.5 * main.height])
    t = 2 * np.pi * np.linspace(0.1, 0.1 + OPEN, 60)
    points = middle + 0.11 * main.height * np.stack(
        [np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t)], axis=1
    )
    send = window().event_simulate
    places = points.astype(int).tolist()
    send(type="MOUSEMOVE", value="NOTHING", x=places[0][0], y=places[0][1])
    yield
    send(type="LEFTMOUSE", value="PRESS", x=places[0][0], y=places[0][1])
    yield
    for x, y in places:
        send(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
        yield
    for _ in range(20):  # time to find its name
        yield
    yield from picture("tool-1-named", differs_from="tool-1-chosen")
    send(type="LEFTMOUSE", value="RELEASE", x=places[-1][0], y=places[-1][1])
    yield


def crossing() -> tuple[int, int]:
    """Where the knot's first crossing is in the window."""
    values = np.array(obj().data["mobius_flow_plane"])
    plane = core("keys.placement").DrawingPlane(values[:3], values[3:].reshape(3, 3))
    curve = core().Curve.from_components(addon("curves.splines").read_splines(obj()))
    drawing = core("knots").Drawing.seen(curve.with_vertices((curve.vertices - plane.origin) @ plane.axes.T))
    place = plane.raised(np.column_stack([drawing.crossings[:1], [0.0]]))[0]
    main = region("WINDOW")
    there = location_3d_to_region_2d(main, view().spaces.active.region_3d, obj().matrix_world @ Vector(place))
    return int(main.x + there[0]), int(main.y + there[1])
