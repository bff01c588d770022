"""How long a run will still take: told where two forecasts agree, and not otherwise."""

from types import SimpleNamespace

import numpy as np
import pytest
from mobius_flow.core import RelaxOptions, Status, minimize
from mobius_flow.core.driver import TimeLeft
from mobius_flow.core.knots import knot
from shapes import regular_polygon


class Watched:
    """A forecast of a run with a clock of its own, and gradients that fall from 1000 bounds as one says."""

    def __init__(self, gradients, **options):
        self.now = 0.0
        self.left = TimeLeft(RelaxOptions(tolerance=1.0, **options), clock=lambda: self.now)
        curve = regular_polygon(12)
        for k, gradient in enumerate(gradients):
            self.now = float(k)
            moves = SimpleNamespace(done=True)
            self.left.add(SimpleNamespace(index=k, curve=curve, energy=1.0, gradient_norm=gradient, strand_moves=moves))


def halving(count):
    """A gradient that halves every ten seconds reaches its bound at 60 s."""
    return 64 * 0.5 ** (np.arange(count) / 10)


def test_a_slow_motion_alone_is_forecast():
    assert 5.5 < Watched(halving(50)).left.seconds < 22, "of 11 s, told up to a factor of two"
    assert Watched(halving(50), max_iterations=55).left.seconds == pytest.approx(6, rel=0.01), "the limit comes first"


def test_it_is_silent_before_there_is_much_to_go_by():
    for gradients in (halving(9), halving(25), []):  # of 25 the forecasts differ
        assert Watched(gradients).left.seconds is None
    assert Watched(np.full(50, 64.0), max_iterations=79).left.seconds is None, "the limit alone tells no end"


def test_other_meshes_pauses_and_strand_moves_begin_anew():
    watched = Watched(halving(50))
    watched.left.restart()
    assert watched.left.seconds is None
    finer = SimpleNamespace(
        index=50, curve=regular_polygon(24), energy=1.0, gradient_norm=9.0, strand_moves=SimpleNamespace(done=False)
    )
    watched.left.add(finer)
    assert len(watched.left.distances) == 1


def test_a_whole_run_is_watched():
    options = RelaxOptions(vertices=60, mesh="fixed")
    left = TimeLeft(options)
    result = minimize(knot("3_1"), options, left.add)
    assert result.status is Status.CONVERGED
    assert left.distances[-1] == 0.0


def test_what_starts_with_no_energy_is_no_forecast():
    left, moves = TimeLeft(RelaxOptions()), SimpleNamespace(done=True)
    left.add(SimpleNamespace(index=0, curve=regular_polygon(12), energy=0.0, gradient_norm=0.0, strand_moves=moves))
    assert left.seconds is None
