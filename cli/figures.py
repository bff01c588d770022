"""Figures by matplotlib, where it is installed: curves of numbers with names at their ends, and curves in space."""

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core import Curve, MobiusFlowError
from ..core.types import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

DPI, COLORS = 100, 128  # of pictures made of pixels
LINE_HEIGHT = 0.065  # of an axes' height, between names at the ends of lines
FAINTEST = 0.55  # share of white in the colour of what is farthest away
PIECES = 120  # of a polygon, which are in front of each other or behind
FLAT = 0.2  # depth, in widths of the curve, below which its parts differ less in colour
OVERLAP = 0.006  # of neighbouring pieces, in widths of the curve: less than a pixel


def figure_class(instead: str = "") -> "type[Figure]":
    """Matplotlib's figure, which needs no window; a MobiusFlowError tells where it is missing."""
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
    """Write a figure; a .png has a palette, which nobody sees and which makes it a third of the size."""
    figure.savefig(path, dpi=DPI)
    if path.suffix.lower() == ".png":
        from PIL import Image  # which matplotlib needs, too

        with Image.open(path) as picture:
            picture.convert("RGB").quantize(COLORS).save(path, optimize=True)


def name_lines(axes: "Axes", lines: Sequence["Line2D"], names: Sequence[str]) -> None:
    """Write names into the right margin, each as high as its line ends, or where the next room is."""
    ends = [_end(axes, line) for line in lines]
    heights, low = np.empty(len(ends)), -np.inf
    for k in np.argsort(ends, kind="stable"):
        heights[k] = low = max(ends[k], low + LINE_HEIGHT)
    heights -= max(0.0, heights.max() - 1.0) / 2.0  # what is pushed out at the top is shared with the bottom
    for line, name, end, height in zip(lines, names, ends, heights, strict=True):
        leader = {"arrowstyle": "-", "color": line.get_color(), "linewidth": 0.6, "shrinkB": 0, "relpos": (0, 0.5)}
        places: dict[str, Any] = {
            "xy": (1.0, end),
            "xytext": (1.06, height),
            "xycoords": "axes fraction",
            "va": "center",
        }
        axes.annotate(name, **places, color=line.get_color(), fontsize=9, arrowprops=leader)


def _end(axes: "Axes", line: "Line2D") -> float:
    """How high a line ends, as a fraction of the axes' height."""
    heights = np.asarray(line.get_ydata(), dtype=np.float64)
    seen = heights[np.isfinite(heights)]
    if not len(seen):
        return 0.0
    low, high, end = axes.yaxis.get_transform().transform(np.array([*axes.get_ylim(), seen[-1]]))
    return float(np.clip((end - low) / (high - low), 0.0, 1.0))


def draw_curve(axes: "Axes", curve: Curve, color: str, width: float) -> None:
    """Draw a curve as a strand that passes over and under itself, seen from where it is broadest.

    Parameters
    ----------
    width
        Of the strand, in points.
    """
    from matplotlib.collections import LineCollection
    from matplotlib.colors import to_rgb

    points = _facing(curve.vertices)
    pieces = sorted(_pieces(curve, points), key=lambda piece: float(piece[:, 2].mean()))  # from far to near
    depth = np.array([piece[:, 2].mean() for piece in pieces])
    extent = float(np.ptp(points, axis=0).max())
    white = FAINTEST * (depth[-1] - depth)[:, None] / max(np.ptp(depth), FLAT * extent)
    shades = (1.0 - white) * np.array(to_rgb(color)) + white
    # each piece covers what is behind it by a broader one in white
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
    """A polyline that goes a little on at its ends, so that no gap is seen to the next."""
    first, last = line[0] - line[1], line[-1] - line[-2]
    begin = line[0] + length * first / max(float(np.linalg.norm(first)), length)
    end = line[-1] + length * last / max(float(np.linalg.norm(last)), length)
    return np.array([begin, *line[1:-1], end])
