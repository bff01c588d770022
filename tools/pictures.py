#!/usr/bin/env python3
"""Draw docs/pictures: `pictures.py NAME …` some of them, `pictures.py` all.

    knots    sixteen knots and links of the table, as the extension adds them
    looks    a knot in each look
    morph    one famous unknot on its way to another
    cables   strands that run through each other, and six moments on their way to ropes that keep clear
    world    what curves in the world do, before and after a relaxation: world-*.png
    packed   a rope that fills a ball
    untangle the README's moving picture: another famous unknot, a rope on its way to the circle

speed.png is drawn by benchmarks/speed.py.
"""

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import bpy
import mobius_flow
import numpy as np
from matplotlib.figure import Figure
from mobius_flow.addon.pictures.export import compose, write_picture, write_still
from mobius_flow.addon.pictures.looks import LOOKS
from mobius_flow.addon.pictures.materials import bundled, colour_components
from mobius_flow.addon.pictures.rendering import empty_scene, render_still, use_cycles, use_workbench
from mobius_flow.addon.pictures.stage import Ground, build
from mobius_flow.core import (
    Curve,
    Iterate,
    RelaxOptions,
    Task,
    minimize,
    morph,
    read_curve,
    read_obstacle,
    relax,
    separate,
)
from mobius_flow.core.collision import is_rope
from mobius_flow.core.keys.key_options import Playing
from mobius_flow.core.keys.motion import recorded
from mobius_flow.core.keys.placement import Measure
from mobius_flow.core.knots import knot, overhand
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "benchmarks"))
from bundles import bundle  # noqa: E402

TARGET = ROOT / "docs" / "pictures"


def save(picture: Image.Image, name: str) -> None:
    """Store a picture with few colours, in a third of the space."""
    palette = picture.quantize(256, Image.Quantize.MAXCOVERAGE, kmeans=30)
    picture.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG).save(TARGET / f"{name}.png", optimize=True)


