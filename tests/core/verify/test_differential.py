"""Two exact decisions that share no code give the same answer for motions that nothing about is general.

MOBIUS_FLOW_DIFFERENTIAL=100000 makes it a million motions, in about half an hour.
"""

import os
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from degenerate_motions import KINDS, Motion, Rng
from mobius_flow.core.collision.exact import first_contact
from mobius_flow.core.types import FloatArray
from mobius_flow.core.verify.segments import meet

COUNT = int(os.environ.get("MOBIUS_FLOW_DIFFERENTIAL", "300"))


def exact(points: FloatArray) -> list[list[Fraction]]:
    return [[Fraction(x) for x in p] for p in points.tolist()]


@pytest.mark.parametrize("kind", KINDS)
def test_same_answers(kind: Callable[[Rng], Motion]) -> None:
    rng, contacts = np.random.default_rng([93, KINDS.index(kind)]), 0
    for _ in range(COUNT):
        start, end = kind(rng)
        found = meet(exact(start), exact(end))
        assert found == (first_contact(start, end) is not None), (start.tolist(), end.tolist())
        contacts += found
    assert contacts > 0
