"""Sentences in the sidebar are broken between words, and none of them is lost."""

import pytest

pytest.importorskip("bpy")

import itertools

from mobius_flow.addon.sidebar.layout import wrapped


@pytest.mark.parametrize("room", [1, 9, 20, 1000])
def test_every_line_fits_and_no_word_is_lost(room):
    text = "Points of 'Knot' were added or removed; its relaxation has ended"
    lines = wrapped(text, lambda line: len(line) <= room)
    assert " ".join(lines) == text
    assert all(len(line) <= room or " " not in line for line in lines)
    assert all(len(f"{line} {following.split()[0]}") > room for line, following in itertools.pairwise(lines))
