"""How long the knot 7_4 takes in a window and for the worker alone; all iterates are recorded, some are shown."""

import time

from case import Steps, picture
from hands import addon, button
from scene import is_, obj, reaches, ready


def case() -> Steps:
    yield from ready("7_4", vertices=0)
    yield from button("curve.mobius_flow_relax")
    started = time.perf_counter()
    yield from reaches(1)
    shown: set[int] = set()
    latest = addon("live.registry").latest()
    while latest.state.value == "running":
        shown.add(latest.shown.index)
        yield
    seconds = time.perf_counter() - started
    yield from is_("done")
    count = latest.last.index
    assert len(obj().data.shape_keys.key_blocks) == count + 1
    print(f"MEASURED 7_4 in a window: {seconds:.1f} s for {count} iterates, {len(shown)} shown", flush=True)
    yield from picture("speed-1-relaxed")
