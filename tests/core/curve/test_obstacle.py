"""Obstacles, and the files that they come from."""

import numpy as np
import pytest
from mobius_flow.core import CurveError, CurveFileError, MobiusFlowError, Obstacle, read_obstacle, write_curve
from mobius_flow.core.io.obstacles import triangulated
from shapes import hopf_link, regular_polygon

SQUARE = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]


def test_values_are_copied_and_cannot_be_changed():
    vertices = np.array(SQUARE)
    obstacle = Obstacle(vertices, [[0, 1, 2]], "tile")
    vertices += 1.0
    np.testing.assert_array_equal(obstacle.corners, [SQUARE[:3]])
    assert not any(array.flags.writeable for array in (obstacle.vertices, obstacle.faces, obstacle.corners))
    assert obstacle.size == 1.0
    for faces in ([[0, 1, 1]], [[2, 2, 2]], [[0, 1]], [[3, 3]]):  # without area
        assert len(Obstacle(SQUARE, faces).faces) == 1


@pytest.mark.parametrize(
    ("vertices", "faces", "said"),
    [
        ([*SQUARE[:3], [0.0, np.nan, 0.0]], [[0, 1, 2]], r"tile: vertex 4, \(0, nan, 0\), is not finite"),
        ([*SQUARE[:3], [0.0, 2e40, 0.0]], [[0, 1, 2]], r"tile: vertex 4, .* is beyond 1e\+40; use a larger unit"),
        (SQUARE, [[0, 1, 2], [1, 2, 4]], r"tile: face 2 has vertices \[1, 2, 4\], counted from 0; there are 4"),
        (SQUARE, [[0, 1, -1]], r"tile: face 1 has vertices \[0, 1, -1\]"),
        (SQUARE, [[0, 1, 2.5]], r"tile: faces are of type float64; they must be whole numbers"),
        (SQUARE, [[0, 1, 2, 3]], r"tile: faces have shape \(1, 4\); they must be"),
        (SQUARE, np.empty((0, 3), dtype=int), r"tile: faces have shape \(0, 3\)"),
        (np.array(SQUARE)[:, :2], [[0, 1, 2]], r"tile: vertices have shape \(4, 2\); they must be an array \(k, 3\)"),
        (SQUARE, [[0, 1, 2], [0, 1]], r"tile: vertices and faces must be arrays of numbers"),
        ("cube", [[0, 1, 2]], r"tile: vertices and faces must be arrays of numbers"),
    ],
)
def test_what_is_no_obstacle_is_refused(vertices, faces, said):
    with pytest.raises(CurveError, match=said):
        Obstacle(vertices, faces, "tile")


def obj(tmp_path, text):
    path = tmp_path / "mesh.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0\n" + text)
    return path


def area(obstacle):
    corners = obstacle.corners
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return 0.5 * np.linalg.norm(crossed, axis=1).sum()


@pytest.mark.parametrize(
    "text",
    [
        "f 1 2 3\nf 1 3 4\n",
        "f 1 2 3 4\n",
        "f 1/1 2/2 3/3 4/4\n",
        "vn 0 0 1\nf 1//1 2//1 3//1 4//1\n",
        "vt 0 0\ng side\ns off\nusemtl red\nf 1/1/1 2/1/1 3/1/1\nf 1/1/1 \\\n3/1/1 4/1/1\n",
        "f -4 -3 -2 -1\n",
        "f 1 2 3 4\nv 9 9 9\n",
    ],
)
def test_faces_of_every_spelling_are_read(tmp_path, text):
    obstacle = read_obstacle(obj(tmp_path, text))
    assert obstacle.name == "mesh.obj"
    assert obstacle.faces.shape == (2, 3)
    assert area(obstacle) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("text", "faces"),
    [
        ("f -3 -2 -1\nv 5 5 5\n", [[1, 2, 3]]),  # which count back from where they stand
        ("l 1 2 3\nl 3 4\n", [[0, 1], [1, 2], [2, 3]]),  # segments
        ("l 3 4\nf 1 2 3\n", [[0, 1, 2], [2, 3, 3]]),  # beside faces they name a vertex twice
    ],
)
def test_faces_and_polylines(tmp_path, text, faces):
    obstacle = read_obstacle(obj(tmp_path, text))
    np.testing.assert_array_equal(obstacle.faces, faces)
    if text.startswith("l 3"):
        np.testing.assert_array_equal(obstacle.triangles, [SQUARE[:3]])
        np.testing.assert_array_equal(obstacle.segments, [SQUARE[2:]])


