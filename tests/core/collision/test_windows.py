"""The times at which moving boxes can overlap, against rational numbers, and the search that is split at one of them.

MOBIUS_FLOW_MOTIONS=10000 makes it ten thousand ties, in a minute.
"""

import os
from fractions import Fraction

import numpy as np
from degenerate_motions import ARCS, tied_windows
from mobius_flow.core import Mesh
from mobius_flow.core.collision import is_free
from mobius_flow.core.collision.boxes import contact_window

COUNT = int(os.environ.get("MOBIUS_FLOW_MOTIONS", "200"))
TWO_ARCS = Mesh((2, 2), (False, False))


def exact_window(before: list[float], after: list[float]) -> tuple[Fraction, Fraction] | None:
    """When no gap is positive, of gaps that are linear in time; None if never."""
    enter, leave = Fraction(0), Fraction(1)
    for a, b in zip(map(Fraction, before), map(Fraction, after), strict=True):
        if a > 0 and b > 0:
            return None
        if a > 0:
            enter = max(enter, a / (a - b))
        elif b > 0:
            leave = min(leave, a / (a - b))
    return (enter, leave) if enter <= leave else None


def test_windows_are_never_too_narrow() -> None:
    """Roots are rounded, but boxes that touch for a moment only are found."""
    rng = np.random.default_rng(41)
    gaps = rng.uniform(-1.0, 1.0, size=(2, 2, 400))
    gaps[:, 1] = -gaps[:, 0]  # one gap opens as another one closes: at the same time
    enter, leave = contact_window(gaps)
    found = 0
    for k in range(gaps.shape[2]):
        window = exact_window(gaps[0, :, k].tolist(), gaps[1, :, k].tolist())
        if window is not None:
            found += 1
            assert Fraction(enter[k]) <= window[0] <= window[1] <= Fraction(leave[k])
    assert found > 50


def test_larger_boxes_meet_no_later_and_part_no_earlier() -> None:
    """To the last bit, or a search that is split at a time may find a pair in neither part."""
    rng = np.random.default_rng(43)
    gaps = rng.choice([-1.0, 1.0], size=(2, 1, 40_000)) * 2.0 ** rng.uniform(-3, 0, size=(2, 1, 40_000))
    gaps[rng.random(gaps.shape) < 0.01] = 0.0
    larger = gaps - rng.integers(0, 3, size=gaps.shape) * np.spacing(np.abs(gaps))
    enter, leave = contact_window(gaps)
    first, last = contact_window(larger)
    assert (first <= enter).all()
    assert (leave <= last).all()


def test_no_crossing_slips_through_where_the_search_is_split() -> None:
    rng, mesh = np.random.default_rng(47), Mesh((2,) * ARCS, (False,) * ARCS)
    assert sum(is_free(mesh, *tied_windows(rng)) for _ in range(COUNT)) == 0


def test_digits_that_scaling_costs_hide_no_crossing() -> None:
    """An arc passes another one in so short a time that their distances are numbers without all their digits."""
    unit = 2.0**-1074
    still = np.array([[0.0, 0.0, -1024.0], [0.0, 0.0, 1024.0]])
    # x from and to, and y of the upper end from and to, which is still positive when x vanishes
    for motion in ((1100, -2600, 900, -1500), (1100, -2700, 1000, -1900), (1100, -1024 / unit, 600, -512 / unit)):
        before, after, high, low = unit * np.array(motion)
        start, end = [[before, -600.0, 0.0], [before, high, 0.0]], [[after, -1000.0, 0.0], [after, low, 0.0]]
        assert not is_free(TWO_ARCS, np.concatenate([still, start]), np.concatenate([still, end]))
