#!/usr/bin/env python3
"""Render docs/pictures/knots.png: sixteen knots and links of the table, as the extension adds them."""

import sys
from pathlib import Path

import bpy
import mobius_flow
import numpy as np
from mobius_flow.addon.pictures.looks import LOOKS
from mobius_flow.addon.pictures.materials import colour_components
from mobius_flow.addon.pictures.rendering import use_cycles
from mobius_flow.addon.pictures.stage import Stage, build, sky
from mobius_flow.core.base.types import FloatArray
from PIL import Image

TARGET = Path(__file__).resolve().parents[1] / "docs" / "pictures" / "knots.png"
KNOTS = ["3_1", "4_1", "5_1", "5_2", "6_1", "6_2", "6_3", "7_4", "7_7", "8_5", "8_18", "8_19"]
LINKS = ["L2a1", "L4a1", "L5a1", "L6a4"]
COLUMNS, WIDTH, HEIGHT = 8, 1000, 268
STEP = 2.3  # from one knot to the next; each is 2 wide
THICKNESS = 0.11
COLORS = 256
LOOK = "PAPER"


def main() -> int:
    """Add the knots in rows, and render them from above."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mobius_flow.register()
    for k, name in enumerate(KNOTS + LINKS):
        at = (STEP * (k % COLUMNS), -STEP * (k // COLUMNS), 0.0)
        bpy.ops.curve.mobius_flow_pick_knot(knot=name, thickness=THICKNESS, location=at, color_components=False)
        colour_components(bpy.context.object.data, look=LOOK)
    scene = bpy.context.scene
    width, height = STEP * COLUMNS, STEP * (len(KNOTS + LINKS) // COLUMNS)
    middle = np.array([0.5 * (width - STEP), -0.5 * (height - STEP), 0.0])
    floor = build(scene.collection, Stage(np.eye(3), middle, 0.6 * width, 0.5 * np.pi), LOOKS[LOOK])
    floor.location = middle - [0.0, 0.0, 1.0]
    scene.world = sky(LOOKS[LOOK], "World")
    add_camera(scene, middle, width)
    use_cycles(scene, LOOKS[LOOK], WIDTH, HEIGHT)
    scene.render.image_settings.color_mode = "RGB"
    scene.render.filepath = str(TARGET)
    bpy.ops.render.render(write_still=True)
    shrink()
    return 0


def shrink() -> None:
    """Store the picture with few colours, in a third of the space."""
    picture = Image.open(TARGET).convert("RGB")
    palette = picture.quantize(COLORS, Image.Quantize.MAXCOVERAGE, kmeans=30)
    picture.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG).save(TARGET, optimize=True)


def add_camera(scene: bpy.types.Scene, middle: FloatArray, width: float) -> None:
    """Look straight down, without perspective."""
    data = bpy.data.cameras.new("Camera")
    data.type, data.ortho_scale = "ORTHO", width
    camera = bpy.data.objects.new("Camera", data)
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.location, camera.rotation_euler = middle + np.array([0.0, 0.0, 20.0]), (0.0, 0.0, 0.0)


if __name__ == "__main__":
    sys.exit(main())