@pytest.mark.parametrize("suffix", [".txt", ".xyz", ".vect", ".json", ".obj"])
def test_curve_files_are_closed_polygons(tmp_path, suffix):
    link = hopf_link(5)
    write_curve(tmp_path / f"link{suffix}", link)
    obstacle = read_obstacle(str(tmp_path / f"link{suffix}"))
    assert sorted(map(tuple, obstacle.faces.tolist())) == sorted(
        zip(link.mesh.tails.tolist(), link.mesh.heads.tolist(), strict=True)
    )
    np.testing.assert_array_equal(obstacle.vertices, link.vertices)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", r"mesh\.obj: no face \(f\) and no polyline \(l\) found"),
        ("f 1 2\n", r"mesh\.obj, line 5: a face \(f\) needs at least three vertices"),
        ("f 1 2 5\n", r"line 5: vertex 5 does not exist; there are 4"),
        ("f 1 2 0\n", r"line 5: vertex 0 does not exist; OBJ counts from 1"),
        ("f 1 2 x\n", r"line 5: 'x' is not a whole number"),
        ("v nan 0 0\nf 1 2 3\n", r"mesh\.obj: vertex 5, \(nan, 0, 0\), is not finite"),
    ],
)
def test_files_that_are_no_obstacles_are_refused(tmp_path, text, said):
    with pytest.raises(CurveFileError, match=said):
        read_obstacle(obj(tmp_path, text))


def test_curves_in_the_plane_are_no_obstacles(tmp_path):
    write_curve(tmp_path / "c.json", regular_polygon(5, dimension=2))
    with pytest.raises(CurveFileError, match="points have 2 coordinates; obstacles are in space"):
        read_obstacle(tmp_path / "c.json")
    with pytest.raises(MobiusFlowError, match="path is 3; give a string or a path"):
        read_obstacle(3)


def polygon_area(points):
    shifted = points - points[0]
    return 0.5 * np.linalg.norm(np.cross(shifted, np.roll(shifted, -1, axis=0)).sum(axis=0))


@pytest.mark.parametrize("seed", range(20))
def test_polygons_that_are_not_convex_are_covered_once(seed):
    """A star-shaped polygon anywhere in space: the triangles' areas add up to its own."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(4, 14))
    angle = 2 * np.pi * (np.arange(n) + rng.uniform(-0.4, 0.4, n)) / n
    flat = rng.uniform(0.2, 2.0, (n, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = flat @ np.linalg.qr(rng.normal(size=(3, 3)))[0][:2] + rng.normal(size=3)
    points = points[:: rng.choice([1, -1])]
    triangles = triangulated(points.tolist())
    assert len(triangles) == n - 2
    assert area(Obstacle(points, triangles)) == pytest.approx(polygon_area(points))


def test_vertices_within_straight_edges_are_corners_of_triangles_with_area():
    square = [[x, y, 0.0] for x, y in ((1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1), (0, 0))]
    for first in range(8):
        points = [*square[first:], *square[:first]]
        corners = Obstacle(points, triangulated(points)).corners
        areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        assert areas.min() > 0.1
        assert areas.sum() == pytest.approx(4.0)
    triangles = triangulated([[0.0, 0.0, float(k % 3)] for k in range(6)])  # without any area
    assert len(triangles) == 4
    assert set(np.ravel(triangles)) == set(range(6))


def test_a_hole_that_a_slit_joins_to_the_outline_stays_open():
    """As exporters write faces with holes: two vertices are named twice."""
    outline, hole = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]], [[1, 1], [1, 3], [3, 3], [3, 1], [1, 1]]
    points = [[*p, 0.0] for p in outline + hole]
    obstacle = Obstacle(points, triangulated(points))
    assert area(obstacle) == pytest.approx(12.0)
    middles = obstacle.corners.mean(axis=1)[:, :2]
    assert (np.abs(middles - 2.0).max(axis=1) > 1.0).all()


def test_faces_with_thousands_of_corners(tmp_path):
    """Cut where that is quick, and refused where it is not, alone or together, before any of it is done."""
    turn = np.linspace(0, 2 * np.pi, 4000, endpoint=False)
    vertices = "".join(f"v {x} {y} 0\n" for x, y in zip(np.cos(turn), np.sin(turn), strict=True))
    face = "f " + " ".join(map(str, range(1, 4001))) + "\n"
    (tmp_path / "disk.obj").write_text(vertices + face)
    assert area(read_obstacle(tmp_path / "disk.obj")) == pytest.approx(np.pi, rel=1e-5)
    for name, faces in (("two.obj", 2 * face), ("huge.obj", "f " + " ".join(["1 2 3"] * 10_000))):
        (tmp_path / name).write_text(vertices + faces)
        with pytest.raises(CurveFileError, match=r"corners takes too long to cut .* triangulate the mesh"):
            read_obstacle(tmp_path / name)
