"""Free motions of whole curves among obstacles."""

import numpy as np
import pytest
from exact_decisions import meet_triangle, until
from mobius_flow.core import Curve, Mesh, Obstacle
from mobius_flow.core.collision import Contact, free_motion, is_free
from mobius_flow.core.collision.boxes import still_triangles
from shapes import hopf_link, regular_polygon
from solids import box, plate, rod, sphere


@pytest.mark.parametrize("scale", [1.0, 2.0**-100, 2.0**100])
@pytest.mark.parametrize("obstacle", [plate(2.0), Obstacle([[-9, 0, 2.0], [9, 0, 2.0]], [[0, 1]], "plate")])
def test_a_wall_in_the_way(obstacle, scale):
    """A circle that turns up: its top meets what is at height 2 after two thirds of the way to 3."""
    curve = Curve(scale * regular_polygon(80).vertices[:, [2, 0, 1]])
    end = curve.vertices + scale * np.array([0.0, 0.0, 3.0])
    still = Obstacle(scale * obstacle.vertices, obstacle.faces, obstacle.name)
    motion = free_motion(curve.mesh, curve.vertices, end, (still,))
    assert not motion.proved
    assert 0.98 / 3 < motion.time < 1 / 3
    assert motion.contact.obstacle == "obstacle plate"
    assert motion.contact.edges[0] in (19, 20)
    assert motion.contact.message == f"edge {motion.contact.edges[0] + 1} and obstacle plate"
    assert not is_free(curve.mesh, curve.vertices, end, (still,))
    assert is_free(curve.mesh, curve.vertices, curve.vertices + motion.time * (end - curve.vertices), (still,))


def test_the_earlier_of_two_contacts_counts():
    link = hopf_link(100)
    end = link.vertices.copy()
    end[100:, 0] += 4.0  # the strands meet after a quarter of it
    alone = free_motion(link.mesh, link.vertices, end)
    early = Obstacle([[2.2, 0, 5.0], [2.2, 0, -5.0]], [[0, 1]], "early")
    late = Obstacle([[4.0, 0, 5.0], [4.0, 0, -5.0]], [[0, 1]], "late")
    assert free_motion(link.mesh, link.vertices, end, (late,)) == alone
    motion = free_motion(link.mesh, link.vertices, end, [late, early])
    assert motion.contact.obstacle == "obstacle early"
    assert 0.98 * 0.05 < motion.time < 0.05


def test_touching_or_piercing_at_the_start():
    circle = regular_polygon(20)
    for obstacle in (plate(0.0), rod(1.0, 0.0), box(-0.5, 2.0)):
        motion = free_motion(circle.mesh, circle.vertices, circle.vertices + 1.0, (obstacle,))
        assert (motion.time, motion.proved) == (0.0, False)


def test_a_point_a_segment_and_a_triangle_without_area_are_the_same_in_the_way():
    circle = regular_polygon(50)
    end = circle.vertices + np.array([0.0, 0.0, 1.0])
    corner = circle.vertices[7] + [0.0, 0.0, 0.5]
    outside = [*(2 * corner[:2]), 0.5]
    for points, face in (([corner], [0, 0]), ([corner, outside], [0, 1]), ([outside, corner], [0, 1, 1])):
        motion = free_motion(circle.mesh, circle.vertices, end, (Obstacle(points, [face]),))
        assert 0.49 < motion.time < 0.5
        assert motion.contact in (Contact((6,), "obstacle"), Contact((7,), "obstacle"))


@pytest.mark.parametrize("seed", range(25))
def test_the_earliest_of_all_contacts(seed):
    rng = np.random.default_rng(seed)
    n, mesh = 7, Mesh((7,))
    start = rng.normal(size=(n, 3))
    end = start + rng.choice([0.1, 0.5]) * rng.normal(size=(n, 3))
    scattered = rng.normal(size=(6, 1, 3)) * 1.5 + 0.6 * rng.normal(size=(6, 3, 3))
    obstacle = Obstacle(scattered.reshape(-1, 3), np.arange(18).reshape(6, 3))
    alone, motion = free_motion(mesh, start, end), free_motion(mesh, start, end, (obstacle,))

    def hits(time):
        return any(
            until(meet_triangle, *(np.concatenate([points[[tail, head]], corners]) for points in (start, end)), time)
            for tail, head in zip(mesh.tails, mesh.heads, strict=True)
            for corners in obstacle.corners
        )

    assert motion.time <= alone.time
    assert not (motion.time > 0 and hits(motion.time))
    assert motion.time == alone.time or hits(min(1.0, motion.time / 0.98))


def test_the_tree_of_obstacles_is_built_once():
    obstacles = (sphere(4.0), plate(9.0))
    assert still_triangles(obstacles, 7) is still_triangles(obstacles, 7)
    still = still_triangles(obstacles, 7)
    assert sorted(still.tree.order) == list(range(sum(len(each.faces) for each in obstacles)))
    for k in (0, 575, 576, 577):
        assert still.obstacle_of(k) is obstacles[k >= len(obstacles[0].faces)]
