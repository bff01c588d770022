#!/usr/bin/env python3
"""Make sample files for Blender, each named after the button of the extension that is to be pressed there.

    python tools/samples.py [dist/samples]

To be run with the bpy of Blender 4.2, whose files all later ones open.
"""

import sys
from pathlib import Path

import bpy
import numpy as np
from mobius_flow.core import Curve, read_curve
from mobius_flow.core.knots import knot

ROOT = Path(__file__).resolve().parents[1]


def bundle() -> Curve:
    """Straight strands that run through each other, between two plates."""
    grid = 3.0 * np.array([(x + 0.5 * (y % 2), 0.87 * y) for x in range(3) for y in range(3)])
    t = np.linspace(0.0, 1.0, 31)[:, None]
    ends = zip(grid, np.random.default_rng(1).permutation(grid), strict=True)
    return Curve.from_components([np.hstack([(1 - t) * a + t * b, 24 * t]) for a, b in ends], [False] * len(grid))


# of each button a curve, and its bevel's part of its width
SAMPLES = {
    "Relax": (read_curve(ROOT / "examples/tangle.obj"), 0.0),
    "Separate": (bundle(), 1.0 / 24.0),
    "Tighten": (knot("3_1", 60), 0.02),
}


def main(directory: Path) -> None:
    """Write one file for each button."""
    directory.mkdir(parents=True, exist_ok=True)
    for button, (curve, bevel) in SAMPLES.items():
        bpy.ops.wm.read_factory_settings(use_empty=True)
        data = bpy.data.curves.new(button, "CURVE")
        data.dimensions = "3D"
        size = 4.0 / np.ptp(curve.vertices, axis=0).max()
        data.bevel_depth = 4.0 * bevel
        for points, closed in zip(curve.components, curve.mesh.closed, strict=True):
            spline = data.splines.new("POLY")
            spline.points.add(len(points) - 1)
            spline.points.foreach_set("co", np.pad(size * (points - curve.barycenter), ((0, 0), (0, 1))).ravel())
            spline.use_cyclic_u = bool(closed)
        made = bpy.data.objects.new(button, data)
        bpy.context.scene.collection.objects.link(made)
        bpy.context.view_layer.objects.active = made
        made.select_set(True)
        bpy.ops.wm.save_as_mainfile(filepath=str(directory / f"{button}.blend"), compress=True)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "dist/samples").resolve())
