"""The plot: inside its frame, first and last iterate in it, its scale the one that shows most."""

import numpy as np
import pytest
from mobius_flow.addon.engine.rest import Target, plot

WIDTH, HEIGHT = 280.0, 120.0
CIRCLE = Target(4.0, "circle = 4")


def heights(energies, target=None):
    return plot(energies, target, WIDTH, HEIGHT)


@pytest.mark.parametrize("count", [1, 2, 3, 50, 5000])
@pytest.mark.parametrize("target", [None, CIRCLE], ids=["no target", "target"])
def test_all_of_it_is_inside(count, target):
    energies = 4 + 1000 * 0.9 ** np.arange(count)
    line, level = heights(energies, target)
    x, y = line.T
    assert x[0] == 0
    assert x[-1] == (WIDTH if count > 1 else 0)
    assert (np.diff(x) > 0).all()
    assert ((y > 0) & (y < HEIGHT)).all()
    assert len(x) <= min(count, 2 * WIDTH)
    assert (level is None) == (target is None)


def test_energies_go_down_on_the_screen_to_the_target_or_stay_above_it():
    line, level = heights([900.0, 30.0, 5.0, 4.0], CIRCLE)
    assert (np.diff(line[:, 1]) < 0).all()
    assert line[-1, 1] == pytest.approx(level)
    line, level = heights([100.0, 80.0], CIRCLE)
    assert level < line[:, 1].min()


@pytest.mark.parametrize(("energies", "share"), [([1000.0, 100.0, 10.0], 0.5), ([9.0, 5.0, 4.0], 0.2)])
def test_decades_are_logarithmic_and_less_is_linear(energies, share):
    y = heights(energies)[0][:, 1]
    assert (y[1] - y[2]) / (y[0] - y[2]) == pytest.approx(share)


@pytest.mark.parametrize("energies", [[5.0, 5.0, 5.0], [0.0, 0.0], [7.0, 0.0], [30.0, -2.0]], ids=str)
def test_energies_of_any_kind_have_a_place(energies):
    y = heights(energies)[0][:, 1]
    assert np.isfinite(y).all()
    assert ((y > 0) & (y < HEIGHT)).all()
