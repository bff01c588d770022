"""The times at which moving boxes can overlap, against rational numbers."""

from fractions import Fraction

import numpy as np
from mobius_flow.core.collision.boxes import contact_window


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
