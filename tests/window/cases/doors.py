"""Hair curves, strokes and edges, relaxed by hand: cancelled, kept, dragged, undone and cleared."""

import bpy
import numpy as np
from case import Steps, picture, until
from hands import addon, button, core, here, key, open_sidebar, window
from scene import clear, endless, is_, look, obj, reaches, run, undone


def copies() -> list[bpy.types.Object]:
    return [each for each in bpy.data.objects if addon("curves.surroundings").CARRIER in each]


def show(data: bpy.types.ID) -> None:
    """Let an object with this data be all that there is, and be undone to."""
    source = bpy.data.objects.new("Source", data)
    window().scene.collection.objects.link(source)
    window().view_layer.objects.active = source
    source.select_set(True)


def is_back() -> bool:
    return [each.name for each in bpy.data.objects] == ["Source"] and obj("Source").visible_get()


def by_hand(name: str, data: bpy.types.ID) -> Steps:
    show(data)
    endless()
    with here():
        bpy.ops.ed.undo_push(message="Before")
    yield from open_sidebar()
    yield from look()
    yield from picture(f"doors-{name}-1")
    window().scene.mobius_flow.view_every = 1
    yield from button("curve.mobius_flow_relax")
    yield from reaches(3)
    (copy,) = copies()
    assert copy.type == obj("Source").type
    yield from key("ESC")
    yield from until(lambda: run() is None and is_back(), "the source")
    with here():
        bpy.ops.curve.mobius_flow_grab("INVOKE_DEFAULT")
    yield from reaches(5)
    yield from key("RET")
    yield from is_("done")
    assert len(copies()) == 1
    assert obj().data.shape_keys is not None, "the carrier is active"
    yield
    yield from picture(f"doors-{name}-2", differs_from=f"doors-{name}-1")
    yield from undone(is_back, "the relaxation")


def trefoil() -> np.ndarray:
    return core("knots").torus_knot(2, 3, 24).vertices


def become_trefoil(curves: bpy.types.bpy_struct) -> None:
    """Give hair curves, or a drawing, one closed strand that becomes thicker along the way."""
    attributes = curves.attributes
    attributes["position"].data.foreach_set("vector", trefoil().astype(np.float32).ravel())
    attributes.new("cyclic", "BOOLEAN", "CURVE").data.foreach_set("value", [True])
    attributes.new("radius", "FLOAT", "POINT").data.foreach_set("value", np.linspace(0.05, 0.15, 24))


def hair() -> Steps:
    clear()
    data = bpy.data.hair_curves.new("Source")
    data.add_curves([24])
    become_trefoil(data)
    yield from by_hand("hair", data)


def strokes() -> Steps:
    clear()
    old = not hasattr(bpy.data, "grease_pencils_v3")
    data = (bpy.data.grease_pencils if old else bpy.data.grease_pencils_v3).new("Source")
    drawing = data.layers.new("Layer").frames.new(1).drawing
    drawing.add_strokes([24])
    become_trefoil(drawing)
    yield from by_hand("strokes", data)


def edges() -> Steps:
    clear()
    data = bpy.data.meshes.new("Source")
    data.from_pydata(trefoil().tolist(), [(k, (k + 1) % 24) for k in range(24)], [])
    yield from by_hand("edges", data)


PARTS = (hair, strokes, edges)
