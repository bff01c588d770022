"""Time limits: they are kept in the middle of steps, and what was reached is kept too."""

import itertools
import os
import signal
from contextlib import suppress

import pytest
from mobius_flow.core import RelaxOptions, Status, WithOutcome, minimize, relax
from mobius_flow.core.base.deadline import TimeIsUp, TimeLimit, check_time, signals_wait
from mobius_flow.core.driver.relax import within
from shapes import torus_trefoil

TREFOIL = torus_trefoil(40)


class Clock:
    """It goes on by a second whenever it is looked at."""

    def __init__(self):
        self.looks = 0

    def __call__(self):
        self.looks += 1
        return float(self.looks)


def test_only_time_within_blocks_counts():
    clock = Clock()
    limit = TimeLimit(10.0, clock)
    for _ in range(3):
        with limit:
            check_time()
        clock.looks += 100
        check_time()  # outside of blocks there is no limit
    assert limit.used == 6.0


def test_of_two_limits_each_is_kept_by_its_own():
    outer, inner = TimeLimit(3.0, Clock()), TimeLimit(100.0, Clock())
    with outer, inner, pytest.raises(TimeIsUp) as up:
        _ = [check_time() for _ in range(10)]
    assert up.value.limit is outer
    relaxation = within(inner, relax(TREFOIL))
    next(relaxation)
    spent = TimeLimit(0.0, Clock())
    with spent, pytest.raises(TimeIsUp):
        next(relaxation)


@pytest.mark.parametrize("method", ["implicit-l2", "trust-region", "lbfgs", "flow-l2", "penalty-nesterov"])
def test_a_step_is_left_in_its_middle(method):
    clock = Clock()
    run = WithOutcome(within(TimeLimit(2.5, clock), relax(TREFOIL, RelaxOptions(method=method, vertices=40))))
    assert [iterate.index for iterate in run] == [0]
    assert run.outcome.status is Status.TIME_LIMIT
    assert clock.looks < 8


def test_an_implicit_step_is_looked_at_many_times():
    """In each iteration of the linear systems, too: there may be thousands."""
    clock = Clock()
    run = within(TimeLimit(1e9, clock), relax(TREFOIL, RelaxOptions(method="implicit-l2", vertices=40)))
    *_, last = itertools.islice(run, 2)
    assert last.index == 1
    assert clock.looks > 30


def test_what_was_reached_is_kept():
    result = minimize(TREFOIL, RelaxOptions(time_limit=1e-9, vertices=40))
    assert result.status is Status.TIME_LIMIT
    assert result.report()["status"] == "time_limit"
    assert result.message == "stopped at the time limit (1e-09 s)"
    assert len(result.energies) == 1
    assert result.certified


@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_waits_where_what_it_raises_would_be_lost(number):
    def leave(*_):
        raise KeyboardInterrupt

    before = signal.signal(number, leave)
    passed = []
    try:
        with pytest.raises(KeyboardInterrupt), signals_wait():  # noqa: PT012
            with suppress(KeyboardInterrupt):  # as Blender does
                signal.raise_signal(number)
            passed.append("rendered")
        assert passed == ["rendered"]
        assert signal.getsignal(number) is leave
    finally:
        signal.signal(number, before)
