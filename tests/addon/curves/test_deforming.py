"""Modifiers that move points: what is proved of the points is not what is shown, so such curves are refused."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_trefoil, contents, evaluated, sentence, show, stored
from mobius_flow import Relaxation
from mobius_flow.addon.curves.moving import deforms, what_deforms
from mobius_flow.addon.live.requirements import RELAXABLE, Remedy

# what is left of the kinds of modifiers that curves can have adds to what is drawn
ADDING = {"ARRAY", "BEVEL", "BUILD", "DECIMATE", "EDGE_SPLIT", "MIRROR", "MULTIRES", "NODES", "REMESH", "SCREW"}
ADDING |= {"SOLIDIFY", "SUBSURF", "SURFACE", "TRIANGULATE", "WELD"}


def hook(obj, index, by):
    """Let an empty carry a point of a curve along."""
    modifier = obj.modifiers.new("Grab", "HOOK")
    modifier.object = bpy.data.objects.new("Empty", None)
    bpy.context.scene.collection.objects.link(modifier.object)
    modifier.vertex_indices_set([index])
    bpy.context.view_layer.update()
    modifier.matrix_inverse = modifier.object.matrix_world.inverted()
    modifier.object.location = by
    bpy.context.view_layer.update()


def nodes(obj, *kinds):
    """Geometry nodes, the last of which is in a group of its own."""
    trees = [bpy.data.node_groups.new(name, "GeometryNodeTree") for name in ("Outer", "Inner")]
    for kind in kinds:
        trees[1].nodes.new(kind)
    trees[0].nodes.new("GeometryNodeGroup").node_tree = trees[1]
    modifier = obj.modifiers.new("Nodes", "NODES")
    modifier.node_group = trees[0]
    return modifier


def refused():
    for other in bpy.context.selected_objects:
        other.select_set(other == bpy.context.object)
    bpy.context.view_layer.update()
    before = contents()
    with pytest.raises(RuntimeError) as error:
        bpy.ops.curve.mobius_flow_relax(max_iterations=1)
    assert contents() == before
    assert RELAXABLE(bpy.context).remedy is Remedy.COPY
    return sentence(error.value)


def test_whatever_deforms_is_refused_and_every_kind_of_modifier_is_known():
    """A kind that a new Blender adds has to be looked at."""
    obj, deforming, adding = add_trefoil(), 0, set()
    for kind in [item.identifier for item in bpy.types.Modifier.bl_rna.properties["type"].enum_items]:
        try:
            modifier = obj.modifiers.new("Mine", kind)
        except (RuntimeError, TypeError):  # not for curves
            continue
        if modifier is None:
            continue
        if deforms(modifier):
            deforming += 1
            assert "The modifier 'Mine' of 'Knot' moves its points" in refused()
        else:
            adding.add(kind)
        obj.modifiers.remove(modifier)
    assert deforming > 10
    assert adding <= ADDING


def test_what_adds_to_the_drawing_is_not_refused():
    obj = add_trefoil()
    obj.modifiers.new("Array", "ARRAY")
    obj.modifiers.new("Smooth", "SUBSURF")
    nodes(obj, "GeometryNodeCurveToMesh", "GeometryNodeCurvePrimitiveCircle")
    report = Relaxation(obj).relax(max_iterations=1, radius="none")
    assert report.sentence.endswith("proved free of contact with itself, before modifiers")


def test_only_what_moves_points_and_is_shown_counts():
    obj = add_trefoil()
    modifier = nodes(obj, "GeometryNodeCurveToMesh", "GeometryNodeSetPosition")
    assert "'Nodes'" in refused()
    modifier.node_group.nodes["Group"].mute = True
    assert what_deforms(obj) is None
    modifier = obj.modifiers.new("Wave", "WAVE")
    modifier.show_viewport = modifier.show_render = False
    assert what_deforms(obj) is None
    modifier.show_render = True
    assert what_deforms(obj) == "The modifier 'Wave' of 'Knot'"


def test_a_parent_that_deforms_is_refused():
    obj = add_trefoil()
    obj.parent = show(bpy.data.objects.new("Lattice", bpy.data.lattices.new("Lattice")))
    bpy.context.view_layer.objects.active = obj
    assert what_deforms(obj) is None
    obj.parent_type = "LATTICE"
    assert "The parent of 'Knot' moves its points" in refused()
    assert bpy.ops.curve.mobius_flow_mend(remedy="COPY") == {"FINISHED"}
    assert bpy.ops.curve.mobius_flow_relax(max_iterations=1) == {"FINISHED"}


def test_a_copy_has_the_deformed_shape_and_may_be_relaxed():
    obj = add_trefoil()
    hook(obj, 3, (0, 0, 0.25))
    bend = obj.modifiers.new("Bend", "SIMPLE_DEFORM")
    bend.deform_method, bend.angle = "TWIST", 0.5
    obj.modifiers.new("Array", "ARRAY").show_viewport = False
    bpy.context.view_layer.update()
    shown = evaluated(obj)
    assert np.abs(shown - stored(obj.data)).max() > 0.2
    assert bpy.ops.curve.mobius_flow_mend(remedy="COPY") == {"FINISHED"}
    copy = bpy.context.object
    assert [modifier.name for modifier in copy.modifiers] == ["Array"]
    np.testing.assert_allclose(stored(copy.data), shown, atol=1e-6)
    assert [modifier.name for modifier in obj.modifiers] == ["Grab", "Bend", "Array"]
    assert not obj.modifiers["Bend"].use_apply_on_spline
    np.testing.assert_array_equal(evaluated(obj), shown)
    assert bpy.ops.curve.mobius_flow_relax(max_iterations=1) == {"FINISHED"}
