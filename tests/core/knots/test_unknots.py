"""Hard unknots are unknots, and hard to see through."""

from itertools import pairwise

import numpy as np
import pytest
from braid_words import burau_alexander
from curve_checks import strand_distance
from hypothesis import given, settings
from hypothesis import strategies as st
from knot_type import UNKNOT, knot_invariants
from mobius_flow.core.errors import CurveError
from mobius_flow.core.knots import hard_unknot, rope, scramble, spiral, unknot_word


@pytest.mark.parametrize(("crossings", "seed"), [(0, 1), (1, 1), (2, 1), (5, 3), (10, 3), (17, 5), (30, 7)])
def test_hard_unknots_have_genus_zero(crossings: int, seed: int) -> None:
    assert knot_invariants(hard_unknot(crossings, seed).vertices) == UNKNOT


@given(crossings=st.integers(0, 60), seed=st.integers(0, 2**32))
@settings(max_examples=30, deadline=None)
def test_words_are_long_reduced_and_trivial(crossings: int, seed: int) -> None:
    word = unknot_word(crossings, seed)
    assert len(word) == crossings
    assert burau_alexander(word, max(map(abs, word), default=0) + 1) == (1,)
    assert all(a != -b for a, b in pairwise(word + word[:1]))


def test_hundreds_of_crossings() -> None:
    word = unknot_word(200, seed=9)
    assert len(word) == 200
    assert burau_alexander(word, max(map(abs, word)) + 1) == (1,)


def test_the_seed_decides() -> None:
    assert np.array_equal(hard_unknot(20, 7).vertices, hard_unknot(20, 7).vertices)
    assert unknot_word(20, 7) != unknot_word(20, 9)


@pytest.mark.parametrize(
    ("crossings", "strands", "reason"),
    [
        (-1, None, "between 0"),
        (10**7, None, "between 0"),
        (10, 4, "even number"),
        (4, 7, "at most one more"),
        (5, 2, "cancels"),
    ],
)
def test_impossible_words(crossings: int, strands: int | None, reason: str) -> None:
    with pytest.raises(CurveError, match=reason):
        unknot_word(crossings, 1, strands=strands)


@pytest.mark.parametrize("turns", [0.5, 1.0, 2.5, 4.0])
@pytest.mark.parametrize("rise", [0.0, 0.7])
def test_spirals_are_unknots_with_strands_apart(turns: float, rise: float) -> None:
    curve = spiral(turns, rise=rise)
    assert strand_distance(curve, apart=3) > min(0.5 / (2 * turns + 1), 2.5 * curve.edge_lengths.max())
    if rise == 0:
        assert not curve.vertices[:, 2].any()
    assert np.linalg.norm(curve.vertices[:, :2], axis=1).max() < 1.5
    tilted = curve.vertices + 0.01 * curve.vertices[:, :1] ** 2 * [0, 0, 1]
    assert knot_invariants(tilted) == UNKNOT


@pytest.mark.parametrize("gap", [0.2, 1e-3, 1e-9])
@pytest.mark.parametrize("twists", [0.0, 3.0, -7.5])
def test_ropes_are_unknots_with_strands_as_near_as_asked(twists: float, gap: float) -> None:
    curve = rope(twists, gap, vertices=100)
    assert len(curve) == 100
    opposite = np.linalg.norm(curve.vertices[:49] - curve.vertices[50:99][::-1], axis=1)
    assert opposite == pytest.approx(gap)
    assert knot_invariants(curve.vertices * [1, 1 / gap, 1 / gap]) == UNKNOT


@pytest.mark.parametrize("arguments", [(0.1,), (1e9,), (float("nan"),), (3.0, 20), (3.0, 10**8)])
def test_impossible_spirals(arguments: tuple[float, ...]) -> None:
    with pytest.raises(CurveError, match="turns"):
        spiral(*arguments)


@pytest.mark.parametrize("rise", [float("nan"), float("inf"), 1e200])
def test_impossible_rises(rise: float) -> None:
    with pytest.raises(CurveError, match="rise"):
        spiral(2.0, rise=rise)


@pytest.mark.parametrize(
    ("twists", "gap", "vertices"),
    [(1, 0, 100), (1, 2, 100), (1, 0.1, 101), (1, 0.1, 6), (40, 0.1, 100), (float("nan"), 0.1, 100)],
)
def test_impossible_ropes(twists: float, gap: float, vertices: int) -> None:
    with pytest.raises(CurveError, match=r"gap|vertices|twists"):
        rope(twists, gap, vertices)


def test_a_scrambled_hard_unknot() -> None:
    assert knot_invariants(scramble(hard_unknot(12, 3), 5).vertices) == UNKNOT
