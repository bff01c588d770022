"""Free motions of quadrilaterals against exact decisions at algebraic times, by code that shares nothing with them.

MOBIUS_FLOW_MOTIONS=4000 makes it more than 100,000 motions (200,000 pairs of edges), in about half an hour.
"""

import os
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
import pytest
from mobius_flow.core import Mesh
from mobius_flow.core.collision import FreeMotion, Limit, free_motion, is_free
from motions import KINDS, Motion, Rng, first_contact, gaussian, placed

QUADRILATERAL = Mesh((4,))
COUNT = int(os.environ.get("MOBIUS_FLOW_MOTIONS", "12"))


@dataclass
class Tally:
    hits: int = 0
    misses: int = 0
    false_hits: int = 0
    worst_time: float = 1.0


def compare(motion: Motion, tally: Tally) -> None:
    """Assert that nothing false is claimed, and note how sharp the answer is."""
    answer = free_motion(QUADRILATERAL, *motion)
    assert is_free(QUADRILATERAL, *motion) == (answer.limit is Limit.NONE)
    contact = first_contact(motion)
    if contact is None:
        tally.misses += 1
        tally.false_hits += answer.limit is not Limit.NONE
        return
    tally.hits += 1
    assert answer.limit is not Limit.NONE, (motion, float(contact.high))
    if contact.sign_of((0, 1)) == 0:
        assert answer == FreeMotion(0.0, answer.contact, Limit.TOUCHING_START)
    else:
        assert Fraction(answer.time) <= contact.low or answer.time == 0.0, (motion, float(contact.high))
        tally.worst_time = min(tally.worst_time, answer.time / float(contact.high))


@pytest.mark.parametrize("m", [2, 3])
@pytest.mark.parametrize("kind", KINDS)
def test_nothing_false_is_claimed(kind: Callable[[Rng, int], Motion], m: int) -> None:
    rng, tally = np.random.default_rng(1047 + m), Tally()
    for _ in range(COUNT):
        compare(placed(rng, kind(rng, m)), tally)
    print(f"{kind.__name__}, m = {m}: {tally}")
    assert tally.worst_time > 0.98
    assert tally.false_hits == 0


def test_many_tame_motions() -> None:
    rng, tally = np.random.default_rng(331), Tally()
    for _ in range(12 * COUNT):
        compare(gaussian(rng, 3), tally)
    assert tally.hits > COUNT
    assert tally.misses > COUNT
    assert tally.false_hits == 0
    assert tally.worst_time > 0.98


@pytest.mark.parametrize("ends", [(1.0, 0.3), (0.0, 1.0)])
@pytest.mark.parametrize("gap", [1e-9, -1e-9, 1e-12])
def test_near_misses_are_free(gap: float, ends: tuple[float, float]) -> None:
    """An end that passes the other edge or its end at a small distance is not taken for a contact."""
    rng = np.random.default_rng(77)
    free = 0
    for _ in range(20):
        start, end = gaussian(rng, 3)
        t, (s, r) = 0.4, ends
        x0, x1, y0, y1 = (1 - t) * start + t * end
        normal = np.cross(x1 - x0, y1 - y0)
        shift = (1 - s) * x0 + s * x1 - (1 - r) * y0 - r * y1 - gap * normal / np.linalg.norm(normal)
        shifts = np.stack([shift, shift, 0 * shift, 0 * shift])
        motion = start - shifts, end - shifts
        if first_contact(motion) is None:
            free += 1
            assert is_free(QUADRILATERAL, *motion)
    assert free
