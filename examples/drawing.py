"""Draw curves as knots are drawn on paper: near strands interrupt far ones."""

import numpy as np
from matplotlib import colors
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from mobius_flow.core import Curve

COLORS = ("#c8553d", "#3d7ea6", "#d9a441", "#5b8e7d", "#7a5c99", "#8a8d91")


def view(curve: Curve) -> np.ndarray:
    """The axes of the widest view, as columns: right, up, and towards the eye."""
    spread = np.linalg.svd(curve.vertices - curve.vertices.mean(axis=0), full_matrices=False)[2].T
    return spread * [1.0, 1.0, np.sign(np.linalg.det(spread))]


def draw(ax: Axes, curve: Curve, title: str = "", *, frame: np.ndarray | None = None, width: float = 4.0) -> None:
    """Draw a curve, a color for each component, with the axes given or in its widest view."""
    right_up_near = (curve.vertices - curve.vertices.mean(axis=0)) @ (view(curve) if frame is None else frame)
    tails, heads = right_up_near[curve.mesh.tails], right_up_near[curve.mesh.heads]
    reach = 0.25 * (heads - tails)  # strokes overlap their neighbours; what interrupts other strands does not
    color = np.concatenate(
        [np.tile(colors.to_rgb(COLORS[k % len(COLORS)]), (edges.stop - edges.start, 1))
         for k, edges in enumerate(curve.mesh.edge_slices)]
    )  # fmt: skip
    order = np.argsort((tails + heads)[:, 2])
    gaps, strokes = np.stack([tails, heads], axis=1), np.stack([tails - reach, heads + reach], axis=1)
    segments = np.stack([gaps[order], strokes[order]], axis=1).reshape(-1, 2, 3)[..., :2]
    paint = np.stack([np.ones_like(color), color[order]], axis=1).reshape(-1, 3)
    ax.add_collection(LineCollection(segments, colors=paint, linewidths=[2.2 * width, width] * len(tails)))
    ax.set_aspect("equal")
    ax.margins(0.12)
    ax.autoscale_view()
    ax.set_axis_off()
    ax.set_title(title, fontsize=10)
