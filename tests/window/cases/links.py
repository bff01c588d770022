"""Two linked rings: relaxed together; one alone, with the other named; one around the other, which it avoids."""

from collections.abc import Sequence

import bpy
import numpy as np
from case import Steps, picture, until
from hands import addon, button, here, key, open_sidebar, window
from interruption import over
from scene import clear, is_, look, reaches, run
from scene import state as how

MANY = 800  # vertices: steps take long enough for a hand to get between them
TURNED = ((4, -1, 2), (0.3, 0.2, 0.7), (2, 0.5, 1))


def case() -> Steps:
    with here():
        clear()
        add_rings()
        bpy.ops.ed.undo_push(message="Rings")
    before = stored()
    yield from open_sidebar()
    yield from look()
    yield from picture("links-1-ready")
    yield from escaped(before)
    yield from relaxed(before)
    yield from moved(before)
    yield from removed(before)
    yield from one_alone(before)
    yield from one_avoids_the_other(before)


def escaped(before: list[np.ndarray]) -> Steps:
    """Both move, stay linked, and Esc puts both back."""
    linked = linking_number(*in_world())
    assert abs(linked) == 1
    window().scene.mobius_flow.vertices = MANY
    yield from button("curve.mobius_flow_relax")
    yield from reaches(2)
    run().toggle_pause()
    assert all(len(a) != len(b) or not np.array_equal(a, b) for a, b in zip(stored(), before, strict=True))
    assert linking_number(*in_world()) == linked
    yield from picture("links-2-running", differs_from="links-1-ready")
    yield from key("ESC")
    yield from over("Esc")
    are_whole(before)
    yield from picture("links-3-restored", differs_from="links-2-running")


def relaxed(before: list[np.ndarray]) -> Steps:
    """Both have the same keys, are linked at each of them, and one step of undo takes all of it back."""
    linked = linking_number(*in_world())
    window().scene.mobius_flow.vertices = 0
    yield from button("curve.mobius_flow_relax")
    yield from is_("done")
    print("MEASURED", run_message(), flush=True)
    assert "free of contact with themselves and each other" in run_message()
    keys = [obj.data.shape_keys.key_blocks for obj in rings()]
    assert len(keys[0]) == len(keys[1]) > 2
    assert linking_number(*in_world()) == linked
    for k in range(len(keys[0])):
        assert linking_number(*in_world([key_points(each[k]) for each in keys])) == linked
    yield from picture("links-4-done", differs_from="links-1-ready")
    yield from key("Z", ctrl=True)
    yield from until(lambda: all(obj.data.shape_keys is None for obj in rings()), "one undo step for both")
    are_whole(before)


def moved(before: list[np.ndarray]) -> Steps:
    """To move one of them ends the run."""
    window().scene.mobius_flow.vertices = MANY
    yield from started()
    rings()[1].location.x += 0.5
    yield from over("moving one of them", "lost")
    rings()[1].location.x = TURNED[0][0]
    are_whole(before)


def removed(before: list[np.ndarray]) -> Steps:
    """To remove one of them ends the run, and the other is what it was."""
    yield from started()
    bpy.data.objects.remove(rings()[0])
    yield from over("removal of one of them", "lost")
    assert np.array_equal(points(bpy.data.objects["B"]), before[1])
    with here():
        bpy.ops.ed.undo_push(message="Removed")
        bpy.ops.ed.undo()
    yield from until(lambda: "A" in bpy.data.objects, "undo to bring it back")
    are_whole(before)


def one_alone(before: list[np.ndarray]) -> Steps:
    """With one of them selected the panel names the other, which stays as it is."""
    with here():
        window().scene.mobius_flow.vertices = 0
        rings()[0].select_set(False)
        window().view_layer.objects.active = rings()[1]
        bpy.ops.ed.undo_push(message="One selected")
        assert bpy.ops.curve.mobius_flow_relax.poll()
        named = addon("curves.surroundings").warning(bpy.context, [rings()[1]])
    assert named == "'A' nearby is neither selected nor avoided, and may be crossed", named
    yield from picture("links-5-one-selected")
    yield from button("curve.mobius_flow_relax")
    yield from is_("done")
    assert run_message().endswith("free of contact with itself"), run_message()
    assert rings()[0].data.shape_keys is None
    assert np.array_equal(points(rings()[0]), before[0])
    yield from picture("links-6-one-relaxed", differs_from="links-5-one-selected")
    yield from key("Z", ctrl=True)
    yield from until(lambda: rings()[1].data.shape_keys is None, "undo of Relax")
    are_whole(before)


