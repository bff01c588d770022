"""Tube Mesh and Smooth Curve: what is made, where it is, and what is said of it."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_hopf_link, add_trefoil, contents, evaluated, in_world, relax
from mobius_flow.addon.curves import bevel, splines
from mobius_flow.addon.curves.keyframes import keyed_points
from mobius_flow.addon.curves.surroundings import near
from mobius_flow.core import Curve
from mobius_flow.core.energies.moebius import moebius_by_length
from mobius_flow.core.keys.colours import PALETTE, ramp, strand_distances
from shapes import hopf_link


def tube(**options):
    assert bpy.ops.curve.mobius_flow_tube_mesh(**options) == {"FINISHED"}
    return bpy.context.object


def smooth(**options):
    assert bpy.ops.curve.mobius_flow_smooth_curve(**options) == {"FINISHED"}
    return bpy.context.object


def unplaced(obj):
    return obj


def placed(obj):
    """Somewhere else, turned and scaled."""
    obj.location, obj.rotation_euler, obj.scale = (1, 2, 3), (0.3, 0.2, 0.1), (2, 2, 2)
    bpy.context.view_layer.update()
    return obj


def parented(obj):
    """A matrix with shear is no product of location, rotation and scale."""
    obj.parent = parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.scale, parent.location.x = (1, 2, 3), 5.0
    obj.matrix_parent_inverse.translation.y = 0.5
    return placed(obj)


def radii(made, frame, sides=16):
    rings = evaluated(made, frame).reshape(-1, sides, 3)
    return np.linalg.norm(rings - rings.mean(axis=1, keepdims=True), axis=-1)


def value(mesh, name):
    array = np.empty(len(mesh.vertices), dtype=np.float32)
    mesh.attributes[name].data.foreach_get("value", array)
    return array


def colours(mesh):
    """Colours at the vertices of the tube, linear RGB; bytes of sRGB are that exact."""
    array = np.empty((len(mesh.loops), 4), dtype=np.float32)
    corners = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.color_attributes["colour"].data.foreach_get("color", array.ravel())
    mesh.loops.foreach_get("vertex_index", corners)
    found = np.empty((len(mesh.vertices), 3))
    found[corners] = array[:, :3]
    np.testing.assert_array_equal(found[corners], array[:, :3])
    return found


@pytest.mark.parametrize("place", [unplaced, placed])
def test_it_moves_with_the_curve(place):
    curve = place(add_trefoil())
    relax(max_iterations=12)
    made = tube(radius=0.25, sides=8)
    for frame in (1, 2, 4.5, 9.75, 13):
        middles = in_world(made, evaluated(made, frame)).reshape(-1, 8, 3).mean(axis=1)
        np.testing.assert_allclose(middles, in_world(curve, evaluated(curve, frame)), atol=2e-3)


def test_it_is_as_thick_as_the_curve_is_drawn_or_as_fits_a_line():
    curve = add_trefoil(60)
    bpy.context.view_layer.objects.active = None  # what is made becomes active even so
    made = tube(hide_curve=False)
    line = radii(made, 1).min()
    made.select_set(False)
    curve.select_set(True)
    bpy.context.view_layer.objects.active = curve
    bpy.ops.curve.mobius_flow_fit_tube()
    assert line == pytest.approx(curve.data.bevel_depth, rel=0.05)
    relax(max_iterations=8, fit_bevel=True)
    made = tube()
    for frame, block in enumerate(curve.data.shape_keys.key_blocks, 1):
        np.testing.assert_allclose(radii(made, frame), curve.data.bevel_depth * block.data[0].radius, rtol=0.05)


def test_attributes_are_of_the_end_and_points_those_of_every_key():
    add_hopf_link(20)
    relax(max_iterations=6, vertices=60)
    link = Curve.from_components(np.split(keyed_points(bpy.context.object.data)[-1].astype(np.float64), 2))
    mesh = tube(sides=6).data
    assert len(mesh.vertices) == 60 * 6
    assert {len(block.data) for block in mesh.shape_keys.key_blocks} == {360}
    assert mesh.shape_keys.use_relative
    assert not mesh.validate()
    np.testing.assert_allclose(value(mesh, "strand_distance"), np.repeat(strand_distances(link), 6), rtol=1e-5)
    np.testing.assert_array_equal(value(mesh, "component"), np.repeat([0, 1], 180))
    density = moebius_by_length(link)
    expected = np.repeat(0.5 * (density + density[link.mesh.previous]), 6)
    np.testing.assert_allclose(value(mesh, "energy_density"), expected, rtol=1e-4)


@pytest.mark.parametrize(("name", "sign"), [("strand_distance", -1), ("energy_density", 1)])
def test_colours_show_attributes(name, sign):
    add_trefoil()
    mesh = tube(color=name).data
    np.testing.assert_allclose(colours(mesh), ramp(sign * value(mesh, name).astype(np.float64)), atol=0.02)
    assert [material.name for material in mesh.materials] == ["Glaze colour"]


def test_materials_of_the_curve_are_kept_or_components_coloured_through_all_objects():
    for part, name in zip(hopf_link(24).components, "AB", strict=True):
        add_curve([part], name)
    tube(color="component")
    for name, colour in zip(("A Tube", "B Tube"), PALETTE, strict=False):
        np.testing.assert_allclose(colours(bpy.data.objects[name].data), np.tile(colour, (24 * 16, 1)), atol=0.02)
    bpy.ops.object.select_all(action="DESELECT")
    obj = add_hopf_link(20)
    bpy.ops.curve.mobius_flow_color_components()
    mesh = tube(sides=4).data
    assert list(mesh.materials) == list(obj.data.materials)
    assert [mesh.polygons[k].material_index for k in (0, 79, 80, 159)] == [0, 0, 1, 1]


@pytest.mark.parametrize("make", [tube, smooth])
@pytest.mark.parametrize("place", [unplaced, placed, parented])
def test_it_is_where_the_curve_is_which_stays_as_it_is(make, place):
    curve, collection = add_trefoil(), bpy.data.collections.new("Knots")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(curve)
    bpy.context.scene.collection.objects.unlink(curve)
    place(curve)
    if place is placed:
        relax(max_iterations=3)
    curve.data.bevel_depth = 0.125
    before = contents()["splines"]["Knot"]
    hides = place is not unplaced
    made = make(hide_curve=hides)
    assert contents()["splines"]["Knot"] == before
    assert (made.select_get(), curve.select_get()) == (True, False)
    assert (curve.hide_get(), curve.hide_render) == (hides, hides)
    bpy.context.view_layer.update()
    assert made.matrix_world == curve.matrix_world
    assert made.parent == curve.parent
    assert [each.name for each in made.users_collection] == ["Knots"]


def test_other_profiles_are_said_to_be_left_out(capfd):
    add_trefoil().data.bevel_mode = "PROFILE"
    tube()
    assert "The tube of 'Knot' is round: profiles and tapers are left out" in capfd.readouterr().out


@pytest.mark.parametrize("kind", ["BEZIER", "NURBS"])
@pytest.mark.parametrize("place", [unplaced, placed])
def test_smooth_splines_are_where_it_is_said(kind, place, capfd):
    curve = place(add_trefoil(30))
    relax(max_iterations=5, vertices=150)
    made = smooth(kind=kind, points=20)
    said = capfd.readouterr().out
    assert "'Knot': 20 points" in said
    assert "the same knot, proved" in said
    (spline,) = made.data.splines
    assert (spline.type, spline.use_cyclic_u) == (kind, True)
    assert len(spline.bezier_points if kind == "BEZIER" else spline.points) == 20
    drawn = in_world(made, np.concatenate(splines.sampled(made)))
    polygon = in_world(curve, keyed_points(curve.data)[-1])
    distance = np.linalg.norm(drawn[:, None] - polygon, axis=-1).min(axis=1).max()
    assert distance < 0.12 * curve.scale.x


def test_too_few_points_are_not_proved(capfd):
    add_trefoil(120)
    smooth(points=4)
    said = capfd.readouterr().out
    assert "NOT proved to be the same knot, so give it more Points" in said
    assert "where strands are only" in said


def test_smooth_curves_have_the_bevels_and_the_materials():
    pair = [add_curve([part], name) for part, name in zip(hopf_link(80).components, "AB", strict=True)]
    pair[0].data.bevel_depth, pair[0].data.bevel_resolution, pair[0].data.extrude = 0.125, 3, 0.25
    pair[0].data.driver_add("bevel_depth")
    pair[0].data[splines.SOURCE] = {"object": pair[1], "rendered": True}
    bpy.ops.curve.mobius_flow_color_components()
    smooth()
    assert {obj.name for obj in bpy.context.selected_objects} == {"A Smooth", "B Smooth"}
    for obj in pair:
        data = bpy.data.objects[f"{obj.name} Smooth"].data
        for name in ("bevel_depth", "bevel_resolution", "extrude"):
            assert getattr(data, name) == getattr(obj.data, name)
        assert list(data.materials) == list(obj.data.materials)
        assert [spline.material_index for spline in data.splines] == [0]
        assert not bevel.is_fitted(data)
        assert data.animation_data is None
        assert splines.SOURCE not in data
    bpy.ops.object.select_all(action="DESELECT")
    add_trefoil()
    bpy.ops.curve.mobius_flow_fit_tube()
    assert bevel.is_fitted(smooth().data)


def test_a_tubes_mesh_is_filmed_as_its_curve_is():
    scene, obj = bpy.context.scene, add_hopf_link()
    relax(keyframes="SHAPE_KEYS", max_iterations=3)
    made = tube()
    assert bpy.context.selected_objects == [made]
    scene.frame_end, scene.mobius_flow_film.look = 1, "NEON"
    assert bpy.ops.curve.mobius_flow_scene_range() == {"FINISHED"}
    assert scene.frame_end == 4
    assert bpy.ops.curve.mobius_flow_set_up_stage() == {"FINISHED"}
    assert list(made.data.materials) == list(obj.data.materials)
    slots = np.empty(len(made.data.polygons), dtype=np.int32)
    made.data.polygons.foreach_get("material_index", slots)
    assert sorted(np.unique(slots, return_counts=True)[1]) == [len(slots) // 2, len(slots) // 2]
    obj.hide_set(False)
    assert made not in near(bpy.context, [obj])
    bpy.ops.curve.mobius_flow_remove_stage()
    assert not made.data.materials
    bpy.data.objects.remove(obj)
    with pytest.raises(RuntimeError, match="is of type Mesh"):
        bpy.ops.curve.mobius_flow_set_up_stage()
