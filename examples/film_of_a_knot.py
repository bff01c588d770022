"""Relax a knot in Blender, set a stage up around it and render a film: python examples/film_of_a_knot.py FILM.mp4

It runs in Blender's own Python too: blender --background --python examples/film_of_a_knot.py -- FILM.mp4
"""

import sys
from pathlib import Path

import bpy

try:
    from bl_ext.user_default.mobius_flow import Relaxation  # the extension
except ImportError:
    from mobius_flow import Relaxation, register  # the Python package

    register()  # for the operator that adds a knot


def film(path: Path, length: int = 96, size: tuple[int, int] = (640, 360), look: str = "QUICK") -> Path:
    """Film Thistlethwaite's unknot on its way to the circle, in so many frames."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.curve.mobius_flow_add_knot(knot="thistlethwaite")
    relaxation = Relaxation(bpy.context.object)
    report = relaxation.relax(length=length, hold_end=length // 8, fit_bevel=True)
    print(report.sentence)
    bpy.ops.curve.mobius_flow_color_components()
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = report.scene_range
    scene.render.resolution_x, scene.render.resolution_y = size
    relaxation.set_up_stage()
    return relaxation.film(path, look=look, overwrite=True)


if __name__ == "__main__":
    film(Path(sys.argv[-1]))