def one_avoids_the_other(before: list[np.ndarray]) -> Steps:
    """What is avoided stays as it is, and the other one around it at every key."""
    yield from button("curve.mobius_flow_avoid")
    yield from until(lambda: window().scene.mobius_flow_surroundings.avoid is not None, "the collection")
    yield from button("curve.mobius_flow_relax")
    yield from is_("done")
    print("MEASURED", run_message(), flush=True)
    assert run_message().endswith("free of contact with itself, and with 'A'"), run_message()
    still, moving = rings()
    assert still.data.shape_keys is None
    assert np.array_equal(points(still), before[0])
    blocks = moving.data.shape_keys.key_blocks
    assert len(blocks) > 2
    assert {linking_number(*in_world([before[0], key_points(each)])) for each in blocks} == {
        linking_number(*in_world(before))
    }
    yield from picture("links-7-avoided", differs_from="links-6-one-relaxed")


def add_rings() -> None:
    """A circle and a ring through it, stretched and turned, each an object; both selected."""
    t = 2 * np.pi * np.arange(24) / 24
    zero = np.zeros(24)
    add("A", np.stack([np.cos(t), np.sin(t), zero], axis=1))
    second = add("B", np.zeros((24, 3)))
    second.location, second.rotation_euler, second.scale = TURNED
    bpy.context.view_layer.update()
    matrix = np.array(second.matrix_world)
    world = np.stack([1 + np.cos(t), zero, 2.5 * np.sin(t)], axis=1)
    local = np.linalg.solve(matrix[:3, :3], (world - matrix[:3, 3]).T).T
    put(second, local)


def add(name: str, coordinates: np.ndarray) -> bpy.types.Object:
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("POLY")
    spline.points.add(len(coordinates) - 1)
    spline.use_cyclic_u = True
    obj = bpy.data.objects.new(name, data)
    put(obj, coordinates)
    window().scene.collection.objects.link(obj)
    obj.select_set(True)
    window().view_layer.objects.active = obj
    return obj


def put(obj: bpy.types.Object, coordinates: np.ndarray) -> None:
    obj.data.splines[0].points.foreach_set("co", np.column_stack([coordinates, np.ones(len(coordinates))]).ravel())


def rings() -> list[bpy.types.Object]:
    return [bpy.data.objects[name] for name in "AB"]


def started() -> Steps:
    with here():
        assert bpy.ops.curve.mobius_flow_relax("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield from reaches(1)
    run().toggle_pause()
    assert how() == "paused"


def points(obj: bpy.types.Object) -> np.ndarray:
    return np.array([p.co[:] for spline in obj.data.splines for p in spline.points], dtype=np.float32)


def key_points(block: bpy.types.ShapeKey) -> np.ndarray:
    return np.array([p.co[:] for p in block.data], dtype=np.float32)


def stored() -> list[np.ndarray]:
    return [points(obj) for obj in rings()]


def are_whole(before: list[np.ndarray]) -> None:
    """See that both curves are what they were, bit for bit."""
    assert all(np.array_equal(a, b) for a, b in zip(stored(), before, strict=True))


def in_world(local: Sequence[np.ndarray] | None = None) -> list[np.ndarray]:
    matrices = [np.array(obj.matrix_world) for obj in rings()]
    pieces = zip(stored() if local is None else local, matrices, strict=True)
    return [each[:, :3].astype(float) @ m[:3, :3].T + m[:3, 3] for each, m in pieces]


def linking_number(a: np.ndarray, b: np.ndarray) -> int:
    """Gauss's integral as the sum of solid angles, exact for polygons."""
    corners = [x[:, None] - y[None] for x in (a, np.roll(a, -1, 0)) for y in (b, np.roll(b, -1, 0))]
    p, q, r, s = (corners[k] / np.linalg.norm(corners[k], axis=2, keepdims=True) for k in (0, 1, 3, 2))

    def angle(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
        volume = np.einsum("ijk,ijk->ij", x, np.cross(y, z))
        dots = sum(np.einsum("ijk,ijk->ij", u, v) for u, v in ((x, y), (y, z), (z, x)))
        return 2 * np.arctan2(volume, 1 + dots)

    return round(float((angle(p, q, r) + angle(p, r, s)).sum()) / (4 * np.pi))


def run_message() -> str:
    return str(addon("live.registry").latest().message) if run() is None else ""
