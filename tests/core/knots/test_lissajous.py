"""Lissajous knots: the known types of small ones, and no curve that meets itself."""

import numpy as np
import pytest
from knot_type import knot_invariants
from mobius_flow.core import CurveError
from mobius_flow.core.collision import check_embedded
from mobius_flow.core.knots import lissajous_knot, smooth_knot


@pytest.mark.parametrize(
    ("frequencies", "phases", "name"),
    [((3, 2, 7), (0.7, 0.2), "5_2"), ((3, 2, 5), (1.5, 0.2), "6_1"), ((1, 1, 1), (0.7, 0.2), "0_1")],
)
def test_small_ones(frequencies: tuple[int, int, int], phases: tuple[float, float], name: str) -> None:
    found, expected = (
        knot_invariants(curve.vertices) for curve in (lissajous_knot(frequencies, phases), smooth_knot(name))
    )
    assert (found.alexander, found.genus, found.rank) == (expected.alexander, expected.genus, expected.rank)


def test_it_fills_its_box_and_is_embedded() -> None:
    curve = lissajous_knot((3, 5, 7), (0.3, 0.15))
    check_embedded(curve)
    assert np.ptp(curve.vertices, axis=0) == pytest.approx(2.0, abs=0.01)


@pytest.mark.parametrize(
    ("frequencies", "phases", "said"),
    [
        ((2, 4, 5), (0.7, 0.2), "common divisor"),
        ((0, 1, 3), (0.7, 0.2), "from 1 to 40"),
        ((3, 4, 41), (0.7, 0.2), "from 1 to 40"),
        ((3, 4, 7), (0.0, 0.0), "change a phase"),
        ((3, 4, 7), (np.nan, 0.0), "finite"),
    ],
)
def test_what_is_refused(frequencies: tuple[int, int, int], phases: tuple[float, float], said: str) -> None:
    with pytest.raises(CurveError, match=said):
        lissajous_knot(frequencies, phases)
