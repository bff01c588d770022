"""Objects of all kinds are avoided as the 3D view shows them; what cannot be is named."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, drawn, show
from mobius_flow.addon.curves.surroundings import Surroundings
from mobius_flow.core import MobiusFlowError
from shapes import hopf_link, regular_polygon


def obstacles(*objects, relaxed=()):
    bpy.context.view_layer.update()
    return Surroundings.of(objects, relaxed).obstacles


def added(kind, name, **values):
    """The object that one of Blender's own buttons adds."""
    getattr(getattr(bpy.ops, kind), name)(**values)
    return bpy.context.object


def cube(name="Cube", place=(0, 0, 0)):
    obj = added("mesh", "primitive_cube_add", location=place)
    obj.name = name
    return obj


def turned(obj):
    obj.location, obj.rotation_euler, obj.scale = (1, 2, 3), (0.3, 0.2, 0.1), (2, -1, 0.5)
    return obj


def points(obj):
    """What Blender draws of an object in the world, in no order."""
    bpy.context.view_layer.update()
    return np.unique(drawn(obj), axis=0)


def used(*parts):
    return np.unique(np.concatenate([part.vertices for part in parts]), axis=0)


@pytest.mark.parametrize(
    ("kind", "name"),
    [
        ("mesh", "primitive_torus_add"),
        ("surface", "primitive_nurbs_surface_sphere_add"),
        ("object", "text_add"),
        ("object", "metaball_add"),
    ],
)
def test_what_has_faces_is_avoided_once_as_triangles(kind, name):
    if name == "metaball_add" and bpy.app.version < (5, 0):
        pytest.skip("this Blender shows nothing of a mirrored metaball")
    obj = turned(added(kind, name))
    (faces,) = obstacles(obj)
    assert faces.faces.shape[1] == 3
    assert faces.name == obj.name
    np.testing.assert_allclose(used(faces), points(obj), atol=1e-12)
    areas = np.linalg.norm(np.cross(*np.diff(faces.corners, axis=1).swapaxes(0, 1)), axis=1)
    assert len(np.unique(np.sort(faces.faces, axis=1), axis=0)) == len(faces.faces), "no triangle is there twice"
    assert areas.max() > 0


def test_a_curve_without_a_bevel_is_its_line_and_with_one_its_tube():
    obj = turned(add_curve([hopf_link(24).vertices[:24]]))
    (line,) = obstacles(obj)
    assert line.faces.shape == (24, 2)
    obj.data.bevel_depth = 0.125
    (tube,) = obstacles(obj)
    assert tube.faces.shape[1] == 3
    np.testing.assert_allclose(used(tube), points(obj), atol=1e-12)


def test_edges_without_faces_are_avoided_too():
    data = bpy.data.meshes.new("Fence")
    data.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 5)], [(0, 3)], [(0, 1, 2)])
    faces, lines = obstacles(show(bpy.data.objects.new("Fence", data)))
    np.testing.assert_array_equal(faces.corners, [[(0, 0, 0), (1, 0, 0), (0, 1, 0)]])
    np.testing.assert_array_equal(lines.corners, [[(0, 0, 0), (0, 0, 5)]])


def test_modifiers_count():
    obj = cube()
    array = obj.modifiers.new("Array", "ARRAY")
    array.use_constant_offset, array.constant_offset_displace = True, (5, 0, 0)
    (faces,) = obstacles(obj)
    assert len(faces.faces) == 24
    assert np.ptp(faces.vertices[:, 0]) > 6
    array.show_viewport = False
    assert len(obstacles(obj)[0].faces) == 12


def test_instances_of_a_collection_are_where_they_are_shown():
    inner = bpy.data.collections.new("Inner")
    inner.objects.link(cube())
    bpy.context.scene.collection.children.link(inner)
    outer = bpy.data.collections.new("Outer")
    for collection, holder, place in ((inner, outer, (10, 0, 0)), (outer, bpy.context.scene.collection, (0, 20, 0))):
        empty = bpy.data.objects.new("Instance", None)
        empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", collection, place
        holder.objects.link(empty)
    (faces,) = obstacles(empty)
    assert faces.name == empty.name
    assert len(faces.faces) == 12
    np.testing.assert_allclose(faces.vertices.mean(axis=0), (10, 20, 0), atol=1e-5)


