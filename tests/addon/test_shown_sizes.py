"""Keys are the iterates themselves: a constraint of the object keeps the size in which they are shown."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_curve, add_trefoil, contents, drawn, evaluated, in_world, relax
from mobius_flow.addon.curves import bake, sizes
from mobius_flow.addon.curves.moving import what_moves
from mobius_flow.addon.curves.recorded import BakedKeys
from mobius_flow.core import Curve, RelaxOptions
from mobius_flow.core import relax as iterates_of
from mobius_flow.core.keys.placement import Measure
from mobius_flow.core.knots import smooth_knot
from shapes import lattice_knot

FILM = {"timing": "EVEN", "length": 24, "keep_size": "AUTO", "max_iterations": 12, "vertices": 90, "mesh": "fixed"}
FILM |= {"radius": "none"}  # ropes take longer to prove


def shown(obj, frame):
    """The curve that is seen at a frame, in the world."""
    points = evaluated(obj, frame)
    return Curve(in_world(obj.evaluated_get(bpy.context.evaluated_depsgraph_get()), points))


def transforms(obj):
    """Where the artist has put an object."""
    return [*obj.delta_location, *obj.delta_scale, *obj.location, *obj.rotation_euler, *obj.scale]


@pytest.fixture
def lattice():
    """A knot whose size would double while it moves, somewhere off the origin."""
    return add_curve([lattice_knot("4_1").vertices * np.array([1.0, 1.0, -1.0]) + np.array([3.0, 1.0, -0.0])])


def test_keys_are_iterates_bit_for_bit_and_the_film_begins_with_the_given_curve(lattice):
    options = RelaxOptions(max_iterations=12, vertices=90, mesh="fixed", radius="none", tolerance=1e-3)
    points = np.concatenate([[p.co[:3] for p in s.points] for s in lattice.data.splines])
    expected = [each.curve.vertices.astype(np.float32) for each in iterates_of(Curve(points), options)]
    relax(**FILM | {"length": 60}, tolerance=1e-3)
    names = [block.name for block in lattice.data.shape_keys.key_blocks]
    keys = dict(zip(names, BakedKeys([lattice]).frames, strict=True))
    assert len(expected) == 13
    assert (np.signbit(expected[0]) & (expected[0] == 0.0)).any()
    for k, vertices in enumerate(expected):
        assert keys[f"Step {k}"].tobytes() == vertices.tobytes()
    assert sum(name.startswith("Between") for name in names) > 20
    start = shown(lattice, 1).vertices
    np.testing.assert_allclose(start, expected[0], atol=1e-6)
    assert BakedKeys([lattice]).unproved == 0


def test_an_object_can_still_be_moved_and_gives_all_back(lattice):
    lattice.delta_scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    before, given = contents(), transforms(lattice)
    relax(**FILM)
    assert transforms(lattice) == given
    first = shown(lattice, 8).vertices
    lattice.location.x += 5.0
    np.testing.assert_allclose(shown(lattice, 8).vertices, first + np.array([5.0, 0.0, 0.0]), atol=1e-5)
    lattice.location.x -= 5.0
    assert bpy.ops.curve.mobius_flow_clear() == {"FINISHED"}
    assert transforms(lattice) == given
    assert not lattice.animation_data
    assert not lattice.constraints
    bpy.context.view_layer.update()
    assert contents() == before


def move(obj):
    """Turn an object, scale it unevenly, and give it a parent that does so too."""
    obj.rotation_mode = "ZYX"
    obj.parent = parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    for each, angle in ((obj, 0.7), (parent, -0.4)):
        each.location, each.rotation_euler = (1.0, -2.0, 3.0), (angle, 0.3, 2.0 * angle)
        each.scale = each.delta_scale = (1.5, 0.7, 1.1)
    bpy.context.view_layer.update()
    return np.array(parent.matrix_world) @ np.array(obj.matrix_basis)


def test_an_object_is_turned_scaled_and_parented_afterwards_as_any_other(lattice):
    relax(**FILM)
    frames = 1, 7.3, 16, 24
    before = [shown(lattice, frame).vertices for frame in frames]
    keyed = BakedKeys([lattice]).curves
    matrix = move(lattice)
    for frame, seen in zip(frames, before, strict=True):
        expected = seen @ matrix[:3, :3].T + matrix[:3, 3]
        np.testing.assert_allclose(shown(lattice, frame).vertices, expected, atol=2e-5)
        for curve, old in zip(BakedKeys([lattice]).curves, keyed, strict=True):
            expected = old.vertices @ matrix[:3, :3].T + matrix[:3, 3]
            np.testing.assert_allclose(curve.vertices, expected, atol=2e-5)
    assert what_moves(lattice) is None


def test_copies_and_saved_files_keep_the_size_and_the_last_one_takes_the_action_along(lattice, tmp_path):
    relax(**FILM)
    expected = shown(lattice, 16).vertices
    (action,) = (each for each in bpy.data.actions if each.name == "Keep Size")
    bpy.context.collection.objects.link(copy := lattice.copy())
    copy.location.x += 5.0
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    lattice, copy, action = bpy.data.objects["Knot"], bpy.data.objects["Knot.001"], bpy.data.actions["Keep Size"]
    np.testing.assert_allclose(shown(lattice, 16).vertices, expected, atol=1e-6)
    np.testing.assert_allclose(shown(copy, 16).vertices, expected + np.array([5.0, 0.0, 0.0]), atol=1e-5)
    sizes.release(copy)
    assert action.users == 1
    sizes.release(lattice)
    assert "Keep Size" not in bpy.data.actions


@pytest.mark.parametrize("end", ["ESC", "muted", "save", "finish"])
def test_a_run_on_a_film_shows_the_curve_in_its_own_place_and_puts_it_back(operator, lattice, end, tmp_path):
    relax(**FILM)
    bpy.context.scene.frame_set(16)
    limit = lattice.constraints["Keep Size"]
    before, given = shown(lattice, 16).vertices, transforms(lattice)
    natural = lattice.matrix_basis.copy()
    assert lattice.matrix_world != natural
    if end == "muted":
        limit.mute = True
        bpy.context.view_layer.update()
        assert lattice.matrix_world == natural
    operator.continues, operator.given = True, operator.given | {"keep_size": "AUTO", "timing": "EVEN", "length": 20}
    operator.start()
    operator.reach(1)
    assert lattice.matrix_world == natural
    if end == "save":
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
        bpy.context.view_layer.update()
        assert lattice.matrix_world == natural
        operator.run.cancel()
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
        lattice = bpy.data.objects["Knot"]
    elif end in ("ESC", "muted"):
        operator.event("ESC")
        assert limit.mute == (end == "muted"), "it stays so"
        limit.mute = False
    if end != "finish":
        np.testing.assert_allclose(shown(lattice, 16).vertices, before, atol=1e-5)
        assert transforms(lattice) == given
        return
    assert operator.until(lambda: False) == {"FINISHED"}
    sizes = [Measure.RADIUS.of(curve) for curve in BakedKeys([lattice]).curves]
    np.testing.assert_allclose(sizes, sizes[0], rtol=0.02)
    played = bake.scene_range([lattice])
    assert Measure.RADIUS.of(shown(lattice, played[1])) == pytest.approx(sizes[0], rel=1e-3)


def test_copies_and_tubes_are_as_large_as_what_they_show(lattice):
    lattice.data.bevel_depth = 0.05
    relax(**FILM)
    for frame in (1, 12, 24):  # a bevel of the artist's own looks as it did
        bpy.context.scene.frame_set(frame)
        circles = drawn(lattice).reshape(90, -1, 3)
        radii = np.linalg.norm(circles - circles.mean(axis=1, keepdims=True), axis=2)
        assert np.median(radii) == pytest.approx(0.05, rel=0.02)
    bpy.context.scene.frame_set(18)
    tube = drawn(lattice)
    assert bpy.ops.curve.mobius_flow_tube_mesh(sides=8, hide_curve=False) == {"FINISHED"}
    made = bpy.context.object
    bpy.context.scene.frame_set(18)
    low, high = tube.min(axis=0), tube.max(axis=0)
    np.testing.assert_allclose(drawn(made).min(axis=0), low, atol=0.1)
    np.testing.assert_allclose(drawn(made).max(axis=0), high, atol=0.1)
    made.select_set(False)
    lattice.select_set(True)
    bpy.context.view_layer.objects.active = lattice
    assert bpy.ops.curve.mobius_flow_mend(remedy="COPY") == {"FINISHED"}
    np.testing.assert_allclose(drawn(bpy.context.object).min(axis=0), low, atol=1e-3)


def test_a_morph_is_not_larger_on_its_way_and_ends_as_its_goal():
    goal, moving = add_trefoil(40), add_curve([0.5 * smooth_knot("m3_1", 50).vertices])
    moving.select_set(True)
    goal.select_set(True)
    bpy.context.view_layer.objects.active = goal
    sizes = [Measure.RADIUS.of(Curve(evaluated(each).astype(float))) for each in (moving, goal)]
    assert bpy.ops.curve.mobius_flow_morph(length=20, keep_size="AUTO", vertices=60) == {"FINISHED"}
    curves = BakedKeys([moving]).curves
    found = [Measure.RADIUS.of(curve) for curve in curves]
    assert found[0] == pytest.approx(sizes[0], rel=1e-5)
    assert found[-1] == pytest.approx(sizes[1], rel=1e-5)
    assert max(found) < 1.02 * max(sizes)
    assert min(found) > 0.98 * min(sizes)


def test_a_film_of_an_earlier_version_is_refused_in_one_sentence(lattice):
    relax(**FILM)
    for name in ("frames", "course", "sizes"):
        del lattice.data["mobius_flow_bake"][name]
    with pytest.raises(RuntimeError, match="has other keys or points than it was baked with; undo that, or relax a"):
        bpy.ops.curve.mobius_flow_continue()
