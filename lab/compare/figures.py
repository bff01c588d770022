"""Figures by matplotlib, if it is installed: comparisons of methods, and curves in space."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core import Curve, MobiusFlowError
from ...core.base.types import FloatArray
from .comparison import History, least_energy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ENDS = {"converged": "o", "stalled": "x"}  # marks where lines end
_DASHES: Sequence[Any] = (  # one for each kind of method that there is
    *("-", "--", ":", "-.", (0, (8, 2)), (0, (3, 1, 1, 1, 1, 1))),
    *((0, (1, 4)), (0, (8, 2, 1, 2, 1, 2)), (0, (2, 2))),
)


def figure_class(instead: str = "") -> "type[Figure]":
    """Matplotlib's figure, which needs no window; a MobiusFlowError if it is missing."""
    backend = os.environ.pop("MPLBACKEND", None)  # for windows, of which there are none here; it may be nonsense
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        advice = "try pip install matplotlib" + (f", {instead}" if instead else "")
        raise MobiusFlowError(f"figures need matplotlib, which is not installed; {advice}") from error
    finally:
        if backend is not None:
            os.environ["MPLBACKEND"] = backend
    return Figure


def save(figure: "Figure", path: Path) -> None:
    """Write a figure; a .png has a palette, which nobody notices and which makes it a third of the size."""
    figure.savefig(path, dpi=100)
    if path.suffix.lower() == ".png":
        from PIL import Image  # which matplotlib needs, too

        with Image.open(path) as picture:
            picture.convert("RGB").quantize(128).save(path, optimize=True)


def write_figure(path: Path, runs: Sequence[History]) -> None:
    """Draw energy, distance to the least energy and gradient norm, over iterations and over processor seconds.

    Like Figure 3 of [RS21]: a colour for each metric, dashes for each kind of method; colours for these if all runs
    are in one metric.  Lines end in a dot where the method has converged, and in a cross where it is stuck.
    """
    figure = figure_class()(figsize=(9.5, 9.5), layout="constrained")
    from matplotlib.lines import Line2D
    from matplotlib.ticker import LogFormatter

    least = least_energy(runs)
    metrics, kinds = (list(dict.fromkeys(each)) for each in zip(*((run.metric, run.kind) for run in runs), strict=True))
    if len(metrics) > 1:
        colors = {metric: {"color": f"C{k}"} for k, metric in enumerate(metrics)}
        dashes = {kind: {"linestyle": _DASHES[k % len(_DASHES)]} for k, kind in enumerate(kinds)}
    else:
        colors, dashes = {metrics[0]: {}}, {kind: {"color": f"C{k % 10}"} for k, kind in enumerate(kinds)}
    places: dict[str, list[Sequence[float]]] = {
        "iterations": [range(run.iterations + 1) for run in runs],
        "seconds of processor time": [run.seconds for run in runs],
    }
    rows: dict[str, list[Sequence[float]]] = {
        "energy $E$": [run.energy for run in runs],
        "$E - E_{min}$": [[energy - least for energy in run.energy] for run in runs],
        "gradient norm": [run.gradient_norm for run in runs],
    }
    grid = figure.subplots(len(rows), 2, sharex="col", sharey="row")
    for row, (title, heights) in zip(grid, rows.items(), strict=True):
        for axes, (label, x), linear in zip(row, places.items(), (1.0, 0.1), strict=True):
            axes.set_xscale("symlog", linthresh=linear)
            axes.set(yscale="log", ylabel=title, xlabel=label)
            axes.label_outer()
            axes.grid(alpha=0.25)
            for run, at, y in zip(runs, x, heights, strict=True):
                style: dict[str, Any] = {"color": "0.3"} | colors[run.metric] | dashes[run.kind]
                if run.fallback:  # dots where it took over
                    style |= {"marker": "o", "markersize": 3, "markevery": list(run.fallback)}
                shown = np.where(np.asarray(y) > 0.0, y, np.nan)
                axes.plot(at, shown, linewidth=1.4, **style)
                last = np.flatnonzero(np.isfinite(shown))[-1:]
                if run.status in _ENDS and not y[-1] < 0.0:  # a line below the others' least energy has no visible end
                    axes.plot(np.asarray(at)[last], shown[last], _ENDS[run.status], color=style["color"], markersize=6)
    grid[0, 0].yaxis.set(major_formatter=LogFormatter(), minor_formatter=LogFormatter())  # 200, not 2 × 10²
    named = {**colors, **dashes} if len(metrics) > 1 else dashes
    named |= {end.replace("_", " "): {"marker": mark, "linestyle": ""} for end, mark in _ENDS.items()}
    keys = [Line2D([], [], label=name, **{"color": "0.3"} | style) for name, style in named.items()]
    figure.legend(handles=keys, loc="outside right center", frameon=False)
    if rising := [f"{run.label} in {run.rises} of {run.iterations} steps" for run in runs if run.rises]:
        figure.suptitle("E rises: " + ", ".join(rising), fontsize=8, wrap=True)
    save(figure, path)


