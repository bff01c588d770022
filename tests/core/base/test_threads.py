"""BLAS threads: one while the library works, and the caller's whenever it does not."""

import sys
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import pytest
import threadpoolctl
from mobius_flow.core import RelaxOptions, minimize, relax
from mobius_flow.core.driver.info import info, measure
from mobius_flow.core.energies.density import Partials
from mobius_flow.core.energies.kpoint import KPointEnergy
from mobius_flow.core.energies.quadrature import MIDPOINT
from mobius_flow.lab.compare.comparison import compare
from shapes import torus_trefoil

TREFOIL = torus_trefoil(40)
SHORT = RelaxOptions(max_iterations=2, vertices=40)
OWN = 2  # threads of the caller's pools
POOLS = threadpoolctl.ThreadpoolController().select(user_api="blas")


def threads():
    """Numbers of threads of this process's BLAS pools."""
    return {library["num_threads"] for library in POOLS.info()}


pytestmark = pytest.mark.skipif(not threads(), reason="this BLAS cannot be bounded")


@pytest.fixture(autouse=True)
def _pools():
    """Pools of a caller, of more threads than those of the tests; nothing of them may be left changed."""
    before = POOLS.limit(limits=OWN)
    with POOLS.limit(limits=None):  # when this ends the thread that has set a number lets go of the pools
        assert threads() == {OWN}
    yield
    assert threads() == {OWN}
    before.restore_original_limits()


class FaultError(Exception):
    """Raised by a faulty energy."""


@dataclass(frozen=True)
class Spy:
    """F = 1/r³, which notes the threads that there are when it is asked for, and can fail."""

    seen: set[int] = field(default_factory=set)
    faulty: bool = False
    constant = 0.0
    scale_exponent = -3.0

    def value(self, pairs):
        self.seen.update(threads())
        if self.faulty:
            raise FaultError
        return pairs.r2**-1.5

    def derivative(self, pairs):
        self.seen.update(threads())
        return Partials(r2=-1.5 * pairs.r2**-2.5)

    @property
    def options(self):
        """Of a short relaxation."""
        return replace(SHORT, energy=KPointEnergy("spy", "1/r³", self, MIDPOINT))


def test_one_thread_at_work_and_the_callers_between_iterates():
    spy = Spy()
    assert [threads() for _ in relax(TREFOIL, spy.options)] == [{OWN}] * 3
    assert spy.seen == {1}


def test_a_callback_has_the_callers_threads():
    spy, seen = Spy(), list[set[int]]()

    def callback(_):
        seen.append(threads())

    minimize(TREFOIL, spy.options, callback)
    assert seen == [{OWN}] * 3
    assert spy.seen == {1}


def test_a_relaxation_that_is_left_leaves_nothing_behind():
    for leave in (0, 1, 2):
        walk = relax(TREFOIL, SHORT)
        for _ in range(leave):
            next(walk)
        walk.close()
        assert threads() == {OWN}


@pytest.mark.parametrize("faulty", [True, False])
def test_errors_leave_nothing_behind(faulty):

    def callback(_):
        raise FaultError

    with pytest.raises(FaultError):
        minimize(TREFOIL, Spy(faulty=faulty).options, callback)
    assert threads() == {OWN}


ENTRANCES: dict[str, Callable[[], object]] = {
    "compare": lambda: list(compare(TREFOIL, ["lbfgs"], SHORT, 60.0)),
    "measure": lambda: measure(TREFOIL, "edge"),
    "info": lambda: info(TREFOIL),
    "final_energy": lambda: minimize(TREFOIL, SHORT).final_energy,
}


@pytest.mark.parametrize("entrance", ENTRANCES)
def test_every_entrance_bounds_the_pools(entrance):
    seen = set()

    def profile(frame, event, _):
        if event == "call" and "core/energies/" in frame.f_code.co_filename.replace("\\", "/"):
            seen.update(threads())

    before = sys.getprofile()
    sys.setprofile(profile)
    try:
        ENTRANCES[entrance]()
    finally:
        sys.setprofile(before)
    assert seen == {1}
