"""Pack by a click: the knot grows inside its container until it is kept, and its tube is as thick as there is room."""

import bpy
import numpy as np
from case import Steps, picture
from hands import addon, button, here, open_panels, open_sidebar, window
from scene import clear, is_, knot, look, obj, points, reaches


def case() -> Steps:
    clear()
    open_panels("surroundings")
    knot("3_1", 0)
    with here():
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=1.6, location=obj().location)
        ball = bpy.context.object
        ball.display_type = "WIRE"
        ball.select_set(False)
        window().view_layer.objects.active = next(each for each in bpy.data.objects if each.type == "CURVE")
        obj().select_set(True)
    window().scene.mobius_flow_surroundings.container = ball
    window().scene.mobius_flow.view_every = 1
    yield from open_sidebar()
    yield from look()
    before, depth = length(), obj().data.bevel_depth
    yield from picture("pack-1-ready")
    yield from button("curve.mobius_flow_pack")
    yield from reaches(25)
    yield from picture("pack-2-grows", differs_from="pack-1-ready")
    assert length() > 1.3 * before
    assert obj().data.bevel_depth != depth, "the tube follows"
    yield from button("curve.mobius_flow_stop")
    yield from is_("done")
    yield from picture("pack-3-kept", differs_from="pack-1-ready")
    report = addon("live.registry").latest().report
    assert report.certified
    assert report.avoided == ("Icosphere",)


def length() -> float:
    """That of the knot."""
    there = points().astype(float)
    return float(np.linalg.norm(np.roll(there, -1, axis=0) - there, axis=1).sum())
