"""Morph to Active, from the menu: shape and colors change along the keys, also where the extension is not; undo."""

import os

import bpy
import numpy as np
from case import Steps, picture, until
from hands import addon, core, entry, here, key, move, open_sidebar, region, window
from interruption import over
from scene import clear, is_

FILE = os.path.join(os.environ["ROOM"], "morphed.blend")
MODULE = "bl_ext.user_default.mobius_flow"
LENGTH = 40  # of the way there and back


def case() -> Steps:
    clear()
    settings = window().scene.mobius_flow
    settings.vertices, settings.tolerance, settings.untangle = 100, 1e-3, "never"
    settings.loop, settings.length = True, LENGTH
    window().scene.eevee.taa_samples = 1  # materials are drawn by the processor here
    woven, smooth = core("knots").knot("3_1", 60).vertices, core("knots").smooth_knot("3_1", 50).vertices
    add("Moving", woven, (0.75, 0.03, 0.02))
    goal = add("There", 0.4 * smooth, (0.02, 0.1, 0.7))
    goal.parent = holder = bpy.data.objects.new("Holder", None)
    window().scene.collection.objects.link(holder)
    holder.location, holder.rotation_euler, holder.scale = (5.0, 1.0, 0.0), (0.5, 0.2, 1.0), (1.5, 1.5, 1.5)
    add("Mirrored", 0.6 * smooth * [1, 1, -1], (0.1, 0.5, 0.1)).location = (9, 0, 0)
    with here():
        bpy.ops.view3d.view_all()
        bpy.ops.ed.undo_push(message="Curves")
    yield from open_sidebar()
    yield from becomes("There")
    yield from undone()
    yield from refused()
    yield from becomes("There")
    yield from shown_elsewhere()


def becomes(name: str) -> Steps:
    """The entry of the menu is pressed; the curve becomes the active one, and goes back."""
    start, goal = in_world("Moving"), in_world(name)
    select("Moving", name)
    yield from picture("morph-1-ready")
    yield from choose("mobius_flow_morph")
    yield from is_("done")
    report = addon("live.registry").latest().report
    assert report.certified, report.sentence
    assert report.scene_range == (1, LENGTH), report.scene_range
    for frame, wanted in ((1, start), (1 + LENGTH // 2, goal)):
        window().scene.frame_set(frame)
        keys = bpy.data.objects["Moving"].data.shape_keys
        there = in_world("Moving", keys.key_blocks[round(keys.eval_time)].data)
        near = np.linalg.norm(there[:, None] - wanted, axis=2).min(axis=0)
        assert near.max() < 1e-5, (frame, near.max())
    yield from colours("morph-2")


def colours(name: str) -> Steps:
    """In Solid shading and in that of materials the shape changes, and the color where the goal is reached."""
    with here():
        bpy.ops.object.select_all(action="DESELECT")
    space = next(area for area in window().screen.areas if area.type == "VIEW_3D").spaces.active
    for kind in ("SOLID", "MATERIAL"):
        space.shading.type, before = kind, ""
        for frame in (1, 1 + LENGTH // 4, 1 + LENGTH // 2):
            window().scene.frame_set(frame)
            for _ in range(5 if before else 40):  # shaders are compiled at first
                yield
            yield from picture(f"{name}-{kind.lower()}-{frame}", differs_from=before)
            before = f"{name}-{kind.lower()}-{frame}"
    space.shading.type = "SOLID"


def undone() -> Steps:
    """One step of undo takes keys and colors away."""
    window().scene.frame_set(1)
    yield from key("Z", ctrl=True)
    yield from until(lambda: not bpy.data.objects["Moving"].data.shape_keys, "undo")
    assert [each.name for each in bpy.data.objects["Moving"].data.materials] == ["Moving"]


def refused() -> Steps:
    """A mirror image is refused in one sentence, and nothing is lost."""
    before, last = in_world("Moving"), addon("live.registry").latest()
    select("Moving", "Mirrored")
    yield from choose("mobius_flow_morph")
    yield from until(lambda: addon("live.registry").latest() is not last, "the refused run")
    yield from over("the mirror image")
    said = str(addon("live.registry").latest().message)
    assert said.startswith("The curve that moves is 3_1, 'Mirrored' its mirror image m3_1"), said
    assert np.array_equal(in_world("Moving"), before)
    yield from picture("morph-3-refused")


def shown_elsewhere() -> Steps:
    """A file with a morph plays where the extension is switched off."""
    with here():
        bpy.ops.wm.save_as_mainfile(filepath=FILE, copy=True)
    bpy.ops.preferences.addon_disable(module=MODULE)
    with here():
        bpy.ops.wm.open_mainfile(filepath=FILE, load_ui=False)
    yield
    yield from colours("morph-4-elsewhere")


def add(name: str, vertices: np.ndarray, tint: tuple[float, float, float]) -> bpy.types.Object:
    """A tube of one color."""
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions, data.bevel_depth = "3D", 0.06
    spline = data.splines.new("POLY")
    spline.points.add(len(vertices) - 1)
    spline.points.foreach_set("co", np.column_stack([vertices, np.ones(len(vertices))]).ravel())
    spline.use_cyclic_u = True
    material = bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    material.diffuse_color = (*tint, 1.0)
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*tint, 1.0)
    data.materials.append(material)
    obj = bpy.data.objects.new(name, data)
    window().scene.collection.objects.link(obj)
    return obj


def select(*names: str) -> None:
    """Select objects, the last of them active."""
    with here():
        bpy.ops.object.select_all(action="DESELECT")
        for name in names:
            bpy.data.objects[name].select_set(True)
            window().view_layer.objects.active = bpy.data.objects[name]


def choose(operator: str) -> Steps:
    """Choose an entry of the menu."""
    main = region("WINDOW")
    x, top = main.x + 200, main.y + main.height - 40
    yield from move(x, top)
    with here():
        bpy.ops.wm.call_menu(name="VIEW3D_MT_mobius_flow")
    yield
    yield from picture("morph-0-menu")
    yield from entry(operator, x + 40, range(main.y + main.height - 10, main.y + 10, -8))


def in_world(name: str, points: object = None) -> np.ndarray:
    """Points of a curve in the world, by default those of its spline; shape (n, 3)."""
    obj = bpy.data.objects[name]
    local = np.array([point.co[:3] for point in points or obj.data.splines[0].points])
    matrix = np.array(obj.matrix_world)
    return local @ matrix[:3, :3].T + matrix[:3, 3]
