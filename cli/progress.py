"""What is going on: a line that is written over and over on a terminal, or in a notebook, and nowhere else."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from ..core import Iterate, RelaxOptions
from ..core.driver import TimeLeft
from ..core.driver.run import gradient_bound
from ..core.driver.words import time_left
from .terminal import is_dumb, power, width_of

_PAUSE = 0.1  # seconds from one line to the next


@contextmanager
def live(shown: bool = True) -> Iterator[Callable[[str], None]]:
    """Give a function that shows a text in place of the one before.

    On a terminal it vanishes in the end; a notebook keeps the last one, also as a page.
    """
    notebook: Any = None  # the place of an output there
    interactive = sys.modules.get("IPython") if shown else None
    if interactive is not None and hasattr(interactive.get_ipython(), "kernel"):
        from IPython.display import display

        notebook = display({"text/plain": ""}, raw=True, display_id=True)
    on_terminal = shown and notebook is None and sys.stderr is not None and not is_dumb(sys.stderr)
    shown_at, last = -_PAUSE, ""

    def write(text: str) -> None:
        if notebook is not None:
            notebook.update({"text/plain": text}, raw=True)
        elif on_terminal:
            print(f"\r\x1b[K{text[: (width_of(sys.stderr) or 80) - 1]}", end="", file=sys.stderr, flush=True)

    def show(text: str) -> None:
        nonlocal shown_at, last
        last = text
        if time.monotonic() - shown_at >= _PAUSE:
            shown_at = time.monotonic()
            write(text)

    try:
        yield show
    finally:
        if last:
            write(last if notebook is not None else "")


@contextmanager
def progress(options: RelaxOptions | None = None, shown: bool = True) -> Iterator[Callable[[Iterate], None]]:
    """Give a callback that shows the iterates of a run, as `minimize` passes them, and how long it may still take.

    Without options it is one of ropes: they come to rest otherwise.
    """
    wanted = RelaxOptions() if options is None else options
    left = TimeLeft(wanted)
    with live(shown) as show:

        def draw(iterate: Iterate) -> None:
            if options is None:
                radius, length = min(iterate.radius or (0.0,)), iterate.curve.length
                show(f"iteration {iterate.index} · radius {radius:.4g} · length {length:#.5g}")
                return
            left.add(iterate)
            moves, bound = iterate.strand_moves, gradient_bound(wanted, iterate.curve.mesh, iterate.energy)
            words = [
                f"iteration {iterate.index}",
                f"E {iterate.energy:#.5g}",
                f"gradient {power(iterate.gradient_norm)} → {power(bound)}",
            ]
            if moves is not None and not moves.done:
                words[1:] = [f"strands move: {moves.left} of {moves.before} crossings are left"]
            elif (seconds := left.seconds) is not None:
                words.append(time_left(seconds))
            show(" · ".join(words))

        yield draw
