"""Whatever a test lets ``verify`` look at is shown to the checker alone too, without the filter: both must agree."""

import functools
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from mobius_flow.core.proof import Verdict
from mobius_flow.core.proof.checker import Nearby, Points, Polygons, check
from mobius_flow.core.proof.filter import FloatingSieve

_BOUND = "too many edges are so near"  # of which the one decides more than the other before it gives up


class NearbyForContact(Nearby):
    """The checker's own search for contact; of ropes all pairs would take it minutes."""

    def crowded(
        self, start: Points, end: Points, polygons: Polygons, radius: Sequence[float]
    ) -> Iterator[tuple[int, int, int | None]]:
        if len(start) <= 30:
            return super().crowded(start, end, polygons, radius)
        return FloatingSieve(self.triangles).crowded(start, end, polygons, radius)


def agreeing(verify: Callable[..., Verdict]) -> Callable[..., Verdict]:
    """The same function, which fails where the checker's answer is another one."""

    @functools.wraps(verify)
    def both(path: Path | str, callback: Callable[[int, int], None] | None = None) -> Verdict:
        verdict = verify(path, callback)
        if _BOUND not in verdict.reason:
            alone = check(path, NearbyForContact)
            same = [(each.accepted, each.stage, each.frame, each.legs) for each in (verdict, alone)]
            assert same[0] == same[1], f"{verdict}; without the filter: {alone}"
        return verdict

    return both
