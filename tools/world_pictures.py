"""Draw docs/pictures/world-*.png: what curves in the world do, before and after a relaxation.

python tools/world_pictures.py
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from mobius_flow.core import Curve, Obstacle, RelaxOptions, Task, minimize, read_obstacle
from mobius_flow.core.base.types import FloatArray
from mobius_flow.core.knots import knot, overhand
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

ROOT = Path(__file__).resolve().parents[1]
TARGET = ROOT / "docs" / "pictures"
OBSTACLES = ROOT / "examples" / "obstacles"


def fitted(curve: Curve, radius: float) -> Curve:
    """The curve moved and scaled into the ball of a radius around the origin."""
    centred = curve.vertices - 0.5 * (curve.vertices.max(axis=0) + curve.vertices.min(axis=0))
    return curve.with_vertices(radius / np.linalg.norm(centred, axis=1).max() * centred)


def draw(axes: Any, curve: Curve, obstacles: Sequence[Obstacle], pins: Sequence[int], frame: FloatArray) -> None:
    """One curve, with pins as dots and obstacles transparent; the view shows the points of a frame."""
    for obstacle in obstacles:
        axes.add_collection3d(Poly3DCollection(obstacle.corners, facecolor=(0.4, 0.5, 0.7, 0.06), edgecolor="none"))
    for number, (points, closed) in enumerate(zip(curve.components, curve.mesh.closed, strict=True)):
        axes.plot(*np.concatenate([points, points[: int(closed)]]).T, color=f"C{number}", linewidth=2)
    if pins:
        axes.scatter(*curve.vertices[list(pins)].T, color="black", s=25, depthshade=False)
    low, high = frame.min(axis=0), frame.max(axis=0)
    half, middle = 0.42 * float(np.max(high - low)), 0.5 * (low + high)
    axes.set(xlim=middle[0] + [-half, half], ylim=middle[1] + [-half, half], zlim=middle[2] + [-half, half])
    axes.set_box_aspect((1, 1, 1))
    axes.view_init(elev=55, azim=-60)
    axes.set_axis_off()


def picture(name: str, curve: Curve, **options: Any) -> None:
    """The refined curve on the left, the relaxed one on the right."""
    still = {name: options.pop(name) for name in ("obstacles", "pins", "pin_tangents") if name in options}
    task = Task(curve=curve, **still)
    iterates: list[Any] = []
    result = minimize(task, RelaxOptions(**options), iterates.append)
    print(f"{name}: {result.message}; certified {result.certified}")
    shown = [iterates[0], iterates[-1]]
    frame = np.concatenate([*(i.curve.vertices for i in shown), *(each.vertices for each in task.obstacles)])
    figure = Figure(figsize=(7, 3.5), layout="constrained")
    for k, iterate in enumerate(shown):
        draw(figure.add_subplot(1, 2, k + 1, projection="3d"), iterate.curve, task.obstacles, iterate.pins, frame)
    figure.savefig(TARGET / f"world-{name}.png", dpi=90)


def main() -> None:
    """Draw all of them."""
    sphere = read_obstacle(OBSTACLES / "icosphere.obj")
    arc = overhand(60)
    picture("components", knot("L6a4"), vertices=240)
    picture("open", arc, max_iterations=12)
    picture("pins", arc, pins=(0, 59), pin_tangents=True)
    picture("confined", fitted(knot("4_1"), 1.3), obstacles=(sphere,), vertices=120, max_iterations=60)
    small = fitted(knot("3_1"), 0.5)
    picture("growth", small, obstacles=(sphere,), vertices=60, mesh="finer", grow=12.0, max_iterations=90)


if __name__ == "__main__":
    main()
