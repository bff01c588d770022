"""The plot of the energy against the iterations, in pixels."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.types import FloatArray
from .rest import Target

_DECADE = 10.0  # ratio of energies from which they are drawn on a logarithmic scale
_ROOM = 0.06  # of the height, kept free above and below


@dataclass(frozen=True, eq=False)
class Plot:
    """What is drawn, in pixels from the lower left corner."""

    line: FloatArray  # the energies; shape (k, 2), at most two points for a pixel's width
    target: float | None  # height of the target's line, if there is one


def plot(energies: Sequence[float], target: Target | None, width: float, height: float) -> Plot:
    """Lay out the energies of the iterates, of which there is at least one, and their target."""
    count = len(energies)  # of which the first, the last, and evenly spread ones in between are drawn
    chosen = np.unique(np.linspace(0, count - 1, min(count, max(2 * int(width), 2))).round().astype(np.intp))
    values = np.asarray(energies, dtype=np.float64)[chosen]
    low = min(values.min(), np.inf if target is None else target.energy)
    scale = np.log if low > 0.0 and _DECADE * low < values.max() else np.positive
    bottom, top = scale(np.array([low, values.max()]))

    def heights(of: FloatArray) -> FloatArray:
        share = (scale(of) - bottom) / (top - bottom) if top > bottom else np.full(of.shape, 0.5)
        return np.asarray(height * (_ROOM + (1.0 - 2.0 * _ROOM) * share))

    x = width * chosen / max(count - 1, 1)
    level = None if target is None else float(heights(np.array([target.energy]))[0])
    return Plot(np.column_stack([x, heights(values)]), level)


def dashes(length: float, period: float) -> FloatArray:
    """Ends of dashes along a line, as pairs; shape (2 k, )."""
    starts = np.arange(0.0, length, period)
    return np.column_stack([starts, np.minimum(starts + 0.5 * period, length)]).ravel()