def knots() -> None:
    """Add the knots in rows of eight, and render them from above, without perspective."""
    names = ["3_1", "4_1", "5_1", "5_2", "6_1", "6_2", "6_3", "7_4", "7_7", "8_5", "8_18", "8_19"]
    names += ["L2a1", "L4a1", "L5a1", "L6a4"]
    step, columns, look = 2.3, 8, "PAPER"  # from one knot to the next; each is 2 wide
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mobius_flow.register()
    for k, name in enumerate(names):
        at = (step * (k % columns), -step * (k // columns), 0.0)
        bpy.ops.curve.mobius_flow_pick_knot(knot=name, thickness=0.11, location=at, color_components=False)
        colour_components(bpy.context.object.data, look=look)
    scene = bpy.context.scene
    width, height = step * columns, step * (len(names) // columns)
    middle = np.array([0.5 * (width - step), -0.5 * (height - step), 0.0])
    floor = build(scene.collection, Ground(np.eye(3), middle, 0.6 * width, 0.5 * np.pi, 1.0), LOOKS[look])
    floor.location = middle - [0.0, 0.0, 1.0]
    scene.world = bundled("worlds", LOOKS[look].label)
    data = bpy.data.cameras.new("Camera")
    data.type, data.ortho_scale = "ORTHO", width
    scene.camera = bpy.data.objects.new("Camera", data)
    scene.collection.objects.link(scene.camera)
    scene.camera.location, scene.camera.rotation_euler = middle + np.array([0.0, 0.0, 20.0]), (0.0, 0.0, 0.0)
    use_cycles(scene, LOOKS[look], 1000, 268)
    scene.render.image_settings.color_mode = "RGB"
    scene.render.filepath = str(TARGET / "knots.png")
    bpy.ops.render.render(write_still=True)
    save(Image.open(TARGET / "knots.png").convert("RGB"), "knots")


def cables() -> None:
    """Render moments of the motion of a bundle from the side, each as far from the one before, as thick tubes."""
    curve, path = bundle(76)[0], list[Curve]()
    separate(curve, 1.0, callback=lambda iterate: path.append(iterate.curve))
    shapes = np.array([each.vertices for each in path])
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(shapes, axis=0), axis=2).max(axis=1))])
    shown = [int(np.abs(way - share * way[-1]).argmin()) for share in (0.0, 0.15, 0.3, 0.5, 0.75, 1.0)]
    side, look, whole = (200, 420), LOOKS["STUDIO"], Image.new("RGB", (6 * 200, 420))
    for k, vertices in enumerate(shapes[shown]):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        data, scene = bpy.data.curves.new("Bundle", "CURVE"), bpy.context.scene
        data.dimensions, data.bevel_depth, data.bevel_resolution, data.use_fill_caps = "3D", 1.0, 6, True
        for part in curve.mesh.slices:
            spline = data.splines.new("POLY")
            spline.points.add(part.stop - part.start - 1)
            spline.points.foreach_set("co", np.column_stack([vertices[part], np.ones(part.stop - part.start)]).ravel())
        scene.collection.objects.link(bpy.data.objects.new("Bundle", data))
        colour_components(data, look="STUDIO")
        middle = 0.5 * (curve.vertices.min(axis=0) + curve.vertices.max(axis=0))
        height = 1.08 * float(np.ptp(curve.vertices[:, 2]))
        upright = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
        build(scene.collection, Ground(upright, middle, 0.6 * height, 0.5 * np.pi, 1.0), look).location = [
            0.0,
            100.0,
            0.0,
        ]
        scene.world, lens = bundled("worlds", look.label), bpy.data.cameras.new("Camera")
        lens.type, lens.ortho_scale, lens.sensor_fit = "ORTHO", height, "VERTICAL"
        scene.camera = bpy.data.objects.new("Camera", lens)
        scene.collection.objects.link(scene.camera)
        scene.camera.location, scene.camera.rotation_euler = middle - [0.0, 60.0, 0.0], (0.5 * np.pi, 0.0, 0.0)
        use_cycles(scene, look, *side)
        scene.render.image_settings.color_mode, scene.render.filepath = "RGB", str(TARGET / "cables.png")
        bpy.ops.render.render(write_still=True)
        whole.paste(Image.open(TARGET / "cables.png").convert("RGB"), (side[0] * k, 0))
    save(whole, "cables")


