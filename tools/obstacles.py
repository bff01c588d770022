"""Write examples/obstacles: still surfaces that anyone can check the documents with.

python tools/obstacles.py
"""

from itertools import combinations
from pathlib import Path

import numpy as np
from mobius_flow.core import Obstacle
from mobius_flow.core.base.types import FloatArray, IntArray

TARGET = Path(__file__).resolve().parents[1] / "examples" / "obstacles"
DIGITS = 6


def grid(points: FloatArray, wrap: tuple[bool, bool], name: str) -> Obstacle:
    """The surface through points, shape (p, q, 3), that is closed in the directions that wrap."""
    p, q = points.shape[:2]
    i, j = np.indices((p - 1 + wrap[0], q - 1 + wrap[1])).reshape(2, -1)
    a, b, c, d = (q * (k % p) + m % q for k, m in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
    return soup(points.reshape(-1, 3)[np.concatenate([[a, b, c], [a, c, d]], axis=1).T], name)


def torus(large: float = 2.0, small: float = 0.8, around: int = 48, across: int = 20) -> Obstacle:
    """A closed tube around the unit circle times ``large``."""
    u, v = np.meshgrid(2 * np.pi * np.arange(around) / around, 2 * np.pi * np.arange(across) / across, indexing="ij")
    radius = large + small * np.cos(v)
    points = np.stack([radius * np.cos(u), radius * np.sin(u), small * np.sin(v)], axis=-1)
    return grid(points, (True, True), "torus")


def cup(radius: float = 1.0, height: float = 1.6, around: int = 32) -> Obstacle:
    """A round cup, open at the top: bottom and wall are one profile turned about the z-axis."""
    profile = np.array([[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 0.4], [1.0, 0.8], [1.0, 1.2], [1.0, 1.6]])
    r, z = radius * profile[:, :1], height / 1.6 * profile[:, 1:]
    t = 2 * np.pi * np.arange(around) / around
    points = np.stack([r * np.cos(t), r * np.sin(t), np.broadcast_to(z, (len(r), around))], axis=-1)
    return grid(points, (False, True), "cup")


def icosphere(radius: float = 1.5, halvings: int = 3) -> Obstacle:
    """A closed surface of nearly equal triangles: an icosahedron, halved and projected."""
    golden = 0.5 * (1.0 + np.sqrt(5.0))
    signs = np.array([[0.0, s, t * golden] for s in (-1, 1) for t in (-1, 1)])
    points = np.concatenate([np.roll(signs, k, axis=1) for k in range(3)])
    near = np.linalg.norm(points[:, None] - points, axis=2) < 2.1
    threes = sorted(combinations(range(12), 3), key=lambda three: three[::-1])
    triangles = np.array([points[[c, b, a]] for a, b, c in threes if near[a, b] and near[b, c] and near[c, a]])
    for _ in range(halvings):
        x, y, z = triangles.transpose(1, 0, 2)
        xy, yz, zx = 0.5 * (x + y), 0.5 * (y + z), 0.5 * (z + x)
        quarters = (x, xy, zx), (xy, y, yz), (zx, yz, z), (xy, yz, zx)
        triangles = np.concatenate([np.stack(each, axis=1) for each in quarters])
    triangles *= radius / np.linalg.norm(triangles, axis=2, keepdims=True)
    return soup(triangles, "icosphere")


def cells(shape: IntArray, size: float, name: str) -> Obstacle:
    """The surface of a union of cubes around the origin, given by a mask of shape (i, j, k)."""
    squares, turn = [], np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])  # one side of the unit cube
    for axis, side in ((axis, side) for axis in range(3) for side in (-1, 1)):
        bare = shape & ~np.roll(np.pad(shape, 1), -side, axis)[1:-1, 1:-1, 1:-1]
        squares.append(np.argwhere(bare)[:, None] + np.insert(turn, axis, 0.5 * side, axis=1))
    corners = np.concatenate(squares) - 0.5 * (np.array(shape.shape) - 1.0)
    return soup(size * corners[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 3), name)


def h_duct() -> Obstacle:
    """A closed duct of square section in the shape of an H."""
    shape = np.zeros((7, 2, 9), dtype=bool)
    shape[:2], shape[5:], shape[:, :, 3:6] = True, True, True
    return cells(shape, 0.5, "h-duct")


def box() -> Obstacle:
    """A closed cube of edge 4."""
    return cells(np.ones((4, 4, 4), dtype=bool), 1.0, "box")


def soup(triangles: FloatArray, name: str) -> Obstacle:
    """Triangles, shape (f, 3, 3), with equal vertices merged, without those that have a vertex twice."""
    points, places = np.unique(triangles.reshape(-1, 3).round(DIGITS) + 0.0, axis=0, return_inverse=True)
    faces = places.reshape(-1, 3)
    return Obstacle(points, faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)], name)


if __name__ == "__main__":
    TARGET.mkdir(exist_ok=True)
    for obstacle in (box(), torus(), icosphere(), cup(), h_duct()):
        vertices = ["v " + " ".join(f"{x:.{DIGITS}g}" for x in vertex) for vertex in obstacle.vertices.tolist()]
        faces = ["f " + " ".join(str(k + 1) for k in face) for face in obstacle.faces.tolist()]
        (TARGET / f"{obstacle.name}.obj").write_text("\n".join([*vertices, *faces]) + "\n", encoding="utf-8")
