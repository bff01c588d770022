"""Walks halve what is not proved, lengthen what is, and yield only what is proved."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mobius_flow.core.collision.motion import walk


@given(end=st.floats(0.01, 50.0), longest=st.floats(0.01, 5.0), seed=st.randoms())
def test_a_walk_is_an_unbroken_chain_of_proved_legs(end, longest, seed) -> None:
    asked: list[tuple[float, float, bool]] = []

    def leg(place: float, stride: float) -> str | None:
        asked.append((place, stride, seed.random() < 0.7))
        return "proved" if asked[-1][2] else None

    legs = list(walk(leg, end, longest, 1e-3 * longest))
    ways = [(place, stride) for place, stride, free in asked if free]
    assert [place for place, _ in legs] == [place + stride for place, stride in ways]
    assert [place for place, _ in ways[1:]] == [place for place, _ in legs[:-1]]
    for (_, before, free), (_, stride, _) in pairwise(asked):
        assert stride == (min(2.0 * before, longest) if free else 0.5 * before)


@pytest.mark.parametrize(("shortest", "tried"), [(1.0, 1), (0.5, 2), (0.3, 2), (0.1, 4)])
def test_strides_shorter_than_the_shortest_are_not_tried(shortest: float, tried: int) -> None:
    strides: list[float] = []
    assert list(walk(lambda _, stride: strides.append(stride), 1.0, 1.0, shortest)) == []
    assert strides == [0.5**k for k in range(tried)]
