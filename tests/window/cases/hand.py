"""A hand in the view: strands are dragged with the mouse, pinned, and taken back; the view can still be turned."""

import numpy as np
from case import Steps, picture, until
from hands import addon, button, here, key, region, window
from interruption import undo
from scene import is_, iterate, look, obj, points, ready, run, state


def case() -> Steps:
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
        window().event_simulate(type=kind, value=value, x=middle[0] + dx, y=middle[1])
        yield
    yield from until(lambda: not np.allclose(matrix(), turned), "the view to be turned")

    yield from key("RETURN")
    yield from is_("done")
    report = addon("live.registry").latest().report
    assert report.certified
    assert addon("curves.pins").count(obj().data) == 1
    yield from picture("hand-5-kept")
    yield from key("Z", ctrl=True)
    yield from until(lambda: np.array_equal(points(), before), "undo of all of it")


def drag(start: tuple[int, int]) -> Steps:
    """Pull a strand a little, and let it go."""
    yield from press(*start)
    yield from until(lambda: run().drag is not None, "a strand to be held")
    yield from move_to(start[0] + 60, start[1])
    yield from let_go(start[0] + 60, start[1])


def resting() -> bool:
    """Whether the run waits for the hand."""
    latest = addon("live.registry").latest()
    return iterate() > 0 and latest.shown is latest.last and bool(latest.last.path) and latest.last.step_size == 0.0


def pixel(vertex: int) -> tuple[int, int]:
    """Where a vertex is seen, in the window."""
    main = region("WINDOW")
    flat, _, _ = addon("live.drag").projected(main, run().session.in_view.vertices)
    return round(main.x + flat[vertex][0]), round(main.y + flat[vertex][1])


def held() -> tuple[float, float]:
    """Where the strand that is held is seen."""
    main, going = region("WINDOW"), run()
    flat, _, _ = addon("live.drag").projected(main, going.drag.held(going.session.in_view)[None])
    return main.x + flat[0][0], main.y + flat[0][1]


def matrix() -> np.ndarray:
    """That of the view."""
    return np.array(region("WINDOW").data.view_matrix)


def press(x: int, y: int) -> Steps:
    """Move there and press the left button."""
    yield from move_to(x, y)
    window().event_simulate(type="LEFTMOUSE", value="PRESS", x=x, y=y)
    yield


def move_to(x: int, y: int) -> Steps:
    """Move the mouse."""
    window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
    yield


def let_go(x: int, y: int, ctrl: bool = False) -> Steps:
    """Release the left button."""
    window().event_simulate(type="LEFTMOUSE", value="RELEASE", x=x, y=y, ctrl=ctrl)
    with here():
        yield
