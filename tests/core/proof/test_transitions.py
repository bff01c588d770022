"""Changes of mesh: vertices that rounding puts beside their edge, against exact decisions about all pairs of edges."""

from fractions import Fraction

import numpy as np
import pytest
from exact_decisions import meet
from mobius_flow.core import Mesh
from mobius_flow.core.proof.checker import RefusedError, straightened
from trajectory_files import checked, trajectory

DENORMAL = 5e-324
UNITS = (DENORMAL, 2.0**-52, 2.0**-20)


def changed(folder, bent, strand):
    """On a polygon that loses vertex 1 beside a strand."""
    stages = [
        ([len(part), len(strand)], [np.concatenate([part, strand])]) for part in (bent, np.delete(bent, 1, axis=0))
    ]
    return checked(folder, trajectory(*stages))


@pytest.mark.parametrize(("y", "u"), [(0.0, DENORMAL), (1.0, 2.0**-52)])
def test_a_change_too_small_for_doubles_is_checked(tmp_path, y, u):
    """Half of a last place is the way from the bent edge to the straight one, and a strand is in between."""
    bent = np.array([[-1, y, 0], [0, y, 0], [1, y + u, 0], [1, 5, 0], [-1, 5, 0]], dtype=float)
    strand = np.array([[0, y, -1], [0, y + u, 3], [0, -5, 3], [0, -5, -1]], dtype=float)
    verdict = changed(tmp_path, bent, strand)
    assert not verdict.accepted
    assert "meet" in verdict.reason


def test_the_smallest_doubles_have_last_places_that_are_as_large(tmp_path):
    bent = DENORMAL * np.array([[-1000.0, 0, 0], [0, 3, 0], [1000, 0, 0], [0, 1000, 0]])
    strand = DENORMAL * np.array([[5000.0, 0, 0], [6000, 0, 0], [5000, 1000, 0]])
    assert changed(tmp_path, bent, strand).accepted


def crosses(bent, strand):
    """Whether putting vertex 1 onto the edge between its neighbours meets anything, by all pairs of edges."""
    moved = straightened(bent.tolist(), [0, *range(2, len(bent))])
    points = np.concatenate([bent, strand])
    first = [[Fraction(x) for x in p] for p in points.tolist()]
    last = [moved.get(k, p) for k, p in enumerate(first)]
    mesh = Mesh((len(bent), len(strand)))
    ends = list(zip(mesh.tails.tolist(), mesh.heads.tolist(), strict=True))
    return any(
        meet([first[k] for k in (*ends[i], *ends[j])], [last[k] for k in (*ends[i], *ends[j])])
        for i in range(mesh.size)
        for j in range(i)
        if mesh.disjoint(np.array([i]), np.array([j]))[0]
    )


@pytest.mark.parametrize("unit", UNITS)
def test_random_transitions(tmp_path, unit):
    rng, seen = np.random.default_rng(41), {True: 0, False: 0}
    for _ in range(6 if unit == DENORMAL else 14):  # whose fractions are long
        bent = np.array([[-4, 0, 0], [0, 0, 0], [4, 0, 0], [4, 40, 0], [-4, 40, 0]], dtype=float)
        strand = np.array([[0, 0, -8], [0, 0, 8], [0, -40, 8], [0, -40, -8]], dtype=float)
        scale = 1.0 if unit < 1e-300 else unit * 2.0**50  # large numbers, in which the unit is a rounding error
        bent, strand = scale * bent, scale * strand
        bent[:3] += unit * rng.integers(-3, 4, size=(3, 3))
        strand[:2] += unit * rng.integers(-3, 4, size=(2, 3))
        try:
            expected = crosses(bent, strand)
        except RefusedError:
            continue
        verdict = changed(tmp_path, bent, strand)
        assert verdict.accepted == (not expected), (bent.tolist(), strand.tolist(), str(verdict))
        seen[expected] += 1
    assert min(seen.values()) > 1


EDGE = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]


@pytest.mark.parametrize("places", [[0.0], [1.0], [0.5, 0.5], [0.5, 0.25], [-0.25], [1.25]])
def test_vertices_on_an_edge_follow_each_other_between_its_ends(places):
    polygon = np.array([EDGE[0], *([x, 0.0, 0.0] for x in places), *EDGE[1:]])
    with pytest.raises(RefusedError, match="is not on the edge between its neighbours"):
        straightened(polygon.tolist(), [0, len(places) + 1, len(places) + 2])


def test_rounding_is_sixteen_units_of_the_last_place_of_the_largest_coordinate():
    kept, height = [0, 2, 3], 2.0**-48
    near, far = (np.array([EDGE[0], [0.5, y, 0.0], *EDGE[1:]]) for y in (height, np.nextafter(height, 1.0)))
    assert straightened(near.tolist(), kept) == {1: (0.5, 0.0, 0.0)}
    with pytest.raises(RefusedError):
        straightened(far.tolist(), kept)
