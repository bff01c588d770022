"""All who decide about contact decide alike, about motions that nothing is general about and about tame ones.

The checker shares no line with the program.  MOBIUS_FLOW_MOTIONS=4000 makes it some 400,000 motions, in an hour or two.
"""

import os

import degenerate_motions
import motions
import numpy as np
import obstacle_motions
import pytest
from exact_decisions import Tally, meet, meet_triangle, opposite_edges_meet, until, ways
from mobius_flow.core import Mesh
from mobius_flow.core.collision import free_motion, is_free
from mobius_flow.core.collision.exact import first_contact, first_contact_with_triangle
from mobius_flow.core.proof import checker
from mobius_flow.core.proof.filter import doubtful_pairs
from motions import gaussian, placed

COUNT = int(os.environ.get("MOBIUS_FLOW_MOTIONS", "20"))
QUADRILATERAL = Mesh((4,))


@pytest.mark.parametrize("kind", [*degenerate_motions.KINDS, *motions.KINDS], ids=lambda kind: kind.__name__)
def test_about_edges(kind):
    """The exact decisions of both, the checker's planes, and the filter before it, which keeps few other pairs."""
    rng, contacts, left = np.random.default_rng(93), 0, 0
    dimensions = [{"m": 2}, {"m": 3}] if kind in motions.KINDS else [{}, {}]
    for dimension in dimensions * COUNT:
        start, end = kind(rng, **dimension)
        found = meet(start, end)
        assert found == (first_contact(start, end) is not None), (start.tolist(), end.tolist())
        ends = ways(start, end)
        assert not (found and checker.apart(ends[:2], ends[2:]))
        heads = np.array([1, 1, 3, 3])
        pairs = [pair for batch in doubtful_pairs(start, end, heads) for pair in np.sort(batch, axis=0).T.tolist()]
        assert not (found and [0, 1, 2, 3] not in pairs)
        left += not found and [0, 1, 2, 3] in pairs
        contacts += found
    assert contacts > 0
    if kind is gaussian:
        assert left <= 0.2 * COUNT


@pytest.mark.parametrize("kind", obstacle_motions.KINDS, ids=lambda kind: kind.__name__)
def test_about_triangles(kind):
    """So does the search, but for edges that almost shrink to a point."""
    rng, tally = np.random.default_rng(977), Tally(obstacle_motions.meets)
    for _ in range(COUNT):
        start, end = obstacle_motions.placed(rng, kind(rng))
        found, points = meet_triangle(start, end), ways(start, end)
        assert found == (first_contact_with_triangle(start, end) is not None), (start.tolist(), end.tolist())
        assert not (found and checker.apart(points[:2], points[2:]))
        before = tally.timid
        tally.add(start, end, obstacle_motions.free(start, end))
        if obstacle_motions.almost_shrinks((start, end)):
            tally.timid = before
    assert (tally.wrong, tally.blunt) == (0, 0), tally
    assert tally.timid <= COUNT / 1000
    if kind is obstacle_motions.gaussian:
        assert min(tally.hits, tally.misses) > COUNT / 30


@pytest.mark.parametrize("m", [2, 3])
@pytest.mark.parametrize("kind", motions.KINDS, ids=lambda kind: kind.__name__)
def test_about_quadrilaterals(kind, m):
    """Nothing false is claimed by the search, nothing free is refused, and contacts are told to 2 %."""
    rng, tally = np.random.default_rng(1047 + m), Tally(opposite_edges_meet)
    for _ in range(COUNT * (6 if kind is gaussian else 1)):
        start, end = placed(rng, kind(rng, m))
        answer = free_motion(QUADRILATERAL, start, end)
        assert is_free(QUADRILATERAL, start, end) == answer.proved
        tally.add(start, end, answer)
    assert (tally.wrong, tally.timid, tally.blunt) == (0, 0, 0), tally
    if kind is gaussian:
        assert min(tally.hits, tally.misses) > COUNT


@pytest.mark.parametrize("ends", [(1.0, 0.3), (0.0, 1.0)])
@pytest.mark.parametrize("gap", [1e-9, -1e-9, 1e-12])
def test_near_misses_are_free(gap, ends):
    """An end that passes the other edge or its end at a small distance is not taken for a contact."""
    rng = np.random.default_rng(77)
    free = 0
    for _ in range(20):
        start, end = gaussian(rng, 3)
        t, (s, r) = 0.4, ends
        x0, x1, y0, y1 = (1 - t) * start + t * end
        normal = np.cross(x1 - x0, y1 - y0)
        shift = (1 - s) * x0 + s * x1 - (1 - r) * y0 - r * y1 - gap * normal / np.linalg.norm(normal)
        shifts = np.stack([shift, shift, 0 * shift, 0 * shift])
        if not opposite_edges_meet(start - shifts, end - shifts):
            free += 1
            assert is_free(QUADRILATERAL, start - shifts, end - shifts)
    assert free


@pytest.mark.parametrize("kind", [obstacle_motions.lattice, obstacle_motions.in_plane, obstacle_motions.inside])
def test_an_edge_meets_a_triangle_if_it_does_so_at_some_time(kind):
    """At quarters of the time coordinates are exact; there convex hulls decide, of which nobody else makes use."""
    rng, met = np.random.default_rng(5), 0
    for _ in range(24):
        start, end = kind(rng)
        frames = [(1 - t) * start + t * end for t in np.linspace(0.0, 1.0, 5)]
        touched = [obstacle_motions.touching(frame) for frame in frames]
        assert touched == [first_contact_with_triangle(frame, frame) is not None for frame in frames]
        assert touched == [meet_triangle(frame, frame) for frame in frames]
        if any(touched):
            assert meet_triangle(start, end)
            assert first_contact_with_triangle(start, end) is not None
        met += any(touched)
    assert met > 3


def test_parts_of_a_motion_meet_from_the_contact_on():
    start, end = np.array([[-1.0, 0, 1], [1, 0, 1], [0, -1, 0], [0, 1, 0]]), np.zeros((4, 3))
    assert [until(meet, start, end, t) for t in (0.0, 0.5, np.nextafter(1.0, 0.0), 1.0)] == [False] * 3 + [True]
