"""A goal to morph into."""

import os

import bpy
import numpy as np
from case import Steps, picture, until
from hands import core, entry, here, move, open_sidebar, region, window
from scene import add, clear, in_world, is_, keys, latest, obj, undone

CIRCLE = np.stack([np.cos(t := 2 * np.pi * np.arange(24) / 24), np.sin(t), 0 * t], axis=1)
FILE = os.path.join(os.environ["ROOM"], "morphed.blend")
MODULE = "bl_ext.user_default.mobius_flow"
LENGTH = 40  # of the way of a morph there and back


def morphed() -> Steps:
    """Shape and colors change along the keys and back, also where the extension is not."""
    clear()
    settings = window().scene.mobius_flow
    settings.vertices, settings.tolerance, settings.untangle = 100, 1e-3, "never"
    settings.loop, settings.length = True, LENGTH
    window().scene.eevee.taa_samples = 1  # materials are drawn by the processor here
    woven, smooth = core("knots").knot("3_1", 60).vertices, core("knots").smooth_knot("3_1", 50).vertices
    coloured("Moving", woven, (0.75, 0.03, 0.02))
    goal = coloured("There", 0.4 * smooth, (0.02, 0.1, 0.7))
    goal.parent = holder = bpy.data.objects.new("Holder", None)
    window().scene.collection.objects.link(holder)
    holder.location, holder.rotation_euler, holder.scale = (5.0, 1.0, 0.0), (0.5, 0.2, 1.0), (1.5, 1.5, 1.5)
    with here():
        bpy.ops.view3d.view_all()
        bpy.ops.ed.undo_push(message="Curves")
    yield from open_sidebar()
    ends = {1: in_world("Moving"), 1 + LENGTH // 2: in_world("There")}
    for again in (False, True):
        yield from chosen()
        yield from is_("done")
        if not again:
            window().scene.frame_set(1)
            yield from undone(lambda: not keys("Moving"), "the morph")
            assert [each.name for each in obj("Moving").data.materials] == ["Moving"]
    assert latest().report.certified, latest().report.sentence
    assert latest().report.scene_range == (1, LENGTH), latest().report.scene_range
    for frame, wanted in ends.items():
        window().scene.frame_set(frame)
        there = in_world("Moving", keys("Moving")[round(obj("Moving").data.shape_keys.eval_time)])
        near = np.linalg.norm(there[:, None] - wanted, axis=2).min(axis=0)
        assert near.max() < 1e-5, (frame, near.max())
    yield from colours("morph-2")
    with here():
        bpy.ops.wm.save_as_mainfile(filepath=FILE, copy=True)
    bpy.ops.preferences.addon_disable(module=MODULE)
    with here():
        bpy.ops.wm.open_mainfile(filepath=FILE, load_ui=False)
    yield
    yield from colours("morph-3-elsewhere")
    bpy.ops.preferences.addon_enable(module=MODULE)


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


def coloured(name: str, vertices: np.ndarray, tint: tuple[float, float, float]) -> bpy.types.Object:
    """A tube of one color."""
    made, material = add(name, vertices, bevel=0.06), bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    material.diffuse_color = (*tint, 1.0)
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*tint, 1.0)
    made.data.materials.append(material)
    return made


def chosen() -> Steps:
    """Select the one that moves and its goal, and choose the menu's entry."""
    last, main = latest(), region("WINDOW")
    with here():
        bpy.ops.object.select_all(action="DESELECT")
        for name in ("Moving", "There"):
            obj(name).select_set(True)
            window().view_layer.objects.active = obj(name)
    yield from move(main.x + 200, main.y + main.height - 40)
    with here():
        bpy.ops.wm.call_menu(name="VIEW3D_MT_mobius_flow")
    yield
    yield from picture("morph-0-menu")
    yield from entry("mobius_flow_morph", main.x + 240, range(main.y + main.height - 10, main.y + 10, -8))
    yield from until(lambda: latest() is not last, "the run")


PARTS = (morphed,)
