"""The exact decision about two moving segments: cases known by hand."""

import os

import numpy as np
import pytest
from degenerate_motions import crossing_shadows
from exact_decisions import meet, until

CROSS = [[-1, 0, 1], [1, 0, 1], [0, -1, 0], [0, 1, 0]]
FLAT = [[0, 1], [1, 1], [0, 0], [1, 0]]
IN_A_ROW = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]


def moved(points: list[list[float]], first: list[float], second: list[float]) -> list[list[float]]:
    steps = (first, first, second, second)
    return [[x + d for x, d in zip(p, step, strict=True)] for p, step in zip(points, steps, strict=True)]


@pytest.mark.parametrize(
    ("start", "end", "contact"),
    [
        (CROSS, moved(CROSS, [0, 0, -4], [0, 0, 0]), 0.25),
        (CROSS, moved(CROSS, [0, 0, -1], [0, 0, 0]), 1),
        (CROSS, moved(CROSS, [0, 0, -0.999], [0, 0, 0]), None),
        (CROSS, moved(CROSS, [0, 1, -1], [0, 0, 0]), 1),  # over an end, exactly
        (CROSS, moved(CROSS, [0, 1.001, -1], [0, 0, 0]), None),
        (CROSS, moved(CROSS, [0, 4, -3], [0, 0, 0]), None),
        (FLAT, moved(FLAT, [0, -4], [0, 0]), 0.25),  # parallel, face to face
        (FLAT, moved(FLAT, [5, -1], [0, 0]), None),
        (FLAT, moved(FLAT, [1, -1], [0, 0]), 1),  # end to end
        (FLAT, [[1, 0], [1, 1], [0, 0], [1, 0]], 1),
        (IN_A_ROW, moved(IN_A_ROW, [4, 0, 0], [0, 0, 0]), 0.25),  # collinear
        (IN_A_ROW, moved(IN_A_ROW, [3, 0.001, 0], [0, 0, 0]), None),
        (IN_A_ROW, IN_A_ROW, None),
        (IN_A_ROW, moved(IN_A_ROW, [0, 7, 0], [0, 0, 7]), None),
        ([[0, 0], [2, 2], [0, 2], [2, 0]], [[0, 0], [2, 2], [0, 2], [2, 0]], 0),
        ([[0, 0, 0], [2, 0, 0], [1, 0, 0], [1, 1, 1]], [[9, 9, 9], [8, 8, 7], [1, 2, 3], [4, 4, 4]], 0),
        ([[0, 0], [0, 0], [1, 0], [1, 1]], [[2, 1], [2, 1], [1, 0], [1, 1]], 0.5),  # a point and an edge
        ([[0, 0], [0, 0], [1, 1], [1, 1]], [[2, 2], [2, 2], [1, 1], [1, 1]], 0.5),  # two points
    ],
)
def test_known_contacts(start: list[list[float]], end: list[list[float]], contact: float | None) -> None:
    assert meet(start, end) == (contact is not None)
    if contact is not None:
        assert until(meet, start, end, contact)
        assert contact == 0 or not until(meet, start, end, np.nextafter(contact, 0.0))


def test_contact_at_an_irrational_time() -> None:
    """The point (t, 0) meets the edge from (0, −1) to (2, 4t − 1) where 2t² = 1."""
    start, end = [[0, -1], [2, -1], [0, 0], [0, 0]], [[0, -1], [2, 3], [1, 0], [1, 0]]
    before, after = 0.7071067811865475, 0.7071067811865476
    assert [until(meet, start, end, t) for t in (before, after)] == [False, True]


def test_edges_that_meet_beside_a_multiple_root() -> None:
    """The polynomials have multiple roots where roots are told apart; MOBIUS_FLOW_SHADOWS=3000 makes more of them."""
    rng = np.random.default_rng(617)
    for _ in range(int(os.environ.get("MOBIUS_FLOW_SHADOWS", "300"))):
        start, end = crossing_shadows(rng)
        assert meet(start, end), (start.tolist(), end.tolist())
