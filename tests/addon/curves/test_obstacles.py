"""What objects show becomes obstacles of the world, and reaches the worker and the common space to the last digit."""

import queue
from io import BytesIO
from itertools import pairwise

import numpy as np
import pytest
from mobius_flow.addon.curves.surroundings import Surface, obstacles
from mobius_flow.addon.engine import wire
from mobius_flow.addon.engine.worker import in_common_space, messages
from mobius_flow.core import Curve, CurveError, Obstacle, RelaxOptions, Task
from mobius_flow.core.collision import is_free
from mobius_flow.core.keys.motion import frames_of
from mobius_flow.core.keys.placement import Link, Placement
from shapes import hopf_link

HERE = Placement(np.eye(3), np.zeros(3))
THERE = Placement(np.array([[2.0, 1.0, 0.0], [0.0, -1.0, 0.5], [0.0, 0.0, 3.0]]), np.array([5.0, 6.0, 7.0]))
SQUARE = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 2), (0, 0, 9)], dtype=np.float32)
TRIANGLES = np.array([(0, 1, 2), (2, 3, 0)], dtype=np.int32)
EDGES = np.array([(1, 0), (1, 2), (3, 2), (0, 3), (4, 3)], dtype=np.int32)


def surface(placement=HERE, triangles=TRIANGLES, edges=EDGES, points=SQUARE):
    return Surface.of_mesh(points, triangles, edges, placement)


def none(corners):
    return np.empty((0, corners), dtype=np.int32)


def test_edges_of_triangles_are_not_there_twice():
    np.testing.assert_array_equal(surface().edges, [(4, 3)])
    np.testing.assert_array_equal(surface(triangles=none(3)).edges, EDGES)
    assert len(surface(edges=none(2)).edges) == 0


def test_triangles_and_the_edges_of_none_are_two_obstacles_of_one_name():
    faces, lines = obstacles("Wall", [surface(THERE)])
    np.testing.assert_array_equal(faces.corners, THERE.to_world(SQUARE.astype(float))[TRIANGLES])
    np.testing.assert_array_equal(lines.corners, THERE.to_world(SQUARE.astype(float))[[(4, 3)]])
    assert faces.name == lines.name == "Wall"
    assert len(lines.vertices) == 2, "none that nothing uses: it could be anywhere"


def test_all_pieces_of_an_object_are_together():
    faces, lines = obstacles("Wall", [surface(), surface(edges=none(2)), surface(THERE, triangles=none(3))])
    assert faces.faces.shape == (4, 3)
    assert lines.faces.shape == (6, 2)
    np.testing.assert_array_equal(faces.corners[2:], SQUARE[TRIANGLES])
    np.testing.assert_array_equal(lines.corners[1:], THERE.to_world(SQUARE.astype(float))[EDGES])


@pytest.mark.parametrize("pieces", [[], [surface(triangles=none(3), edges=none(2))]], ids=["no piece", "points alone"])
def test_nothing_is_no_obstacle(pieces):
    with pytest.raises(CurveError, match="'Dust' shows neither faces nor edges"):
        list(obstacles("Dust", pieces))


@pytest.mark.parametrize("bad", [np.nan, np.inf, 3e38])
def test_what_is_not_finite_is_named(bad):
    points = SQUARE.copy()
    points[0, 1] = bad
    with pytest.raises(CurveError, match="A point of 'Wall' is not finite"):
        list(obstacles("Wall", [surface(points=points)]))
    points = SQUARE.copy()
    points[5, 1] = bad
    assert list(obstacles("Wall", [surface(points=points)])), "that point is no corner of anything"


def test_equal_pieces():
    assert surface(THERE).equals(surface(THERE))
    assert not surface(THERE).equals(surface(HERE))
    assert not surface().equals(surface(edges=none(2)))


def test_the_common_space_is_that_of_the_first_object():
    (faces, _) = obstacles("Wall", [surface()])
    (mapped,) = in_common_space([faces], Link((THERE, HERE), (1, 1)))
    np.testing.assert_allclose(THERE.to_world(mapped.vertices), faces.vertices, atol=1e-15)
    assert mapped.name == "Wall"
    (same,) = in_common_space([faces], Link((HERE, THERE), (1, 1)))
    np.testing.assert_array_equal(same.vertices, faces.vertices)


def job(avoid, placement=HERE):
    """A ring through a circle, stretched so that it would leave it, stored in an object's coordinates."""
    ring = hopf_link(24).vertices[24:] * [1.0, 1.0, 4.0]
    link = Link((placement,), (1,))
    stored = link.to_stored(Curve.from_components([ring]).mesh, ring).astype(np.float32)
    curve = Curve.from_components([placement.to_world(stored.astype(float))])
    task = Task(curve=curve, obstacles=avoid)
    return task, RelaxOptions(max_iterations=20, vertices=60, mesh="fixed"), link


def circle():
    points = hopf_link(24).vertices[:24]
    k = np.arange(24)
    return Obstacle(points, np.stack([k, (k + 1) % 24], axis=1), "Circle")


def test_the_worker_is_sent_the_obstacles():
    pipe = BytesIO()
    square = Obstacle(SQUARE, TRIANGLES, "a wall")
    wire.write(pipe, wire.pack_job(*job((square, circle()))))
    pipe.seek(0)
    task, _, _ = wire.unpack_job(wire.read(pipe))
    assert [each.name for each in task.obstacles] == ["a wall", "Circle"]
    for sent, received in zip((square, circle()), task.obstacles, strict=True):
        np.testing.assert_array_equal(received.vertices, sent.vertices)
        np.testing.assert_array_equal(received.faces, sent.faces)


@pytest.mark.parametrize("placement", [HERE, THERE], ids=["plain", "placed"])
def test_the_worker_proves_motions_beside_obstacles(placement):
    """What it proves is free of the obstacle in Blender's own numbers; without it the curve would have crossed."""
    task, options, link = job((circle(),), placement)
    beside = in_common_space(task.obstacles, link)
    assert _frames_are_free(task, options, link, beside)
    assert not _frames_are_free(job((), placement)[0], options, link, beside)


def _frames_are_free(task, options, link, beside):
    inbox = queue.SimpleQueue()
    inbox.put(wire.pack_job(task, options, link))
    *replies, end = messages(inbox)
    assert "outcome" in end[0]
    received = [wire.unpack_iterate(reply) for reply in replies]
    proved = {name for _, names in received for name in names}
    mesh = received[0][0].curve.mesh
    common = [link.to_common(mesh, frame) for iterate, _ in received for frame in frames_of(link, iterate)]
    motions = list(pairwise(common))
    assert {wire.digest(a, b) for a, b in motions} == proved
    return all(is_free(mesh, a, b, beside) for a, b in motions)
