"""How long the knot 7_4 takes in a window and for the worker alone; all iterates are recorded, some are shown."""

import time

from case import Steps, picture
from hands import addon, button, core, window
from scene import is_, obj, reaches, ready


def case() -> Steps:
    yield from ready("7_4", vertices=0)
    yield from button("curve.mobius_flow_relax")
    started = time.perf_counter()
    yield from reaches(1)
    shown: set[int] = set()
    latest = addon("live.registry").latest()
    while latest.state.name == "RUNNING":
        shown.add(latest.shown.index)
        yield
    seconds = time.perf_counter() - started
    yield from is_("done")
    count = latest.last.index
    assert len(obj().data.shape_keys.key_blocks) > count, "every iterate is a key, and there are others in between"
    yield from picture("speed-1-relaxed")

    settings = addon("properties")
    values = {name: getattr(window().scene.mobius_flow, name) for name in settings.SETTINGS}
    options = settings.relax_options(values)
    worker = addon("engine.worker").Worker(core().Task(curve=latest.session.curve), options, latest.session.link)
    started = 0.0
    while not hasattr(arrived := worker.poll(), "status"):
        if arrived is None:
            yield
        else:
            started = started or time.perf_counter()
    alone = time.perf_counter() - started
    worker.close()
    print(
        f"MEASURED 7_4 in a window: {seconds:.1f} s for {count} iterates, {len(shown)} shown; computed alone: "
        f"{alone:.1f} s",
        flush=True,
    )
