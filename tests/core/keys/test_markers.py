"""Keys where the mesh changes: all have the points of every mesh, which lie on the edges of the others."""

import numpy as np
import pytest
from mobius_flow.core import Curve, MobiusFlowError, RelaxOptions, relax
from mobius_flow.core.collision import is_rope
from mobius_flow.core.curve.refine import subdivide
from mobius_flow.core.keys.markers import Markers
from mobius_flow.core.keys.motion import Recording
from mobius_flow.core.keys.placement import Link, Placement
from recorded_motions import assert_proved, at_rest, followed, iterate
from shapes import lattice_knot, regular_polygon, torus_trefoil


@pytest.fixture(scope="module")
def finer():
    """A run that splits edges in the end."""
    options = RelaxOptions(vertices=40, mesh="finer", tolerance=1e-3)
    iterates = list(relax(lattice_knot("3_1"), options))
    assert len(iterates[0].curve) < len(iterates[-1].curve)
    return iterates


@pytest.mark.parametrize("limit", [None, 6])
def test_points_that_are_added_are_on_the_edges_of_all_keys(finer, limit):
    turned = Placement(np.array([[0.0, -2.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 1.0]]), np.array([1.0, 2.0, 3.0]))
    link = Link((turned,), (1,))
    motion = followed(finer, link)
    keys = motion.keys(is_rope, limit)
    start, end = finer[0].curve, finer[-1].curve
    assert {len(key.points) for key in keys.keys} == {len(end)}
    assert_proved(keys, end.mesh)
    stored = link.to_stored(start.mesh, start.vertices)
    lengths = Curve(keys.keys[0].points.astype(np.float64)).length, Curve(stored).length
    assert lengths[0] == pytest.approx(lengths[1], rel=1e-6)
    assert {tuple(point) for point in stored.astype(np.float32)} <= {tuple(point) for point in keys.keys[0].points}
    assert motion.start.mesh == end.mesh
    every = motion.keys(lambda *_: True).keys
    change = next(k for k, each in enumerate(finer) if len(each.curve) > 40)
    shift = np.abs(every[change].points - every[change - 1].points).max()
    assert shift < 1e-6 * np.abs(every[change].points).max()  # splits move nothing
    other = Recording(at_rest(1))
    other.add(finer[-1])
    with pytest.raises(MobiusFlowError, match="keyframes cannot follow a change to another curve: only 0 vertices"):
        other.add(finer[0])


def test_the_first_marker_may_come_to_lie_between_new_vertices():
    hexagon = np.array(regular_polygon(6).vertices)
    hexagon[0] = 0.6 * hexagon[5] + 0.4 * hexagon[1]  # of five pieces two come before it
    along = np.linspace(hexagon[5], hexagon[1], 6)[1:-1]
    finer = np.concatenate([hexagon[1:], along])
    markers = Markers(6, closed=True)
    markers.change([1, 2, 3, 4, 5], [0, 1, 2, 3, 4], 9)
    markers.change(range(9), range(9), 9)
    shapes = [markers.on(vertices, stage) for stage, vertices in enumerate((hexagon, finer, finer))]
    for shape in shapes:
        np.testing.assert_allclose(shape[0], hexagon[0], atol=1e-12)
        assert Curve(shape).length == pytest.approx(Curve(hexagon).length)
    np.testing.assert_allclose(shapes[1], shapes[2], atol=1e-12)


def test_pins_of_a_refined_mesh_keep_the_numbers_of_its_coarse_keys():
    coarse = torus_trefoil(20)
    pieces = np.full(20, 2)
    fine = subdivide(coarse, pieces)
    motion = Recording(at_rest(1))
    motion.add(iterate(0, coarse.vertices, coarse, pins=(3,)))
    shifted = fine.vertices + 0.1
    shifted[6] = fine.vertices[6] + 1e-6
    motion.add(iterate(1, fine.vertices, fine, path=(), pins=(6,)))
    motion.add(iterate(2, shifted, fine, pins=(6,)))
    frames = np.stack([key.points for key in motion.keys(lambda *_: True).keys])
    np.testing.assert_array_equal(frames[:, 6], np.broadcast_to(coarse.vertices[3].astype(np.float32), (3, 3)))


def test_a_drag_that_is_taken_back_takes_its_meshes_along():
    """The same iterates with a detour over two finer meshes between the third and the fourth make the same keys."""
    task, options = torus_trefoil(40), RelaxOptions(vertices=40, mesh="adaptive", max_iterations=30)
    run = list(relax(task, options))
    stage = next(k for k, each in enumerate(run) if k and not each.path)
    plain, detour = followed(run), followed(run[: stage - 1])
    curve = run[stage - 2].curve
    for k in range(2):
        curve = subdivide(curve, np.full(curve.mesh.edges, 2))
        detour.add(iterate(stage - 1 + k, curve.vertices, curve, ()))
    for each in run[stage - 1 :]:
        detour.add(each)
    expected, found = plain.keys(is_rope), detour.keys(is_rope)
    assert_proved(found, detour.start.mesh)
    np.testing.assert_array_equal(detour.course(found).distance, plain.course(expected).distance)
    for a, b in zip(found.keys, expected.keys, strict=True):
        np.testing.assert_array_equal(a.points, b.points)
