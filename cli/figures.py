"""Figures by matplotlib, if it is installed: comparisons of methods, and curves in space."""

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core import Curve, MobiusFlowError
from ..core.driver.compare import History, least_energy
from ..core.types import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

DPI, COLORS = 100, 128  # of pictures made of pixels
LINE_HEIGHT = 0.065  # of an axes' height, between names at the ends of lines
FAINTEST = 0.55  # share of white in the colour of what is farthest away
PIECES = 120  # of a polygon, drawn in front of or behind each other
FLAT = 0.2  # depth, in widths of the curve, below which its parts differ less in colour
OVERLAP = 0.006  # of neighbouring pieces, in widths of the curve: less than a pixel
_ENDS = {"converged": "", "time_limit": " (time is up)", "iteration_limit": " (not done)", "stalled": " (stuck)"}
_CELL = 1.9  # inches of a curve's picture


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
    figure.savefig(path, dpi=DPI)
    if path.suffix.lower() == ".png":
        from PIL import Image  # which matplotlib needs, too

        with Image.open(path) as picture:
            picture.convert("RGB").quantize(COLORS).save(path, optimize=True)


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
    """A method's line, with dots where a fallback took over and a larger one where it has converged."""
    heights = np.where(np.asarray(y) > 0.0, y, np.nan)
    style: dict[str, Any] = {
        "color": f"C{number % 10}",
        "linestyle": "-" if run.metric == "moebius" else "--",
        "linewidth": 1.6,
    }
    helped: dict[str, Any] = {"marker": "o", "markersize": 3, "markevery": list(run.fallback)} if run.fallback else {}
    (line,) = axes.plot(x, heights, **style, **helped)
    last = np.flatnonzero(np.isfinite(heights))[-1:]
    if run.status == "converged" and not y[-1] < 0.0:  # a line below the others' least energy has no visible end
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


def name_lines(axes: "Axes", lines: Sequence["Line2D"], names: Sequence[str]) -> None:
    """Write names into the right margin, each level with its line's end or in the next free place."""
    ends = [_end(axes, line) for line in lines]
    heights, low = np.empty(len(ends)), -np.inf
    for k in np.argsort(ends, kind="stable"):
        heights[k] = low = max(ends[k], low + LINE_HEIGHT)
    heights -= max(0.0, heights.max() - 1.0) / 2.0  # overflow at the top is shared with the bottom
    for line, name, end, height in zip(lines, names, ends, heights, strict=True):
        leader = {"arrowstyle": "-", "color": line.get_color(), "linewidth": 0.6, "shrinkB": 0, "relpos": (0, 0.5)}
        style: dict[str, Any] = {"xycoords": "axes fraction", "va": "center", "fontsize": 9, "arrowprops": leader}
        axes.annotate(name, (1.0, end), (1.06, height), color=line.get_color(), **style)


def _end(axes: "Axes", line: "Line2D") -> float:
    """How high a line ends, as a fraction of the axes' height."""
    heights = np.asarray(line.get_ydata(), dtype=np.float64)
    seen = heights[np.isfinite(heights)]
    if not len(seen):
        return 0.0
    low, high, end = axes.yaxis.get_transform().transform(np.array([*axes.get_ylim(), seen[-1]]))
    return float(np.clip((end - low) / (high - low), 0.0, 1.0))


def draw_curve(axes: "Axes", curve: Curve, color: str, width: float) -> None:
    """Draw a curve as a strand, ``width`` points wide, over and under itself, seen from where it is broadest."""
    from matplotlib.collections import LineCollection
    from matplotlib.colors import to_rgb

    points = _facing(curve.vertices)
    pieces = sorted(_pieces(curve, points), key=lambda piece: float(piece[:, 2].mean()))  # from far to near
    depth = np.array([piece[:, 2].mean() for piece in pieces])
    extent = float(np.ptp(points, axis=0).max())
    white = FAINTEST * (depth[-1] - depth)[:, None] / max(np.ptp(depth), FLAT * extent)
    shades = (1.0 - white) * np.array(to_rgb(color)) + white
    # each piece covers what is behind it by a broader white one
    lines = [line for piece in pieces for line in (piece[:, :2], _longer(piece[:, :2], OVERLAP * extent))]
    colors = np.stack([np.ones_like(shades), shades], axis=1).reshape(-1, 3)
    widths = np.tile([2.4 * width, width], len(pieces))
    axes.add_collection(LineCollection(lines, colors=colors, linewidths=widths, capstyle="butt"))
    axes.set_aspect("equal", adjustable="datalim")
    axes.autoscale_view()
    axes.set_axis_off()


def _facing(vertices: FloatArray) -> FloatArray:
    """Points turned so that they are broadest along x, then y; the third coordinate comes nearer.  Shape (n, 3)."""
    points = np.pad(vertices - vertices.mean(axis=0), ((0, 0), (0, max(0, 3 - vertices.shape[1]))))
    turn = np.linalg.svd(points, full_matrices=False)[2][:3]
    if turn.shape == (3, 3):
        turn[2] *= np.sign(np.linalg.det(turn))  # no mirror image
    return np.asarray(points @ turn.T)


def _pieces(curve: Curve, points: FloatArray) -> Iterator[FloatArray]:
    """The curve cut into short polylines, each of shape (k, 3)."""
    for edges in curve.mesh.edge_slices:
        numbers = np.arange(edges.start, edges.stop)
        for part in np.array_split(numbers, min(PIECES, len(numbers))):
            yield points[[*curve.mesh.tails[part], curve.mesh.heads[part[-1]]]]


def _longer(line: FloatArray, length: float) -> FloatArray:
    """A polyline extended a little at both ends, so that no gap to the next is seen."""
    first, last = line[0] - line[1], line[-1] - line[-2]
    begin = line[0] + length * first / max(float(np.linalg.norm(first)), length)
    end = line[-1] + length * last / max(float(np.linalg.norm(last)), length)
    return np.array([begin, *line[1:-1], end])
