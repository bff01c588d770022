"""What is set in the sub-panel with the other options is what is relaxed with."""

import bpy
from case import Steps, picture
from hands import button, open_panels, region
from scene import is_, obj, ready, run


def case() -> Steps:
    open_panels("expert")
    yield from ready()
    yield from picture("expert-1-open")
    settings = bpy.context.scene.mobius_flow
    settings.energy, settings.metric, settings.max_iterations = "edge", "h3-2", 3
    region("UI").tag_redraw()
    yield from picture("expert-2-set")
    yield from button("curve.mobius_flow_relax")
    yield from is_("done")
    assert run() is None
    assert sum(key.name.startswith("Step") for key in obj().data.shape_keys.key_blocks) == 4
