"""Torus knots and braid closures: components, equal edges, energies, and the limits of their arguments."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from knot_diagrams import pairwise_linking
from knot_type import knot_invariants
from mobius_flow.core.base.errors import CurveError, MobiusFlowError
from mobius_flow.core.knots import braid_closure, torus_knot

TORUS = [(2, 3), (2, 7), (3, 4), (3, 5), (5, 3), (4, 5), (5, 2), (7, 2), (1, 1), (1, 6), (6, 1)]


@pytest.mark.parametrize(("p", "q"), TORUS)
def test_torus_knots(p, q):
    found = knot_invariants(torus_knot(p, q).vertices)
    genus = (p - 1) * (q - 1) // 2
    assert (found.genus, found.tau, found.fibered) == (genus, genus, True)
    assert knot_invariants(torus_knot(-p, q).vertices).tau == -genus
    points = torus_knot(p, q, major=7.0, minor=2.0).vertices
    assert np.hypot(np.hypot(points[:, 0], points[:, 1]) - 7.0, points[:, 2]) == pytest.approx(2.0)


@pytest.mark.parametrize(("p", "q"), [(2, 2), (2, 6), (3, 3), (4, 6), (6, -4)])
def test_torus_links(p, q):
    parts = math.gcd(p, q)
    link = torus_knot(p, q)
    assert len(link.mesh.component_sizes) == parts
    assert set(pairwise_linking(link.components).values()) == {p * q // parts**2}


RADII = [
    (1.0, 1.0),
    (1.0, 0.0),
    (1.0, -1.0),
    (math.nan, None),
    (math.inf, None),
    (-1.0, None),
    (1e300, 0.5),
    (1, 1e-300),
]


@pytest.mark.parametrize(("major", "minor"), RADII)
def test_impossible_radii(major, minor):
    with pytest.raises(CurveError, match="0 < minor < major"):
        torus_knot(2, 3, major=major, minor=minor)


@given(word=st.lists(st.integers(-4, 4).filter(bool), max_size=12), strands=st.integers(5, 6))
@settings(max_examples=12, deadline=None)
def test_components_and_linking_numbers_are_those_of_the_word(word, strands):
    curve = braid_closure(word, strands=strands)
    at = list(range(strands))  # by the place where they begin, which strands are at each place after the word
    for letter in word:
        i = abs(letter) - 1
        at[i], at[i + 1] = at[i + 1], at[i]
    label = list(range(strands))  # the least strand of each one's component
    for _ in range(strands):
        for place, strand in enumerate(at):
            label[place] = label[strand] = min(label[place], label[strand])
    order = sorted(set(label))
    assert len(curve.mesh.component_sizes) == len(order)
    crossings = {(i, j): 0 for j in range(len(order)) for i in range(j)}
    here = [order.index(each) for each in label]
    for letter in word:
        i = abs(letter) - 1
        a, b = sorted((here[i], here[i + 1]))
        if a != b:
            crossings[a, b] += 1 if letter > 0 else -1
        here[i], here[i + 1] = here[i + 1], here[i]
    assert pairwise_linking(curve.components) == {pair: total // 2 for pair, total in crossings.items()}


@pytest.mark.parametrize(
    ("word", "strands", "reason"),
    [
        ([1, 0], None, "letter 2"),
        ([1.5], None, "each a whole number"),
        ([1, 2], 2, "need 3"),
        ([600], None, "at most 500"),
        ([1] * 20_001, None, "20001 letters"),
    ],
)
def test_words_that_are_none(word, strands, reason):
    with pytest.raises(MobiusFlowError, match=reason):
        braid_closure(word, strands=strands)
