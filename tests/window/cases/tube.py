"""The sub-panel Tube: an artist's bevel stays, Fit Tube fits it, and meshes and smooth curves are made and undone."""

import bpy
from case import Steps, picture, until
from hands import button, here, key, move, open_panels, region, view, window
from scene import is_, look, obj, ready


def case() -> Steps:
    open_panels("shape")
    yield from ready("L2a1", vertices=0)
    obj().data.bevel_depth = 0.0625
    yield from picture("tube-1-ones-own")
    settings = window().scene.mobius_flow
    settings.max_iterations, settings.length = 12, 40
    yield from button("curve.mobius_flow_relax")
    yield from is_("done")
    assert obj().data.bevel_depth == 0.0625

    yield from button("curve.mobius_flow_fit_tube")
    yield from until(lambda: obj().data.bevel_depth != 0.0625, "the tube to fit")
    fitted = obj().data.bevel_depth
    yield from button("curve.mobius_flow_color_components")
    yield from until(lambda: len(obj().data.materials) == 2, "two materials")
    view().spaces.active.shading.color_type = "MATERIAL"  # rendered previews take minutes without a graphics card
    yield from look()
    yield from rest()
    yield from picture("tube-2-fitted-and-colored")

    curve = obj().name
    yield from button("curve.mobius_flow_tube_mesh")
    yield from until(lambda: obj().type == "MESH", "the mesh")
    assert bpy.data.objects[curve].hide_get()
    yield from picture("tube-3-mesh")
    yield from key("Z", ctrl=True)
    yield from until(lambda: obj() and obj().type == "CURVE", "undo")
    assert obj().data.bevel_depth == fitted
    with here():
        bpy.ops.curve.mobius_flow_tube_mesh("INVOKE_DEFAULT", True, color="strand_distance")
    view().spaces.active.shading.color_type = "VERTEX"
    yield from look()
    yield from rest()
    yield from picture("tube-4-distance", differs_from="tube-3-mesh")
    yield from key("Z", ctrl=True)
    yield from until(lambda: obj() and obj().type == "CURVE", "undo again")

    yield from button("curve.mobius_flow_smooth_curve")
    yield from until(lambda: obj().name == f"{curve} Smooth", "the smooth curve")
    assert {spline.type for spline in obj().data.splines} == {"BEZIER"}
    yield from rest()
    yield from picture("tube-5-smooth")


def rest() -> Steps:
    """Take the mouse away from the buttons, whose tooltips cover others."""
    main = region("WINDOW")
    yield from move(main.x + main.width // 2, main.y + 40)
