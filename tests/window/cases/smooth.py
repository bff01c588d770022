"""A Bézier circle is sampled after asking, and undo brings it back."""

import bpy
import numpy as np
from case import Steps, picture, until
from hands import button, here, key, open_sidebar, window
from scene import clear, is_, obj, points, run


def case() -> Steps:
    clear()
    with here():
        bpy.ops.curve.primitive_bezier_circle_add()
        for point in obj().data.splines[0].bezier_points:
            point.co[2] = 0.3 * point.co[0] ** 2
        bpy.ops.ed.undo_push(message="Circle")
    before = [point.co[:] for point in obj().data.splines[0].bezier_points]
    yield from open_sidebar()
    yield from button("curve.mobius_flow_relax")
    assert run() is None, "nothing happens before the answer"
    yield from picture("smooth-1-asked")
    yield from key("RET", over=(window().width // 2, window().height // 2))
    yield from until(lambda: run() is not None, "the answer")
    yield from is_("done")
    assert obj().data.splines[0].type == "POLY"
    assert len(points()) >= 48
    yield from picture("smooth-2-relaxed")
    yield from key("Z", ctrl=True)
    yield from until(lambda: obj().data.splines[0].type == "BEZIER", "undo")
    assert np.array_equal([point.co[:] for point in obj().data.splines[0].bezier_points], before)
