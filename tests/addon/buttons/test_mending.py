"""What is refused is mended by the button that the refusal names: in one step, on all that need it, losing nothing."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_trefoil, contents, evaluated, linked, relax, show, stored
from mended_curves import SHAPE, call, may_be_relaxed, mend, two, with_material
from mobius_flow.addon.buttons import mending
from mobius_flow.addon.live.requirements import POLYGONS, RELAXABLE, UNEDITED, Remedy
from modal_operator import splines_of


def test_every_remedy_has_its_words():
    items = bpy.ops.curve.mobius_flow_mend.get_rna_type().properties["remedy"].enum_items
    assert {item.identifier: item.name for item in items} == {each.name: each.value for each in Remedy}
    for item in items:
        assert 20 < len(item.description) < 120
        assert not item.description.endswith(".")
        asked = SimpleNamespace(remedy=item.identifier)
        assert mending.CURVE_OT_mobius_flow_mend.description(bpy.context, asked) == item.description


@pytest.mark.parametrize("remedy", [each for each in Remedy if each is not Remedy.COPY], ids=lambda each: each.name)
def test_what_needs_nothing_is_left_alone(remedy):
    add_curve([SHAPE + 9], cyclic=False)
    relax(max_iterations=1)
    add_trefoil()
    before = contents()
    with pytest.raises(RuntimeError, match="Nothing selected needs that"):
        call(remedy)
    assert contents() == before


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
    assert call(Remedy.TO_POLY) == {"FINISHED"}
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
        call(Remedy.TO_POLY)
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


@pytest.mark.parametrize("kind", ["object", "data", "override", "collection"])
def test_what_is_in_another_file_becomes_local(tmp_path, kind):
    with_material(add_trefoil())
    if kind == "collection":
        collection = bpy.data.collections.new("Set")
        bpy.context.scene.collection.children.link(collection)
        collection.objects.link(bpy.context.object)
        bpy.context.scene.collection.objects.unlink(bpy.context.object)
        theirs = linked(tmp_path / "library.blend", "collections", "Set")
        bpy.context.scene.collection.children.link(theirs)
        (obj,) = theirs.objects
    elif kind == "data":
        data = linked(tmp_path / "library.blend", "curves", "Knot")  # first: it opens another file
        obj = show(bpy.data.objects.new("Knot", data))
    else:
        obj = show(linked(tmp_path / "library.blend", "objects", "Knot"))
        if kind == "override":
            obj = obj.override_create(remap_local_usages=True)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    mend(Remedy.MAKE_LOCAL)
    (mine,) = bpy.context.selected_objects
    assert mine == bpy.context.object
    assert (mine.library, mine.data.library, mine.override_library, mine.name) == (None, None, None, "Knot")
    assert mine.data.materials[0].library is not None, "materials stay linked"
    if kind == "collection":  # which still has its own
        assert [each.library is None for each in theirs.objects] == [False]
    may_be_relaxed()


def shape_keys(obj):
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Mine")
    key.data[3].co.z += 0.5
    key.value = 0.5


def animation(obj):
    obj.data.bevel_depth = 0.1
    obj.data.keyframe_insert("bevel_depth", frame=1)


def edited_film(_obj):
    obj = relax(max_iterations=3)
    obj.data.shape_keys.key_blocks[0].data[7].co.x += 0.125
    bpy.context.scene.frame_set(1)


def turned(obj):
    obj.rotation_euler, obj.scale, obj.location = (0.3, 0.2, 0.1), (1.1, 2, 0.7), (3, 2, 1)


def own_collection(obj):
    collection = bpy.data.collections.new("Mine")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(obj)
    bpy.context.scene.collection.objects.unlink(obj)


DRIVEN = (shape_keys, animation, lambda obj: obj.data.driver_add("splines[0].points[3].co", 1), edited_film)


@pytest.mark.parametrize("prepare", [*DRIVEN, turned, own_collection])
def test_a_still_copy_has_the_shape_that_is_shown_and_nothing_that_moves_it(prepare):
    obj = with_material(add_trefoil())
    prepare(obj)
    bpy.context.view_layer.update()
    refusal = RELAXABLE(bpy.context) or UNEDITED(bpy.context)
    assert (refusal is not None and refusal.remedy is Remedy.COPY) == (prepare in DRIVEN)
    before = splines_of(obj.data), obj.data.animation_data and obj.data.animation_data.action, obj.data.shape_keys
    shown, bevel, matrix, homes = evaluated(obj), obj.data.bevel_depth, obj.matrix_world.copy(), obj.users_collection
    assert call(Remedy.COPY) == {"FINISHED"}
    (copy,) = bpy.context.selected_objects
    assert copy == bpy.context.object != obj
    assert (splines_of(obj.data), obj.data.animation_data and obj.data.animation_data.action) == before[:2]
    assert obj.data.shape_keys == before[2]
    np.testing.assert_array_equal(evaluated(obj), shown)
    if not bevel:
        np.testing.assert_array_equal(stored(copy.data), shown)
    assert (copy.data.shape_keys, copy.data.animation_data) == (None, None)
    assert copy.data.bevel_depth == bevel
    assert (copy.matrix_world, copy.users_collection) == (matrix, homes)
    assert copy.data.materials[0].name == "Gold"
    assert UNEDITED(bpy.context) is None
    may_be_relaxed()
