"""The curves of the benchmarks are of the types that they say they are, free of contact, and awkward as asked for."""

from itertools import pairwise

import numpy as np
import pytest
from braid_words import burau_alexander
from hard_curves import hard_unknot, lattice_closure, rope, unknot_word
from hypothesis import given, settings
from hypothesis import strategies as st
from knot_type import UNKNOT, knot_invariants
from mobius_flow.core.collision import check_embedded
from mobius_flow.core.knots import KNOTS, braid_closure
from mobius_flow.core.knots.diagrams import quick_invariants

WORDS = {name: KNOTS[name] for name in ("0_1", "3_1", "4_1", "8_19", "10_132", "L2a1", "L5a1", "L6a4")}
WORDS |= {f"unknot {c}": unknot_word(c, seed=c) for c in (20, 141)}


@pytest.mark.parametrize(("crossings", "seed"), [(0, 1), (1, 1), (2, 1), (5, 3), (10, 3), (30, 7)])
def test_hard_unknots_are_unknots(crossings, seed):
    assert knot_invariants(hard_unknot(crossings, seed).vertices) == UNKNOT


@given(crossings=st.integers(0, 40), seed=st.integers(0, 2**32))
@settings(max_examples=30, deadline=None)
def test_words_are_long_reduced_and_trivial(crossings, seed):
    word = unknot_word(crossings, seed)
    assert len(word) == crossings
    assert burau_alexander(word, max(map(abs, word), default=0) + 1) == (1,)
    assert all(a != -b for a, b in pairwise(word + word[:1]))


@pytest.mark.parametrize("gap", [0.2, 1e-9])
@pytest.mark.parametrize("twists", [0.0, 3.0, -7.5])
def test_ropes_are_unknots_with_strands_as_near_as_asked(twists, gap):
    curve = rope(twists, gap, vertices=100)
    opposite = np.linalg.norm(curve.vertices[:49] - curve.vertices[50:99][::-1], axis=1)
    assert opposite == pytest.approx(gap)
    assert knot_invariants(curve.vertices * [1, 1 / gap, 1 / gap]) == UNKNOT


@pytest.mark.parametrize("name", WORDS)
def test_lattice_polygons_turn_at_every_vertex_and_have_the_type_of_the_smooth_closure(name):
    curve = lattice_closure(WORDS[name])
    check_embedded(curve)
    assert quick_invariants(curve) == quick_invariants(braid_closure(WORDS[name]))
    assert np.array_equal(curve.vertices, np.round(curve.vertices))
    assert np.all(np.count_nonzero(curve.edge_vectors, axis=1) == 1)
    assert np.all(np.einsum("ij,ij->i", curve.edge_vectors, curve.edge_vectors[curve.mesh.previous]) == 0)
