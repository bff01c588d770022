"""The sub-panel with the other options opens, and what is set there is what is relaxed with."""

import bpy
from case import Steps, picture
from hands import below, button, click, region
from scene import is_, obj, ready, run


def case() -> Steps:
    yield from ready(vertices=200)
    y = yield from below("curve.mobius_flow_add_knot")
    sidebar = region("UI")
    yield from click(sidebar.x + int(0.33 * sidebar.width), y - 14)
    yield from picture("expert-1-open")
    settings = bpy.context.scene.mobius_flow
    settings.energy, settings.metric, settings.max_iterations = "edge", "h3-2", 3
    yield from picture("expert-2-set")
    yield from button("curve.mobius_flow_relax")
    yield from is_("done")
    assert run() is None
    assert len(obj().data.shape_keys.key_blocks) == 4
