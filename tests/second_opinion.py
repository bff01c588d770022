"""Whatever a test lets ``verify`` look at is shown to the stand-alone checker too, and both must agree."""

import functools
import runpy
from collections.abc import Callable
from pathlib import Path

from mobius_flow.core.verify import Verdict

CHECKER = Path(__file__).parents[1] / "tools" / "check_trajectory.py"
check: Callable[[object], tuple[bool, str]] = runpy.run_path(str(CHECKER))["check"]
# The one reads more than the other, or decides more pairs before it gives up.
_BOUNDS = ("more than this program takes", "in Fortran order and large", "too many edges are so near")


def agreeing(verify: Callable[..., Verdict]) -> Callable[..., Verdict]:
    """The same function, which fails where the checker's answer is another one."""

    @functools.wraps(verify)
    def both(path: Path | str, callback: Callable[[int, int], None] | None = None) -> Verdict:
        verdict = verify(path, callback)
        if not any(bound in verdict.reason for bound in _BOUNDS):
            accepted, sentence = check(path)
            assert accepted == verdict.accepted, f"{verdict}; the stand-alone checker: {sentence}"
        return verdict

    return both
