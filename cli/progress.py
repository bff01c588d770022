"""Progress on a terminal or in a notebook, with tqdm where it is installed."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from ..addon.engine.words import time_left
from ..core import Iterate, RelaxOptions
from ..core.driver import TimeLeft


@contextmanager
def bar(shown: bool, **options: Any) -> Iterator[Any]:
    """A tqdm bar that vanishes in the end; None if it is not wanted, or tqdm is not installed."""
    try:
        from tqdm.auto import tqdm
    except ImportError:
        shown = False
    if not shown:
        yield None
        return
    with tqdm(leave=False, **options) as made:
        yield made


class Progress:
    """Moves a bar from the first gradient norm down to the tolerance, on a logarithmic scale."""

    def __init__(self, options: RelaxOptions) -> None:
        self._left = TimeLeft(options)
        self._start: float | None = None

    def update(self, bar: Any, iterate: Iterate) -> None:
        """Show an iterate, if there is a bar."""
        if bar is None:
            return
        self._left.add(iterate)
        distance, seconds = self._left.distances[-1], self._left.seconds
        if self._start is None:
            self._start = max(distance, 1e-9)
        bar.n = max(bar.n, round(100 * (1 - distance / self._start)))
        bar.set_postfix_str(
            f"iteration {iterate.index}, objective {iterate.energy:.6g}, gradient {iterate.gradient_norm:.2g}"
            f"{f', {time_left(seconds)}' if seconds else ''}"
        )


@contextmanager
def progress(options: RelaxOptions | None = None, shown: bool = True) -> Iterator[Callable[[Iterate], None]]:
    """Give a callback that draws a bar from the iterates of a run, as `minimize` passes them."""
    drawn = Progress(RelaxOptions() if options is None else options)
    with bar(shown, total=100, bar_format="{l_bar}{bar}| {elapsed} {postfix}") as made:
        yield lambda iterate: drawn.update(made, iterate)


@contextmanager
def leg_progress(shown: bool) -> Iterator[Callable[[int, int], None] | None]:
    """Give a function that shows how many of all legs are checked, or None where nothing can be shown."""
    with bar(shown, unit=" legs") as legs:

        def show(done: int, total: int) -> None:
            legs.total = total or None
            legs.update(done - legs.n)

        yield None if legs is None else show


def show_frames(done: int, total: int) -> None:
    """Show a film's progress on one line."""
    print(f"\rrendering frame {done} of {total}", end="\n" if done == total else "", file=sys.stderr, flush=True)