def write_strip(stages: Sequence[int], path: Path, runs: Sequence[History]) -> None:
    """Draw the curves after some iterations, a row for each method, like Figure 1 of [RS21]."""
    cell = 1.9  # inches of a picture
    size = (cell * len(stages) + 1.2, (0.7 * cell + 0.25) * len(runs) + 0.3)
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


def draw_curve(axes: "Axes", curve: Curve, color: str, width: float) -> None:
    """Draw a curve as a strand, ``width`` points wide, over and under itself, seen from where it is broadest."""
    from matplotlib.collections import LineCollection
    from matplotlib.colors import to_rgb

    # turned so that points are broadest along x, then y; the third coordinate comes nearer
    points = np.pad(curve.vertices - curve.vertices.mean(axis=0), ((0, 0), (0, max(0, 3 - curve.dimension))))
    turn = np.linalg.svd(points, full_matrices=False)[2][:3]
    if turn.shape == (3, 3):
        turn[2] *= np.sign(np.linalg.det(turn))  # no mirror image
    points = points @ turn.T
    pieces: list[FloatArray] = []
    for edges in curve.mesh.edge_slices:
        numbers = np.arange(edges.start, edges.stop)
        parts = np.array_split(numbers, min(120, len(numbers)))  # of a polygon, drawn in front of or behind each other
        pieces += [points[[*curve.mesh.tails[part], curve.mesh.heads[part[-1]]]] for part in parts]
    pieces.sort(key=lambda piece: float(piece[:, 2].mean()))  # from far to near
    depth = np.array([piece[:, 2].mean() for piece in pieces])
    extent = float(np.ptp(points, axis=0).max())
    # 0.55: share of white in the colour of what is farthest away
    # 0.2: depth, in widths of the curve, below which its parts differ less in colour
    white = 0.55 * (depth[-1] - depth)[:, None] / max(np.ptp(depth), 0.2 * extent)
    shades = (1.0 - white) * np.array(to_rgb(color)) + white
    # each piece covers what is behind it by a broader white one
    # 0.006 of neighbouring pieces, in widths of the curve: less than a pixel
    lines = [line for piece in pieces for line in (piece[:, :2], _longer(piece[:, :2], 0.006 * extent))]
    colors = np.stack([np.ones_like(shades), shades], axis=1).reshape(-1, 3)
    widths = np.tile([2.4 * width, width], len(pieces))
    axes.add_collection(LineCollection(lines, colors=colors, linewidths=widths, capstyle="butt"))
    axes.set_aspect("equal", adjustable="datalim")
    axes.autoscale_view()
    axes.set_axis_off()


def _longer(line: FloatArray, length: float) -> FloatArray:
    """A polyline extended a little at both ends, so that no gap to the next is seen."""
    first, last = line[0] - line[1], line[-1] - line[-2]
    begin = line[0] + length * first / max(float(np.linalg.norm(first)), length)
    end = line[-1] + length * last / max(float(np.linalg.norm(last)), length)
    return np.array([begin, *line[1:-1], end])
