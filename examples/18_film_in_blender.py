"""
A film from Blender, without a window
=====================================

With the Python package beside ``bpy``, or in the background of a Blender that has the extension, a script adds a knot,
keys its relaxation, sets up a stage and renders, without a click or a display.
"""

import tempfile
from pathlib import Path

import bpy
import matplotlib.pyplot as plt

try:
    from bl_ext.user_default.mobius_flow import Relaxation  # the extension
except ImportError:
    from mobius_flow import Relaxation, register  # the Python package

    register()

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.curve.mobius_flow_add_knot(knot="thistlethwaite")
relaxation = Relaxation(bpy.context.object)
report = relaxation.relax(length=12, hold_end=2, fit_bevel=True)
print(report.sentence)
assert report.certified
bpy.ops.curve.mobius_flow_color_components()

scene = bpy.context.scene
scene.frame_start, scene.frame_end = report.scene_range
scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 8, True
scene.render.resolution_x, scene.render.resolution_y = 160, 90
relaxation.set_up_stage()
folder = Path(tempfile.mkdtemp())
film = relaxation.film(folder / "film.mp4")
assert film.stat().st_size > 1000

# %%
# Four of its frames:
scene.render.resolution_x, scene.render.resolution_y = 320, 180
figure, axes = plt.subplots(2, 2, figsize=(9, 5.2), layout="constrained")
for ax, frame in zip(axes.flat, (1, 4, 7, 12), strict=True):
    scene.frame_set(frame)
    scene.render.filepath = str(folder / f"{frame}.png")
    bpy.ops.render.render(write_still=True)
    ax.imshow(plt.imread(scene.render.filepath))
    ax.set_title(f"frame {frame}", fontsize=10)
    ax.set_axis_off()
plt.show()
