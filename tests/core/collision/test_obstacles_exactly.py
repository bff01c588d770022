"""Free motions near a triangle against exact decisions by rational arithmetic, in code that shares nothing with them.

MOBIUS_FLOW_MOTIONS=12000 makes it more than 100,000 motions; ``benchmarks/obstacles.py`` does so, too.
"""

import os
from collections.abc import Callable

import numpy as np
import pytest
from obstacle_motions import KINDS, Motion, Rng, Tally, gaussian, placed

COUNT = int(os.environ.get("MOBIUS_FLOW_MOTIONS", "30"))


@pytest.mark.parametrize("kind", KINDS)
def test_nothing_false_is_claimed(kind: Callable[[Rng], Motion]) -> None:
    rng, tally = np.random.default_rng(977), Tally()
    for _ in range(COUNT):
        tally.add(placed(rng, kind(rng)))
    print(f"{kind.__name__}: {tally}")
    assert tally.wrong == 0
    assert tally.worst_time > 0.98
    assert tally.timid <= COUNT / 1000


def test_tame_motions_are_of_both_kinds() -> None:
    rng, tally = np.random.default_rng(331), Tally()
    for _ in range(COUNT):
        tally.add(gaussian(rng))
    assert tally.hits > COUNT / 10
    assert tally.misses > COUNT / 10
