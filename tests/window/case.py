"""Run one case inside Blender: ``blender --python case.py -- NAME``.

A case is a journey: its parts are generators, each of which begins with Blender's own new file. A part sends an event
or looks at the state, yields, and goes on when Blender has drawn.
"""

import importlib
import os
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import bpy

_INTERVAL = 0.03
_DIFFERENT = 300  # pixels
_LIMIT = 300.0  # seconds for a part

Steps = Iterator[None]


def main(name: str) -> None:
    """Start a case when the window is there."""
    _prepare()
    steps = journey(importlib.import_module(f"cases.{name}").PARTS)

    def tick() -> float | None:
        try:
            next(steps)
        except StopIteration:
            print("CASE PASSED", flush=True)
            bpy.ops.wm.quit_blender()
            return None
        except BaseException:
            traceback.print_exc()
            sys.stderr.flush()
            os._exit(9)
        return _INTERVAL

    bpy.app.timers.register(tick, first_interval=0.5, persistent=True)


def journey(parts: Sequence[Callable[[], Steps]]) -> Steps:
    """One part after the other."""
    for part in parts:
        print(f"PART {part.__name__}", flush=True)
        bpy.ops.wm.read_homefile(app_template="")
        started = time.monotonic()
        yield
        for _ in part():
            assert time.monotonic() - started < _LIMIT, f"{part.__name__} takes too long"
            yield


def _prepare() -> None:
    preferences = bpy.context.preferences
    preferences.view.show_splash = False
    preferences.view.smooth_view = 0
    preferences.view.use_save_prompt = False
    preferences.system.viewport_aa = "OFF"
    preferences.use_preferences_save = False


def until(condition: Callable[[], object], what: str, seconds: float = 60.0) -> Steps:
    """Wait until a condition holds."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, f"waited too long for: {what}"
        yield


def picture(name: str, differs_from: str = "") -> Steps:
    """Have a picture of the whole screen taken, and see that the 3D view is not what it was in another one."""
    for _ in range(3):  # let what has changed be drawn
        yield
    want = Path(os.environ["ROOM"]) / f"{name}.want"
    want.with_suffix(".new").write_text(differs_from, encoding="utf-8")
    want.with_suffix(".new").rename(want)
    yield from until(lambda: not want.exists(), f"picture {name}", 20)
    if differs_from:
        pixels = float(want.with_suffix(".pixels").read_text(encoding="utf-8").split()[0])
        assert pixels > _DIFFERENT, f"only {pixels:g} pixels differ between {differs_from} and {name}"


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parent))
    sys.modules["case"] = sys.modules["__main__"]  # the cases import this file
    main(sys.argv[sys.argv.index("--") + 1])