def copies(obj, source=None):
    """Let geometry nodes show ten cubes, or copies of another object, one above the other, in place of an object."""
    tree = bpy.data.node_groups.new("Copies", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    column, instances, out = map(
        tree.nodes.new, ("GeometryNodeMeshLine", "GeometryNodeInstanceOnPoints", "NodeGroupOutput")
    )
    shown = tree.nodes.new("GeometryNodeMeshCube" if source is None else "GeometryNodeObjectInfo")
    if source is not None:
        shown.inputs["Object"].default_value, shown.inputs["As Instance"].default_value = source, True
    tree.links.new(column.outputs[0], instances.inputs["Points"])
    tree.links.new(shown.outputs["Mesh" if source is None else "Geometry"], instances.inputs["Instance"])
    tree.links.new(instances.outputs[0], out.inputs[0])
    obj.modifiers.new("Copies", "NODES").node_group = tree
    return obj


@pytest.mark.parametrize("of_another", [False, True])
def test_instances_of_geometry_nodes_are_avoided(of_another):
    source = cube("Source", (50, 0, 0)) if of_another else None
    obj = copies(cube("Column", (3, 0, 0)), source)
    (faces,) = obstacles(obj)
    assert faces.name == "Column"
    assert len(faces.faces) == 120
    np.testing.assert_allclose(faces.vertices.mean(axis=0)[2], 4.5, atol=1e-5)


def instance(obj):
    """An empty that shows an object, by a collection of its own."""
    collection = bpy.data.collections.new("Copied")
    collection.objects.link(obj)
    empty = show(bpy.data.objects.new("Instance", None))
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    return empty


def test_what_is_copied_must_stand_still():
    source = cube("Source")
    source.keyframe_insert("location", frame=1)
    with pytest.raises(MobiusFlowError, match="'Source' is moved by animation, and what is avoided must stand still"):
        obstacles(instance(source))
    with pytest.raises(MobiusFlowError, match="'Column' is moved by the modifier 'Copies'"):
        obstacles(copies(cube("Column"), source))


def test_a_copy_of_what_is_relaxed_moves():
    ring = add_curve([regular_polygon(20).vertices], "Ring")
    with pytest.raises(MobiusFlowError, match="'Ring' is moved by the relaxation itself"):
        obstacles(instance(ring), relaxed=[ring])
    with pytest.raises(MobiusFlowError, match="'Column' is moved by the modifier 'Copies'"):
        obstacles(copies(cube("Column"), ring), relaxed=[ring])


@pytest.mark.parametrize(
    ("node", "kind"), [("GeometryNodeCurvePrimitiveCircle", "Curve"), ("GeometryNodePoints", "Point Cloud")]
)
def test_parts_that_are_no_mesh_are_refused(node, kind):
    """Geometry nodes can show curves and points beside a mesh."""
    obj = cube()
    tree = bpy.data.node_groups.new("Both", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    join, out = map(tree.nodes.new, ("GeometryNodeJoinGeometry", "NodeGroupOutput"))
    for name in (node, "GeometryNodeMeshCube"):
        tree.links.new(tree.nodes.new(name).outputs[0], join.inputs[0])
    tree.links.new(join.outputs[0], out.inputs[0])
    obj.modifiers.new("Both", "NODES").node_group = tree
    with pytest.raises(MobiusFlowError, match=f"'Cube' shows a {kind} too, which cannot be avoided; convert it to"):
        obstacles(obj)


def test_points_alone_are_nothing_to_avoid():
    data = bpy.data.meshes.new("Dust")
    data.from_pydata([(0, 0, 0), (1, 0, 0)], [], [])
    with pytest.raises(MobiusFlowError, match="'Dust' shows neither faces nor edges"):
        obstacles(show(bpy.data.objects.new("Dust", data)))


def test_what_is_not_finite_is_named():
    obj = cube("Wall")
    obj.data.vertices[3].co.x = float("nan")
    with pytest.raises(MobiusFlowError, match="A point of 'Wall' is not finite"):
        obstacles(obj)


def test_other_kinds_are_refused():
    obj = show(bpy.data.objects.new("Cloud", bpy.data.volumes.new("Cloud")))
    with pytest.raises(MobiusFlowError, match="'Cloud' is of type Volume, which cannot be avoided"):
        obstacles(obj)


def test_what_is_hidden_or_edited_is_refused():
    obj = cube()
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(MobiusFlowError, match="'Cube' is being edited"):
        obstacles(obj)
    bpy.ops.object.mode_set(mode="OBJECT")
    obj.hide_set(True)
    with pytest.raises(MobiusFlowError, match="'Cube' is hidden; show it first, or leave it out"):
        obstacles(obj)


def test_nothing_of_an_object_is_touched():
    obj = cube()
    obj.modifiers.new("Array", "ARRAY")
    before = sorted(mesh.name for mesh in bpy.data.meshes)
    obstacles(obj)
    assert sorted(mesh.name for mesh in bpy.data.meshes) == before
    assert len(obj.data.vertices) == 8
