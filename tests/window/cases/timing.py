"""How long the window is blocked: at most 50 ms a tick, and Stop and Esc act within 0.2 s; memory comes back.

Ticks count as processor time, and but for one in a hundred by the clock, as other programs may hold one up.
"""

import gc
import time
from pathlib import Path
from typing import Any

import bpy
from case import Steps, until
from hands import addon, here
from scene import is_, reaches, ready, run, state

TICK = 0.05  # seconds
REACTION = 0.2
RUNS = 20
GROWTH = 60  # MB, which is what a few undo steps need


def memory() -> float:
    """Resident memory of this process in MB."""
    gc.collect()
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096 / 1e6


def measured(ticks: list[tuple[float, float]]) -> Any:
    """Have the event loop's handling timed, in processor time and by the clock; return what it was."""
    loop = addon("live.modal").Loop
    original = loop.handle

    def handle(self: Any, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        busy, started = time.thread_time(), time.perf_counter()
        result: set[str] = original(self, context, event)
        ticks.append((time.thread_time() - busy, time.perf_counter() - started))
        return result

    loop.handle = handle
    return original


def relax() -> None:
    with here():
        assert bpy.ops.curve.mobius_flow_relax("INVOKE_DEFAULT", again=True) == {"RUNNING_MODAL"}


def case() -> Steps:
    for vertices, shown in ((600, 40), (2000, 8)):
        yield from ready(vertices=vertices)
        ticks: list[tuple[float, float]] = []
        original = measured(ticks)
        relax()
        yield from reaches(shown)
        ran = max(ticks)[0]
        started = time.perf_counter()
        run().keep()
        stop = time.perf_counter() - started
        yield from is_("done")
        addon("live.modal").Loop.handle = original
        clock = sorted(wall for _, wall in ticks)
        print(
            f"MEASURED {vertices} points: longest tick {1e3 * ran:.1f} ms of {len(ticks)}, with keys written "
            f"{1e3 * max(ticks)[0]:.1f} ms, by the clock {1e3 * clock[-1]:.1f} ms; Stop {1e3 * stop:.1f} ms",
            flush=True,
        )
        assert max(ticks)[0] < TICK
        assert clock[-1 - len(clock) // 100] < TICK
        assert stop < REACTION
        with here():
            bpy.ops.ed.undo()
        yield
        relax()
        yield from reaches(2)
        started = time.perf_counter()
        run().cancel()
        print(f"MEASURED {vertices} points: Esc {1e3 * (time.perf_counter() - started):.1f} ms", flush=True)
        yield from until(lambda: run() is None, "Esc")

    yield from ready()
    at_first = 0.0
    for k in range(RUNS):
        relax()
        yield from reaches(3)
        run().cancel()
        assert state() == "cancelled"
        yield
        if k == 2:
            at_first = memory()
    print(f"MEASURED memory: {at_first:.0f} MB after 3 runs, {memory():.0f} MB after {RUNS}", flush=True)
    assert memory() - at_first < GROWTH
