"""What is refused is mended by the button that the refusal names: in one step, on all that need it, losing nothing."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_trefoil, contents, evaluated, linked, show, stored
from mended_curves import SHAPE, call, may_be_relaxed, mend, relax_once, two, with_material
from mobius_flow.addon.buttons import mending
from mobius_flow.addon.live import registry
from mobius_flow.addon.live.requirements import POLYGONS, RELAXABLE, Remedy
from modal_operator import keys


def test_every_remedy_has_its_words():
    items = bpy.ops.curve.mobius_flow_mend.get_rna_type().properties["remedy"].enum_items
    assert {item.identifier: item.name for item in items} == {each.name: each.value for each in Remedy}
    for item in items:
        assert 20 < len(item.description) < 120
        assert not item.description.endswith(".")
        asked = SimpleNamespace(remedy=item.identifier)
        assert mending.CURVE_OT_mobius_flow_mend.description(bpy.context, asked) == item.description


@pytest.mark.parametrize("remedy", list(Remedy), ids=lambda remedy: remedy.name)
def test_what_needs_nothing_is_left_alone(remedy):
    add_trefoil()
    if remedy is not Remedy.COPY:
        before = contents()
        with pytest.raises(RuntimeError, match="Nothing selected needs that"):
            call(remedy)
        assert contents() == before


@pytest.mark.parametrize("remedy", [Remedy.MAKE_3D, Remedy.COPY], ids=lambda remedy: remedy.name)
def test_not_during_a_run(operator, remedy):
    add_trefoil()
    operator.start()
    add_curve([SHAPE + 9], cyclic=False)
    with pytest.raises(RuntimeError, match="is being relaxed; stop that first"):
        call(remedy)
    registry.current().cancel()


def test_flat_curves_become_curves_in_space():
    pair = two()
    for obj in pair:
        obj.data.dimensions = "2D"
    before = [stored(obj.data) for obj in pair]
    mend(Remedy.MAKE_3D)
    for obj, points in zip(pair, before, strict=True):
        assert obj.data.dimensions == "3D"
        np.testing.assert_array_equal(stored(obj.data), points)


def test_shared_data_becomes_ones_own():
    first, second = two()
    other = bpy.data.objects.new("Other", with_material(first).data)
    bpy.context.scene.collection.objects.link(other)
    data, untouched = other.data, second.data
    mend(Remedy.SINGLE_USER)
    assert first.data != data == other.data
    assert (data.name, first.data.users, second.data) == ("A", 1, untouched)
    assert [material.name for material in first.data.materials] == ["Gold"]
    np.testing.assert_array_equal(stored(first.data), stored(data))
    may_be_relaxed()
    assert other.data.shape_keys is None


def test_of_two_that_share_one_keeps_what_they_shared():
    first, second = two()
    data = second.data = first.data
    mend(Remedy.SINGLE_USER)
    assert first.data != data == second.data
    second.location.x = 9
    may_be_relaxed()


def test_baked_curves_keep_their_keys_when_they_are_parted():
    first = relax_once()
    other = show(bpy.data.objects.new("Other", first.data))
    first.select_set(False)
    written = keys(first)
    mend(Remedy.SINGLE_USER)
    np.testing.assert_array_equal(keys(first), written)
    np.testing.assert_array_equal(keys(other), written)
    assert bpy.ops.curve.mobius_flow_clear() == {"FINISHED"}
    assert other.data.shape_keys is None
    np.testing.assert_array_equal(keys(first), written)
    assert evaluated(first, 2).shape == evaluated(first, 1).shape


def test_edited_curves_are_left_as_they_were_edited():
    pair = two()
    bpy.ops.object.mode_set(mode="EDIT")
    assert [obj.mode for obj in pair] == ["EDIT", "EDIT"]
    bpy.ops.curve.select_all(action="SELECT")
    bpy.ops.transform.translate(value=(0, 0, 1))
    mend(Remedy.OBJECT_MODE)
    assert [obj.mode for obj in pair] == ["OBJECT", "OBJECT"]
    np.testing.assert_allclose(stored(pair[0].data), SHAPE + np.array([0, 0, 1]), atol=1e-6)
    may_be_relaxed()


@pytest.mark.parametrize("kind", ["BEZIER", "NURBS"])
def test_smooth_splines_become_what_is_drawn(kind):
    obj = with_material(with_material(add_curve([SHAPE, SHAPE + 9], kind=kind)))
    obj.data.splines.new("POLY").points.add(2)
    poly = obj.data.splines[2]
    poly.points.foreach_set("co", [20, 0, 0, 1, 21, 0, 0, 1, 20, 1, 0, 1])
    poly.use_cyclic_u = True
    obj.data.splines[1].material_index = 1
    drawn = evaluated(obj)
    assert RELAXABLE(bpy.context) is None, "relaxing asks by itself"
    assert POLYGONS.of([obj]).remedy is Remedy.TO_POLY
    assert bpy.ops.curve.mobius_flow_mend(remedy="TO_POLY") == {"FINISHED"}
    assert {spline.type for spline in obj.data.splines} == {"POLY"}
    assert obj.data.splines[1].material_index == 1
    np.testing.assert_array_equal(stored(obj.data), drawn)
    np.testing.assert_array_equal(evaluated(obj), drawn)
    assert POLYGONS.of([obj]) is None


def test_what_cannot_become_a_polygon_is_said_and_the_rest_does():
    good, bad = two(kind="BEZIER")
    bad.data.resolution_u = 1
    spline = bad.data.splines.new("BEZIER")
    spline.bezier_points.add(1)
    spline.use_cyclic_u = True
    with pytest.raises(RuntimeError, match="Spline 2 of 'B' is drawn with only 2 points"):
        bpy.ops.curve.mobius_flow_mend(remedy="TO_POLY")
    assert {spline.type for spline in good.data.splines} == {"POLY"}
    assert {spline.type for spline in bad.data.splines} == {"BEZIER"}


def wire(name, edges=True):
    data = bpy.data.meshes.new(name)
    n = len(SHAPE)
    data.from_pydata(SHAPE.tolist(), [(k, (k + 1) % n) for k in range(n)] if edges else [], [])
    return show(with_material(bpy.data.objects.new(name, data)))


def test_meshes_become_curves_and_stay():
    first, second = wire("First"), wire("Second")
    second.location.x = 9
    mend(Remedy.TO_CURVE)
    made = bpy.context.selected_objects
    assert [obj.type for obj in made] == ["CURVE", "CURVE"]
    assert [obj.type for obj in (first, second)] == ["MESH", "MESH"]
    assert bpy.context.object in made
    assert {obj.data.materials[0].name for obj in made} == {"Gold", "Gold.001"}
    for obj in made:
        np.testing.assert_allclose(np.sort(stored(obj.data), axis=0), np.sort(SHAPE, axis=0), atol=1e-6)
    may_be_relaxed()


def test_texts_become_curves_step_by_step():
    words = with_material(show(bpy.data.objects.new("Words", bpy.data.curves.new("Words", "FONT"))))
    words.data.body = "O"
    mend(Remedy.TO_CURVE)
    assert [material.name for material in bpy.context.object.data.materials] == ["Gold"]
    assert words.type == "FONT"
    mend(Remedy.MAKE_3D)
    may_be_relaxed()


def test_no_button_for_meshes_of_other_files(tmp_path):
    wire("Theirs")
    show(linked(tmp_path / "library.blend", "objects", "Theirs"))
    assert RELAXABLE(bpy.context).remedy is None


def test_no_button_for_what_has_no_lines():
    wire("Dots", edges=False)
    assert RELAXABLE(bpy.context).remedy is None
    bpy.ops.mesh.primitive_cube_add()
    bpy.context.selected_objects[0].select_set(True)
    assert RELAXABLE(bpy.context).remedy is None
    show(bpy.data.objects.new("Axes", None))
    assert RELAXABLE(bpy.context).remedy is None


def test_linked_curves_become_local(tmp_path):
    with_material(add_trefoil())
    obj = show(linked(tmp_path / "library.blend", "objects", "Knot"))
    mend(Remedy.MAKE_LOCAL)
    (obj,) = bpy.context.selected_objects
    assert (obj.library, obj.data.library, obj.name) == (None, None, "Knot")
    assert obj.data.materials[0].library is not None, "materials stay linked"
    may_be_relaxed()


def test_linked_data_becomes_local(tmp_path):
    add_trefoil()
    data = linked(tmp_path / "library.blend", "curves", "Knot")
    obj = show(bpy.data.objects.new("Mine", data))
    mend(Remedy.MAKE_LOCAL)
    assert obj.data.library is None
    may_be_relaxed()


def test_what_is_in_a_linked_collection_is_copied(tmp_path):
    collection = bpy.data.collections.new("Set")
    bpy.context.scene.collection.children.link(collection)
    obj = add_trefoil()
    collection.objects.link(obj)
    bpy.context.scene.collection.objects.unlink(obj)
    theirs = linked(tmp_path / "library.blend", "collections", "Set")
    bpy.context.scene.collection.children.link(theirs)
    (obj,) = theirs.objects
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    mend(Remedy.MAKE_LOCAL)
    (mine,) = bpy.context.selected_objects
    assert mine.library is mine.data.library is None
    assert mine == bpy.context.object
    assert len(theirs.objects) == 1
    assert theirs.objects[0].library is not None
    may_be_relaxed()


def test_overrides_become_local(tmp_path):
    add_trefoil()
    theirs = show(linked(tmp_path / "library.blend", "objects", "Knot"))
    mine = theirs.override_create(remap_local_usages=True)
    mine.select_set(True)
    bpy.context.view_layer.objects.active = mine
    mend(Remedy.MAKE_LOCAL)
    (mine,) = bpy.context.selected_objects
    assert mine.override_library is mine.library is mine.data.library is None
    may_be_relaxed()
