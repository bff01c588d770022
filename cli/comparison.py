"""The pictures of ``mobius-flow compare``: how energies and gradients fall, and what becomes of the curve."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.driver.compare import History, least_energy
from .figures import draw_curve, figure_class, name_lines, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

_ENDS = {
    "converged": "",
    "time_limit": " (time is up)",
    "iteration_limit": " (not done)",
    "stalled": " (stuck)",
}
_CELL = 1.9  # inches of a curve's picture


def write_figure(path: Path, runs: Sequence[History]) -> None:
    """Draw energy, distance to the least energy and gradient norm, over iterations and over processor seconds."""
    figure = figure_class()(figsize=(9.5, 8), layout="constrained")
    from matplotlib.ticker import LogFormatter

    least, names = least_energy(runs), [run.method + _ENDS[run.status] for run in runs]
    steps: list[Sequence[float]] = [range(run.iterations + 1) for run in runs]
    seconds: list[Sequence[float]] = [run.seconds for run in runs]
    rows: dict[str, list[Sequence[float]]] = {
        "energy $E$": [run.energy for run in runs],
        "$E - E_{min}$": [[energy - least for energy in run.energy] for run in runs],
        "gradient norm": [run.gradient_norm for run in runs],
    }
    grid = figure.subplots(len(rows), 2, sharex="col", sharey="row")
    if len({run.metric == "moebius" for run in runs}) > 1:
        figure.suptitle("solid: gradients in the metric $J_C$; dashed: in other metrics; dots: converged", fontsize=10)
    grid[-1, 0].set_xscale("symlog", linthresh=1.0)
    grid[-1, 1].set_xscale("symlog", linthresh=0.1)
    grid[-1, 0].set_xlabel("iterations")
    grid[-1, 1].set_xlabel("seconds of processor time")
    for (left, right), (title, heights) in zip(grid, rows.items(), strict=True):
        left.set(yscale="log", ylabel=title)
        for axes, places in ((left, steps), (right, seconds)):
            axes.grid(alpha=0.25)
            lines = [_draw(axes, k, *each) for k, each in enumerate(zip(runs, places, heights, strict=True))]
        name_lines(right, lines, names)
    grid[0, 0].yaxis.set(major_formatter=LogFormatter(), minor_formatter=LogFormatter())  # 200, not 2 × 10²
    save(figure, path)


def _draw(axes: "Axes", number: int, run: History, x: Sequence[float], y: Sequence[float]) -> "Line2D":
    """A method's line, with dots where it was helped and a larger one where it has converged."""
    heights = np.where(np.asarray(y) > 0.0, y, np.nan)
    style: dict[str, Any] = {
        "color": f"C{number % 10}",
        "linestyle": "-" if run.metric == "moebius" else "--",
        "linewidth": 1.6,
    }
    helped: dict[str, Any] = {"marker": "o", "markersize": 3, "markevery": list(run.fallback)} if run.fallback else {}
    (line,) = axes.plot(x, heights, **style, **helped)
    last = np.flatnonzero(np.isfinite(heights))[-1:]
    if run.status == "converged" and not y[-1] < 0.0:  # below the least energy of the others there is no end to be seen
        axes.plot(np.asarray(x)[last], heights[last], "o", color=style["color"], markersize=6)
    return line


def write_strip(stages: Sequence[int], path: Path, runs: Sequence[History]) -> None:
    """Draw the curves after some iterations, a row for each method, like Figure 1 of [RS21]."""
    size = (_CELL * len(stages) + 1.2, (0.7 * _CELL + 0.25) * len(runs) + 0.3)
    figure = figure_class()(figsize=size, layout="constrained")
    grid = figure.subplots(len(runs), len(stages), squeeze=False)
    for number, (row, run) in enumerate(zip(grid, runs, strict=True)):
        for axes, stage in zip(row, stages, strict=True):
            last = min(stage, run.iterations)
            draw_curve(axes, run.stages[last], f"C{number % 10}", 2.0)
            end = f"{run.status.replace('_', ' ')} at {last}, " if last < stage else ""
            axes.text(0.5, -0.02, f"{end}E = {run.energy[last]:.4g}", transform=axes.transAxes, ha="center", va="top")
        row[0].text(-0.08, 0.5, run.method, transform=row[0].transAxes, ha="right", va="center", fontweight="bold")
    for axes, stage in zip(grid[0], stages, strict=True):
        axes.set_title("start" if stage == 0 else f"after {stage}", fontsize=11)
    save(figure, path)
