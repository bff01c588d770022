"""An artist's bevel is changed only if somebody asks for that; a fitted one is kept fitting."""

import bpy
import pytest
from blender_scenes import add_curve, add_hopf_link, add_trefoil, in_world, stored
from families import crossed
from mobius_flow.addon.curves import bevel
from mobius_flow.addon.curves.recorded import BakedKeys
from mobius_flow.core import Curve
from mobius_flow.core.collision import thickness
from mobius_flow.core.curve.distances import nearest_strands
from mobius_flow.core.keys.recording import Kind
from mobius_flow.core.keys.tube import free_radius, thickest_radius
from mobius_flow.core.knots import knot
from shapes import hopf_link

SHORT = {"max_iterations": 4}


def relax(**options):
    """Relax with the panel's settings, unlike the tests' usual `relax`."""
    assert bpy.ops.curve.mobius_flow_relax(**SHORT, **options) == {"FINISHED"}


def fit():
    assert bpy.ops.curve.mobius_flow_fit_tube() == {"FINISHED"}


def drawn(data):
    return data.bevel_depth, data.bevel_resolution, data.bevel_mode, data.extrude, data.offset, data.taper_object


def taper(data):
    data.taper_object = bpy.data.objects.new("Taper", bpy.data.curves.new("Taper", "CURVE"))


BEVELS = {
    "none": lambda data: None,
    "plain": lambda data: setattr(data, "bevel_depth", 0.125),
    "profile": lambda data: setattr(data, "bevel_mode", "PROFILE"),
    "extruded": lambda data: setattr(data, "extrude", 0.25),
    "tapered": taper,
}


@pytest.mark.parametrize(("bevel", "keyframes"), crossed(BEVELS, ["SHAPE_KEYS", "RESULT"]))
def test_ones_own_is_not_changed(bevel, keyframes):
    obj = add_trefoil()
    BEVELS[bevel](obj.data)
    before = drawn(obj.data)
    relax(keyframes=keyframes)
    assert drawn(obj.data) == before
    blocks = obj.data.shape_keys.key_blocks if obj.data.shape_keys else []
    assert all(point.radius == 1 for block in blocks for point in block.data)


@pytest.mark.parametrize(("share", "kept"), [(0.95, True), (1.2, False)])
def test_ones_own_never_meets_itself(share, kept, capfd):
    """At all iterates the curve has room for the bevel, unless it had none to begin with."""
    curve = knot("goeritz")
    obj = add_curve([curve.vertices])
    obj.data.bevel_depth = depth = share * thickness(curve)
    assert bpy.ops.curve.mobius_flow_relax(radius="keep") == {"FINISHED"}
    shown = zip(BakedKeys([obj]).frames, obj.data.shape_keys.key_blocks, strict=True)
    frames = [frame for frame, block in shown if not block.name.startswith(Kind.ADDED.value)]
    assert bevel.own_radii([obj]) == pytest.approx((depth,))
    nearest = min(nearest_strands(Curve(each.astype(float)), 1.6) for each in frames)
    assert (nearest >= (1.0 - 1e-5) * 2.0 * depth) is kept
    assert nearest >= 1.7 * thickness(curve)
    assert ("the bevel is too thick" in capfd.readouterr().out) is not kept


def test_it_fits_in_the_world():
    """Two objects of different scales, as thick as half of what is between them."""
    vertices = hopf_link(80).vertices
    pair = [add_curve([vertices[:80]], "A"), add_curve([0.5 * vertices[80:]], "B")]
    pair[1].scale = (2, 2, 2)
    fit()
    link = Curve.from_components([in_world(obj, stored(obj.data)) for obj in pair])
    radius = free_radius(link, thickest_radius(link))
    assert [obj.data.bevel_depth for obj in pair] == pytest.approx([radius, radius / 2], rel=1e-5)


def test_what_was_a_rope_is_drawn_as_that():
    """Also where it was scaled since, but not once somebody has moved its points."""
    obj = add_hopf_link(30)
    obj.scale = (2, 2, 2)
    relax(fit_bevel=True)
    assert bpy.ops.curve.mobius_flow_keep_size(measure="BOX", reference="FIRST") == {"FINISHED"}
    depth, obj.data.bevel_depth = obj.data.bevel_depth, 0.0
    fit()
    assert obj.data.bevel_depth == pytest.approx(depth, rel=1e-5)
    keys = obj.data.shape_keys
    assert all(point.radius == 1 for block in keys.key_blocks for point in block.data)
    for point in keys.key_blocks[-1].data[:3]:
        point.co.z += 0.01
    fit()
    assert obj.data.bevel_depth != pytest.approx(depth, rel=1e-3)


@pytest.mark.parametrize("name", ["profile", "extruded", "tapered"])
def test_other_shapes_are_refused(name):
    data = add_trefoil().data
    BEVELS[name](data)
    before = drawn(data)
    with pytest.raises(RuntimeError, match="of its own; remove them first"):
        bpy.ops.curve.mobius_flow_fit_tube()
    assert drawn(data) == before
