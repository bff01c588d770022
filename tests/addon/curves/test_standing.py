"""What is avoided stands still: whatever moves it, or changes its shape, is found and named."""

import bpy
import pytest
from blender_scenes import add_curve, show
from mobius_flow.addon.curves.moving import unsteady, what_changes
from shapes import regular_polygon


@pytest.fixture
def cube():
    bpy.ops.mesh.primitive_cube_add()
    return bpy.context.object


@pytest.fixture
def helper():
    return show(bpy.data.objects.new("Helper", None))


def carried(obj, helper):
    helper.keyframe_insert("rotation_euler", frame=1)
    obj.parent = helper


def shape_keyed(obj, _helper):
    obj.shape_key_add(name="Basis")
    obj.shape_key_add(name="Other").keyframe_insert("value", frame=1)


def hooked(obj, helper):
    helper.keyframe_insert("location", frame=1)
    obj.modifiers.new("Hook", "HOOK").object = helper


def timed(obj, _helper):
    tree = bpy.data.node_groups.new("Timed", "GeometryNodeTree")
    tree.nodes.new("GeometryNodeInputSceneTime")
    obj.modifiers.new("Nodes", "NODES").node_group = tree


def rigid(obj, kind):
    bpy.ops.rigidbody.world_add()
    bpy.context.view_layer.objects.active = obj
    bpy.ops.rigidbody.object_add(type=kind)


def wave(obj):
    obj.modifiers.new("Wave", "WAVE")


def cut_by_what_waves(obj, _helper):
    bpy.ops.mesh.primitive_cube_add()
    wave(bpy.context.object)
    obj.modifiers.new("Cut", "BOOLEAN").object = bpy.context.object


def cut_by_a_collection(obj, helper):
    helper.keyframe_insert("location", frame=1)
    cutters = bpy.data.collections.new("Cutters")
    cutters.objects.link(helper)
    cut = obj.modifiers.new("Cut", "BOOLEAN")
    cut.operand_type, cut.collection = "COLLECTION", cutters


def bent_by_a_lattice(obj, _helper):
    lattice = show(bpy.data.objects.new("Lattice", bpy.data.lattices.new("Lattice")))
    lattice.shape_key_add(name="Basis")
    lattice.shape_key_add(name="Other").keyframe_insert("value", frame=1)
    obj.modifiers.new("Bend", "LATTICE").object = lattice


