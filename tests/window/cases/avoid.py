"""A ring around a mesh torus by mouse clicks: named, avoided, relaxed around it, undone; what moves is refused."""

from contextlib import suppress

import bpy
import numpy as np
from case import Steps, picture, until
from hands import addon, button, here, key, open_panels, open_sidebar, window
from scene import clear, is_, reaches, run

MANY = 800  # vertices: steps take long enough for a hand to get between them


def case() -> Steps:
    open_panels("surroundings")
    with here():
        clear()
        add_torus()
        add_ring()
        bpy.ops.ed.undo_push(message="Ring and torus")
    before = points()
    yield from open_sidebar()
    yield from look_at_all()
    yield from picture("avoid-1-may-be-crossed")
    yield from button("curve.mobius_flow_avoid")
    yield from until(lambda: settings().avoid is not None, "the collection")
    assert [obj.name for obj in settings().avoid.objects] == ["Torus"]
    yield from picture("avoid-2-avoided")
    yield from moved(before)
    yield from relaxed(before)
    yield from refused()


def relaxed(before: np.ndarray) -> Steps:
    """The ring stays around the tube at every key, and undo gives all back, then empties the collection."""
    window().scene.mobius_flow.vertices = 0
    yield from button("curve.mobius_flow_relax")
    yield from is_("done")
    said = str(addon("live.registry").latest().message)
    print("MEASURED", said, flush=True)
    assert said.endswith("free of contact with itself, and with 'Torus'"), said
    blocks = ring().data.shape_keys.key_blocks
    assert len(blocks) > 5
    numbers = {linking_number(np.array([p.co[:] for p in block.data])) for block in blocks}
    assert numbers == {linking_number(before)} != {0}
    yield from look_at_all()
    yield from picture("avoid-3-relaxed", differs_from="avoid-2-avoided")
    yield from key("Z", ctrl=True)
    yield from until(lambda: ring().data.shape_keys is None, "undo of Relax")
    assert np.array_equal(points(), before)
    assert settings().avoid is not None


def moved(before: np.ndarray) -> Steps:
    """To move what is avoided ends the run."""
    window().scene.mobius_flow.vertices = MANY
    yield from button("curve.mobius_flow_relax")
    yield from reaches(1)
    run().toggle_pause()
    torus().location.x += 0.5
    yield from is_("lost")
    torus().location.x = 0
    assert np.array_equal(points(), before)


def refused() -> Steps:
    """What moves cannot be avoided, and the panel says so."""
    with here():
        torus().keyframe_insert("location", frame=1)
        bpy.ops.ed.undo_push(message="Key")
    yield from look_at_all()
    yield from picture("avoid-4-moves")
    with here(), suppress(RuntimeError):
        assert bpy.ops.curve.mobius_flow_relax("INVOKE_DEFAULT") == {"CANCELLED"}
    assert run() is None


def look_at_all() -> Steps:
    """See both."""
    with here():
        bpy.ops.view3d.view_all()
    yield


def add_torus() -> None:
    bpy.ops.mesh.primitive_torus_add(major_radius=1, minor_radius=0.25)
    torus().select_set(False)


def add_ring() -> None:
    """A ring around the tube, so long that it would slip off if nothing were there."""
    t = 2 * np.pi * np.arange(24) / 24
    data = bpy.data.curves.new("Ring", "CURVE")
    data.dimensions, data.bevel_depth = "3D", 0.04
    spline = data.splines.new("POLY")
    spline.points.add(23)
    spline.use_cyclic_u = True
    places = np.stack([1 + np.cos(t), 0 * t, 4 * np.sin(t), 1 + 0 * t], axis=1)
    spline.points.foreach_set("co", places.ravel())
    obj = bpy.data.objects.new("Ring", data)
    window().scene.collection.objects.link(obj)
    obj.select_set(True)
    window().view_layer.objects.active = obj


def settings() -> bpy.types.PropertyGroup:
    return window().scene.mobius_flow_surroundings


def torus() -> bpy.types.Object:
    return bpy.data.objects["Torus"]


def ring() -> bpy.types.Object:
    return bpy.data.objects["Ring"]


def points() -> np.ndarray:
    return np.array([p.co[:3] for p in ring().data.splines[0].points], dtype=np.float32)


def linking_number(loop: np.ndarray) -> int:
    """With the middle of the tube, the circle of radius 1: signed passages of edges through its disc."""
    a, b = loop.astype(float), np.roll(loop, -1, axis=0).astype(float)
    through = np.flatnonzero((a[:, 2] > 0) != (b[:, 2] > 0))
    share = a[through, 2] / (a[through, 2] - b[through, 2])
    there = a[through] + share[:, None] * (b - a)[through]
    inside = np.hypot(there[:, 0], there[:, 1]) < 1
    return int(np.sign(b[through, 2] - a[through, 2])[inside].sum())