def strip(name: str, parts: Sequence[tuple[Curve, str]], columns: int, side: int = 300) -> None:
    """Put curves in rows, each in a look."""
    whole = Image.new("RGB", (side * columns, side * -(-len(parts) // columns)))
    with tempfile.TemporaryDirectory() as room:
        for k, (curve, look) in enumerate(parts):
            write_picture(Path(room, "part.png"), curve, side, side, look)
            part = Image.open(Path(room, "part.png")).convert("RGB")
            whole.paste(part, (side * (k % columns), side * (k // columns)))
    save(whole, name)


def looks() -> None:
    curve = minimize(knot("5_1")).curve
    strip("looks", [(curve, look) for look in LOOKS], 5)


def unknots() -> None:
    iterates: list[Iterate] = []
    morph(knot("ochiai-1"), knot("thistlethwaite"), callback=iterates.append)
    legs = (0, 20, 44, 64, 108, -1)  # where tubes are about as thick in the picture
    strip("morph", [(iterates[k].curve, "STUDIO") for k in legs], 3)


def before_and_after(name: str, task: Task, **options: Any) -> None:
    """The refined curve on the left, the relaxed one on the right; pins are dots, and obstacles transparent."""
    iterates: list[Any] = []
    result = minimize(task, RelaxOptions(**options), iterates.append)
    print(f"{name}: {result.message}; certified {result.certified}")
    shown = [iterates[0], iterates[-1]]
    frame = np.concatenate([*(each.curve.vertices for each in shown), *(each.vertices for each in task.obstacles)])
    low, high = frame.min(axis=0), frame.max(axis=0)
    half, middle = 0.42 * float(np.max(high - low)), 0.5 * (low + high)
    figure = Figure(figsize=(7, 3.5), layout="constrained")
    for k, iterate in enumerate(shown):
        axes, curve = figure.add_subplot(1, 2, k + 1, projection="3d"), iterate.curve
        for obstacle in task.obstacles:
            style = {"facecolor": (0.4, 0.5, 0.7, 0.06), "edgecolor": "none"}
            axes.add_collection3d(Poly3DCollection(obstacle.corners, **style))
        for number, (points, closed) in enumerate(zip(curve.components, curve.mesh.closed, strict=True)):
            axes.plot(*np.concatenate([points, points[: int(closed)]]).T, color=f"C{number}", linewidth=2)
        if iterate.pins:
            axes.scatter(*curve.vertices[list(iterate.pins)].T, color="black", s=25, depthshade=False)
        axes.set(**{f"{x}lim": (at - half, at + half) for x, at in zip("xyz", middle, strict=True)})
        axes.set_box_aspect((1, 1, 1))
        axes.view_init(elev=55, azim=-60)
        axes.set_axis_off()
    figure.savefig(TARGET / f"world-{name}.png", dpi=90)


def world() -> None:
    def fitted(curve: Curve, radius: float) -> Curve:
        """The curve moved and scaled into the ball of a radius around the origin."""
        centred = curve.vertices - 0.5 * (curve.vertices.max(axis=0) + curve.vertices.min(axis=0))
        return curve.with_vertices(radius / np.linalg.norm(centred, axis=1).max() * centred)

    ball = (read_obstacle(ROOT / "examples" / "obstacles" / "icosphere.obj"),)
    arc = overhand(60)
    before_and_after("components", Task(curve=knot("L6a4")), vertices=240)
    before_and_after("open", Task(curve=arc), max_iterations=12)
    before_and_after("pins", Task(curve=arc, pins=(0, 59), pin_tangents=True))
    inside = Task(curve=fitted(knot("4_1"), 1.3), obstacles=ball)
    before_and_after("confined", inside, vertices=120, max_iterations=60)
    small = Task(curve=fitted(knot("3_1"), 0.5), obstacles=ball)
    before_and_after("growth", small, vertices=60, mesh="finer", grow=12.0, max_iterations=90)


def packed() -> None:
    iterates: list[Iterate] = []
    task = Task(curve=knot("3_1"), obstacles=(read_obstacle(ROOT / "examples" / "ball.obj"),))
    minimize(task, RelaxOptions(grow=14.0, radius=0.1, max_iterations=190, tolerance=1e-3), iterates.append)
    with tempfile.TemporaryDirectory() as room:
        write_still(path := Path(room, "packed.png"), iterates, "STUDIO")
        save(Image.open(path).convert("RGB").crop((200, 0, 600, 450)).resize((320, 360)), "packed")


def untangle() -> None:
    """Every second frame of the film, which repeats; the first one is the still for those who see no motion."""
    motion, _ = recorded([*relax(read_curve(ROOT / "examples" / "tangle.obj"))], Measure.RADIUS)
    playing = Playing().timed(motion.way)
    keys, mesh = motion.keys(is_rope, playing.timing.length, playing.timing), motion.start.mesh
    frames = playing.timing.frames(motion.course(keys))
    scene = empty_scene()
    use_workbench(scene, 480, 360)
    compose(scene, keys, frames, mesh, playing)
    first, last = playing.timing.scene_range(frames)
    with tempfile.TemporaryDirectory() as room:
        paths = [Path(room, f"{frame}.png") for frame in range(first, last + 1, 2)]
        for path in paths:
            scene.frame_set(int(path.stem))
            render_still(scene, path)
        still, *others = (Image.open(path).convert("RGB") for path in paths)
        shown = {"save_all": True, "append_images": others, "duration": 1000 // 12, "loop": 0}
        still.save(TARGET / "untangle.webp", quality=60, method=6, **shown)


if __name__ == "__main__":
    drawn = {"knots": knots, "cables": cables, "looks": looks, "morph": unknots, "world": world, "packed": packed}
    drawn["untangle"] = untangle
    for wanted in sys.argv[1:] or drawn:
        drawn[wanted]()