def posed_by_constraints(obj, helper):
    rig = show(bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig")))
    bpy.ops.object.mode_set(mode="EDIT")
    rig.data.edit_bones.new("Bone").tail = (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    rig.pose.bones["Bone"].constraints.new("COPY_LOCATION").target = helper
    obj.modifiers.new("Rig", "ARMATURE").object = rig


def textured(obj, _helper):
    texture = bpy.data.textures.new("Clouds", "CLOUDS")
    texture.keyframe_insert("noise_scale", frame=1)
    obj.modifiers.new("Bumps", "DISPLACE").texture = texture


def nodes(obj, kind):
    """A node of a group within the nodes of a modifier."""
    inner, outer = (bpy.data.node_groups.new(name, "GeometryNodeTree") for name in ("Inner", "Outer"))
    outer.nodes.new("GeometryNodeGroup").node_tree = inner
    obj.modifiers.new("Nodes", "NODES").node_group = outer
    return inner.nodes.new(kind)


def node_keyed(obj, _helper):
    nodes(obj, "GeometryNodeMeshCube").inputs["Size"].keyframe_insert("default_value", frame=1)


def node_of_an_object(obj, helper):
    helper.keyframe_insert("location", frame=1)
    nodes(obj, "GeometryNodeObjectInfo").inputs["Object"].default_value = helper


def node_of_a_collection(obj, helper):
    helper.keyframe_insert("location", frame=1)
    collection = bpy.data.collections.new("Shown")
    collection.objects.link(helper)
    nodes(obj, "GeometryNodeCollectionInfo").inputs["Collection"].default_value = collection


def input_of_nodes(obj, helper):
    helper.keyframe_insert("location", frame=1)
    nodes(obj, "GeometryNodeMeshCube")
    tree = obj.modifiers["Nodes"].node_group
    socket = tree.interface.new_socket("Object", in_out="INPUT", socket_type="NodeSocketObject")
    modifier = obj.modifiers["Nodes"]
    if hasattr(modifier, "properties"):  # since Blender 5.2
        getattr(modifier.properties.inputs, socket.identifier).value = helper
    else:
        modifier[socket.identifier] = helper


MADE_WITH = [
    (cut_by_what_waves, "Cut"),
    (cut_by_a_collection, "Cut"),
    (bent_by_a_lattice, "Bend"),
    (posed_by_constraints, "Rig"),
    (textured, "Bumps"),
    (node_keyed, "Nodes"),
    (node_of_an_object, "Nodes"),
    (node_of_a_collection, "Nodes"),
    (input_of_nodes, "Nodes"),
]


@pytest.mark.parametrize(("act", "modifier"), MADE_WITH)
def test_what_it_is_made_with_stands_still_too(cube, helper, act, modifier):
    assert what_changes(cube) is None
    act(cube, helper)
    assert what_changes(cube) == f"the modifier '{modifier}'"


def test_metaballs_are_one_surface():
    balls = []
    for name in ("Ball", "Ball.001", "Other"):
        bpy.ops.object.metaball_add()
        bpy.context.object.name = name
        balls.append(bpy.context.object)
    balls[1].keyframe_insert("location", frame=1)
    said = [what_changes(ball) for ball in balls]
    assert said == ["an object that its shape is made with", "animation", None]


def test_objects_that_are_made_with_each_other_stand_still(cube):
    bpy.ops.mesh.primitive_cube_add()
    for one, other in ((cube, bpy.context.object), (bpy.context.object, cube)):
        one.modifiers.new("Wrap", "SHRINKWRAP").target = other
    assert what_changes(cube) is None
    wave(bpy.context.object)
    assert what_changes(cube) == "the modifier 'Wrap'"


MOVED = [
    (lambda obj, _: obj.keyframe_insert("location", frame=1), "animation"),
    (carried, "animation of its parent"),
    (shape_keyed, "animation of its shape"),
    (lambda obj, _: obj.modifiers.new("Array", "ARRAY").keyframe_insert("count", frame=1), "animation of its shape"),
    (hooked, "the modifier 'Hook'"),
    (lambda obj, _: wave(obj), "the modifier 'Wave'"),
    (lambda obj, _: obj.modifiers.new("Dust", "PARTICLE_SYSTEM"), "the modifier 'Dust'"),
    (timed, "the modifier 'Nodes'"),
    (lambda obj, _: rigid(obj, "ACTIVE"), "physics"),
]


@pytest.mark.parametrize(("act", "mover"), MOVED)
def test_what_moves_is_named(cube, helper, act, mover):
    act(cube, helper)
    assert what_changes(cube) == mover
    said = f"'Cube' is moved by {mover}, and what is avoided must stand still; "
    assert unsteady([cube], []) == said + "remove that, or leave it out of what is avoided"


STILL = [
    lambda obj, _: obj.keyframe_insert("color", frame=1),
    lambda obj, helper: setattr(obj, "parent", helper),
    lambda obj, helper: setattr(obj.modifiers.new("Hook", "HOOK"), "object", helper),
    lambda obj, _: obj.modifiers.new("Array", "ARRAY"),
    lambda obj, _: setattr(obj.modifiers.new("Wave", "WAVE"), "show_viewport", False),
    lambda obj, _: rigid(obj, "PASSIVE"),
]


@pytest.mark.parametrize("act", STILL)
def test_what_stands_still_does(cube, helper, act):
    act(cube, helper)
    assert what_changes(cube) is None


def test_what_is_made_with_a_relaxed_curve_moves(cube):
    ring, line = (add_curve([regular_polygon(20).vertices], name) for name in ("Ring", "Line"))
    cube.modifiers.new("Bent", "CURVE").object = ring
    line.data.bevel_mode, line.data.bevel_object = "OBJECT", ring
    assert unsteady([cube, line], []) is None
    assert unsteady([cube], [ring]).startswith("'Cube' is moved by the modifier 'Bent'")
    assert unsteady([line], [ring]).startswith("'Line' is moved by an object that its shape is made with")


def test_a_curve_must_keep_its_place_only_where_it_avoids_something(cube):
    ring = add_curve([regular_polygon(20).vertices], "Ring")
    ring.keyframe_insert("location", frame=1)
    assert unsteady([], [ring]) is None
    assert unsteady([cube], [ring]).startswith("'Ring' is moved by animation, and curves that avoid something must")
