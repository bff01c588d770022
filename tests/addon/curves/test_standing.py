"""What is avoided stands still: whatever moves it, or changes its shape, is found and named."""

import pytest

bpy = pytest.importorskip("bpy")

from blender_scenes import add_curve, show  # noqa: E402
from mobius_flow.addon.curves.standing import unsteady, what_changes  # noqa: E402
from shapes import regular_polygon  # noqa: E402


@pytest.fixture
def cube():
    bpy.ops.mesh.primitive_cube_add()
    return bpy.context.object


@pytest.fixture
def helper():
    return show(bpy.data.objects.new("Helper", None))


def located(obj, _helper):
    obj.keyframe_insert("location", frame=1)
    return "animation"


def carried(obj, helper):
    helper.keyframe_insert("rotation_euler", frame=1)
    obj.parent = helper
    return "animation of its parent"


def shape_keyed(obj, _helper):
    obj.shape_key_add(name="Basis")
    obj.shape_key_add(name="Other").keyframe_insert("value", frame=1)
    return "animation of its shape"


def modifier_keyed(obj, _helper):
    obj.modifiers.new("Array", "ARRAY").keyframe_insert("count", frame=1)
    return "animation of its shape"


def hooked(obj, helper):
    helper.keyframe_insert("location", frame=1)
    obj.modifiers.new("Hook", "HOOK").object = helper
    return "the modifier 'Hook'"


def waving(obj, _helper):
    obj.modifiers.new("Wave", "WAVE")
    return "the modifier 'Wave'"


def scattering(obj, _helper):
    obj.modifiers.new("Dust", "PARTICLE_SYSTEM")
    return "the modifier 'Dust'"


def timed(obj, _helper):
    tree = bpy.data.node_groups.new("Timed", "GeometryNodeTree")
    tree.nodes.new("GeometryNodeInputSceneTime")
    obj.modifiers.new("Nodes", "NODES").node_group = tree
    return "the modifier 'Nodes'"


def falling(obj, _helper):
    bpy.ops.rigidbody.world_add()
    bpy.context.view_layer.objects.active = obj
    bpy.ops.rigidbody.object_add(type="ACTIVE")
    return "physics"


@pytest.mark.parametrize(
    "act", [located, carried, shape_keyed, modifier_keyed, hooked, waving, scattering, timed, falling]
)
def test_what_moves_is_named(cube, helper, act):
    mover = act(cube, helper)
    assert what_changes(cube) == mover
    said = f"'Cube' is moved by {mover}, and what is avoided must stand still; "
    assert unsteady([cube], []) == said + "remove that, or leave it out of what is avoided"


def still(obj, helper):
    obj.keyframe_insert("color", frame=1)


def carried_still(obj, helper):
    obj.parent = helper


def hooked_still(obj, helper):
    obj.modifiers.new("Hook", "HOOK").object = helper


def arrayed(obj, _helper):
    obj.modifiers.new("Array", "ARRAY")


def hidden_wave(obj, _helper):
    obj.modifiers.new("Wave", "WAVE").show_viewport = False


def hit(obj, _helper):
    bpy.ops.rigidbody.world_add()
    bpy.context.view_layer.objects.active = obj
    bpy.ops.rigidbody.object_add(type="PASSIVE")


@pytest.mark.parametrize("act", [still, carried_still, hooked_still, arrayed, hidden_wave, hit])
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
