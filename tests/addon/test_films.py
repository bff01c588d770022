"""What every film promises: proved keys, the same again, more after them, and all given back in the end."""

from itertools import pairwise

import bpy
import numpy as np
import pytest
from baked_curves import again, clear, go_on, last_frame, reopen, two_rings
from blender_scenes import add_curve, add_trefoil, evaluated, place, relax, stored
from families import crossed
from mathutils import Vector
from mobius_flow.addon.curves import pins
from mobius_flow.addon.curves.recorded import BakedKeys
from mobius_flow.core.collision import is_free
from mobius_flow.core.knots import knot, overhand
from modal_operator import everything, ring_and_torus
from shapes import regular_polygon, torus_trefoil

ARC = overhand(60).vertices.astype(np.float32)


def link_of_kind(kind):
    """Splines whose points have values, handles and settings of their own."""
    rng = np.random.default_rng(7)
    obj = add_curve([torus_trefoil(24).vertices + 4 * k for k in (0, 1)], kind=kind)
    for spline in obj.data.splines:
        spline.resolution_u = 5
        for point in spline.bezier_points if kind == "BEZIER" else spline.points:
            point.radius, point.tilt = rng.random(2)
            if kind == "BEZIER":
                point.handle_left_type = point.handle_right_type = "ALIGNED"
                point.handle_right = Vector(point.co) + Vector((0.1, 0.2, 0.3))
    obj.data.splines[1].material_index, obj.data.splines[0].use_smooth = 2, False
    obj.data.splines.active = obj.data.splines[0]
    return {"sample_splines": True, "vertices": 300}


def open_and_closed():
    """In one object, which is placed somewhere."""
    obj = add_curve([regular_polygon(30).vertices + np.array([0.0, 0.0, 20.0]), ARC])
    obj.data.splines[1].use_cyclic_u = False
    place(obj)


def pinned():
    """At its ends, and in the middle of the arc."""
    obj = add_curve([ARC], cyclic=False)
    pins.pin(obj.data.splines[0], np.isin(np.arange(60), (0, 20, 59)))


def beside():
    _, torus = ring_and_torus()
    collection = bpy.data.collections.new("Avoid")
    collection.objects.link(torus)
    collection.use_fake_user = True
    return {"avoid": "Avoid"}


def several():
    """Renamed, and one of them turned."""
    pair = two_rings()
    pair[0].name, pair[0].data.name = "Renamed", "Also"


def growing():
    add_curve([regular_polygon(40).vertices * [1.0, 0.8, 1.0]])
    return {"grow": 1.2}


def untangled():
    add_curve([knot("braid(1,-2,3)", 40).vertices])  # an unknot
    return {"untangle": "always", "max_keys": 60}


def fitted():
    add_trefoil().data.bevel_depth = 0.1
    return {"fit_bevel": True}


SCENES = {
    **{kind: lambda kind=kind: link_of_kind(kind) for kind in ("POLY", "BEZIER", "NURBS")},
    **{act.__name__: act for act in (open_and_closed, pinned, beside, several, growing, untangled, fitted)},
}


def selected():
    return sorted(bpy.context.selected_objects, key=lambda obj: obj.name)


@pytest.mark.parametrize(("scene", "reopened"), crossed(SCENES, [False, True]))
def test_the_life_of_a_film(tmp_path, capfd, scene, reopened):
    options = {"max_iterations": 3} | (SCENES[scene]() or {})
    bpy.context.view_layer.update()
    cyclic = {obj.name: [spline.use_cyclic_u for spline in obj.data.splines] for obj in selected()}
    active = [obj.data.splines.active == obj.data.splines[0] for obj in selected()]
    before = everything()
    relax(**options)
    assert "proved free of contact with" in capfd.readouterr().out
    frames, last = BakedKeys(selected()).frames, max(map(last_frame, selected()))
    names = {kind: found for kind, found in everything().items() if kind in ("curves", "shape_keys", "actions")}
    again(**options)
    keys = BakedKeys(selected())
    np.testing.assert_array_equal(keys.frames, frames)
    assert keys.unproved == 0
    for a, b in pairwise(keys.frames[:10]):
        assert is_free(keys.mesh, a.astype(float), b.astype(float))
    if scene != "fitted":  # a tube has points of its own
        np.testing.assert_array_equal(np.concatenate([evaluated(obj, 1) for obj in selected()]), frames[0])
    assert {kind: found for kind, found in everything().items() if kind in names} == names
    if reopened:
        reopen(tmp_path / "a.blend")
    left_out = ("sample_splines", "vertices", "max_keys")
    go_on(**{name: value for name, value in options.items() if name not in left_out} | {"keyframes": "RESULT"})
    keys = BakedKeys(selected())
    if scene != "growing":  # edges of earlier keys are split, too
        np.testing.assert_array_equal(keys.frames[: len(frames)], frames)
    assert len(keys.frames) > len(frames)
    assert max(map(last_frame, selected())) > last
    assert keys.unproved == 0
    assert {obj.name: [spline.use_cyclic_u for spline in obj.data.splines] for obj in selected()} == cyclic
    clear()
    assert everything() == before
    left = {name for obj in selected() for name in obj.data.keys() if "tube" not in name}  # noqa: SIM118
    assert not left
    assert [obj.data.splines.active == obj.data.splines[0] for obj in selected()] == active
    if scene == "pinned":
        np.testing.assert_array_equal(pins.places(selected()[0].data), stored(selected()[0].data)[[0, 20, 59]])
