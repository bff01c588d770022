"""The plot: inside its frame, first and last iterate in it, its scale the one that shows most."""

import numpy as np
import pytest
from mobius_flow.addon.engine.rest import Target, dashes, plot

WIDTH, HEIGHT = 280.0, 120.0
CIRCLE = Target(4.0, "circle = 4")


def heights(energies, target=None):
    return plot(energies, target, WIDTH, HEIGHT)


@pytest.mark.parametrize("count", [1, 2, 3, 50, 5000])
@pytest.mark.parametrize("target", [None, CIRCLE], ids=["no target", "target"])
def test_all_of_it_is_inside(count, target):
    energies = 4 + 1000 * 0.9 ** np.arange(count)
    drawn = heights(energies, target)
    x, y = drawn.line.T
    assert x[0] == 0
    assert x[-1] == (WIDTH if count > 1 else 0)
    assert (np.diff(x) > 0).all()
    assert ((y > 0) & (y < HEIGHT)).all()
    assert len(x) <= min(count, 2 * WIDTH)
    assert (drawn.target is None) == (target is None)


def test_energies_go_down_on_the_screen_to_the_target_or_stay_above_it():
    drawn = heights([900.0, 30.0, 5.0, 4.0], CIRCLE)
    assert (np.diff(drawn.line[:, 1]) < 0).all()
    assert drawn.line[-1, 1] == pytest.approx(drawn.target)
    above = heights([100.0, 80.0], CIRCLE)
    assert above.target < above.line[:, 1].min()


@pytest.mark.parametrize(("energies", "share"), [([1000.0, 100.0, 10.0], 0.5), ([9.0, 5.0, 4.0], 0.2)])
def test_decades_are_logarithmic_and_less_is_linear(energies, share):
    y = heights(energies).line[:, 1]
    assert (y[1] - y[2]) / (y[0] - y[2]) == pytest.approx(share)


@pytest.mark.parametrize("energies", [[5.0, 5.0, 5.0], [0.0, 0.0], [7.0, 0.0], [30.0, -2.0]], ids=str)
def test_energies_of_any_kind_have_a_place(energies):
    y = heights(energies).line[:, 1]
    assert np.isfinite(y).all()
    assert ((y > 0) & (y < HEIGHT)).all()


def test_dashes_fill_half_of_a_line():
    ends = dashes(100.0, 8.0).reshape(-1, 2)
    assert ends[0, 0] == 0
    assert ends.max() <= 100
    assert (ends[:, 1] - ends[:, 0]).sum() == pytest.approx(50, abs=4)
