"""Lattice polygons: on the lattice, free of contact, few corners, and of the same type as the smooth closures."""

import numpy as np
import pytest
from mobius_flow.core.collision import check_embedded
from mobius_flow.core.knots import KNOTS, braid_closure, lattice_closure, unknot_word
from mobius_flow.core.knots.alexander import signature

WORDS = {name: KNOTS[name] for name in ("0_1", "3_1", "4_1", "7_7", "8_19", "10_132", "L2a1", "L5a1", "L6a4")}
WORDS |= {f"unknot {c}": unknot_word(c, seed=c) for c in (20, 100, 141)}


@pytest.mark.parametrize("name", WORDS)
def test_same_type_as_the_smooth_closure(name):
    curve = lattice_closure(WORDS[name])
    check_embedded(curve)
    assert signature(curve) == signature(braid_closure(WORDS[name]))


@pytest.mark.parametrize("name", WORDS)
def test_edges_lie_on_the_lattice_and_turn_at_every_vertex(name):
    curve = lattice_closure(WORDS[name])
    assert np.array_equal(curve.vertices, np.round(curve.vertices))
    axes = np.count_nonzero(curve.edge_vectors, axis=1)
    assert np.all(axes == 1)
    turns = np.einsum("ij,ij->i", curve.edge_vectors, curve.edge_vectors[curve.mesh.previous])
    assert np.all(turns == 0)
    assert len(curve) <= 8 * len(WORDS[name]) + 6 * (max(map(abs, WORDS[name]), default=0) + 1)


def test_the_mirror_image_is_another_knot():
    left, right = lattice_closure([-1, -1, -1]), lattice_closure([1, 1, 1])
    assert len(left) == len(right)
    assert signature(lattice_closure([1, 1])).linking == (1,)
    assert signature(lattice_closure([-1, -1])).linking == (-1,)
