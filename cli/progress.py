"""The progress of a relaxation on a terminal, with tqdm where it is installed."""

import math
import sys
from types import TracebackType
from typing import Any

from ..core import Iterate, RelaxOptions


class Progress:
    """A bar that runs from the first gradient norm down to the tolerance, on a logarithmic scale."""

    def __init__(self, options: RelaxOptions, shown: bool) -> None:
        self._options = options
        self._bar: Any = None
        self._start: float | None = None
        if shown:
            try:
                from tqdm import tqdm
            except ImportError:
                return
            self._bar = tqdm(total=100, bar_format="{l_bar}{bar}| {elapsed} {postfix}", leave=False)

    def __enter__(self) -> "Progress":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.close()

    def update(self, iterate: Iterate) -> None:
        """Show an iterate."""
        if self._bar is None:
            return
        bound = self._options.tolerance * math.sqrt(abs(iterate.energy))
        distance = math.log(max(iterate.gradient_norm, bound) / bound)
        if self._start is None:
            self._start = max(distance, 1e-9)
        self._bar.n = max(self._bar.n, round(100 * (1 - distance / self._start)))
        self._bar.set_postfix_str(
            f"iteration {iterate.index}, energy {iterate.energy:.6g}, gradient {iterate.gradient_norm:.2g}"
        )


def show_frames(done: int, total: int) -> None:
    """Show on one line how far a film is."""
    print(f"\rrendering frame {done} of {total}", end="\n" if done == total else "", file=sys.stderr, flush=True)
