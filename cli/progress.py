"""Progress on a terminal, with tqdm where it is installed."""

import math
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Any, Self

from ..core import Iterate, RelaxOptions
from ..core.driver.run import gradient_bound


class WithBar:
    """What shows a bar, if there is one, and takes it away in the end."""

    def __init__(self, shown: bool, **options: Any) -> None:
        self._bar = bar(**options) if shown else None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.close()


class Progress(WithBar):
    """A bar that runs from the first gradient norm down to the tolerance, on a logarithmic scale."""

    def __init__(self, options: RelaxOptions, shown: bool) -> None:
        super().__init__(shown, total=100, bar_format="{l_bar}{bar}| {elapsed} {postfix}")
        self._options = options
        self._start: float | None = None

    def update(self, iterate: Iterate) -> None:
        """Show an iterate."""
        if self._bar is None:
            return
        bound = gradient_bound(self._options, iterate.curve.mesh, iterate.energy)
        distance = math.log(max(iterate.gradient_norm, bound) / bound)
        if self._start is None:
            self._start = max(distance, 1e-9)
        self._bar.n = max(self._bar.n, round(100 * (1 - distance / self._start)))
        self._bar.set_postfix_str(
            f"iteration {iterate.index}, objective {iterate.energy:.6g}, gradient {iterate.gradient_norm:.2g}"
        )


@contextmanager
def leg_progress(shown: bool) -> Iterator[Callable[[int, int], None] | None]:
    """Give what shows the numbers of legs that are checked and of all, or None where nothing can be shown."""
    legs = bar(unit=" legs") if shown else None
    if legs is None:
        yield None
        return

    def show(done: int, total: int) -> None:
        legs.total = total or None
        legs.update(done - legs.n)

    with legs:
        yield show


def bar(**options: Any) -> Any:
    """A bar of tqdm that vanishes in the end; None if it is not installed."""
    try:
        from tqdm import tqdm
    except ImportError:
        return None
    return tqdm(leave=False, **options)


def show_frames(done: int, total: int) -> None:
    """Show on one line how far a film is."""
    print(f"\rrendering frame {done} of {total}", end="\n" if done == total else "", file=sys.stderr, flush=True)
