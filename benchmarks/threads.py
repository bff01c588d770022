"""What it gains that the library works with one BLAS thread: seconds of a relaxation, also while every core is busy.

python benchmarks/threads.py 4_1 --max-iterations 80

Then what more threads could gain at most: the shares of processor time that sums over tiles of pairs have, and LAPACK's
factorisations, and how many times as fast a run would be if two threads halved them.
"""

import argparse
import cProfile
import os
import pstats
import subprocess
import sys
import time
from collections import Counter
from contextlib import ExitStack
from pathlib import Path

from mobius_flow.core import RelaxOptions, Task, relax
from mobius_flow.core.driver.hopping import hopping
from mobius_flow.core.driver.loop import Relaxation
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.driver.run import Run
from mobius_flow.core.knots import knot

SPIN = "import os; parent = os.getppid()\nwhile os.getppid() == parent: pass"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", nargs="?", default="4_1")
    parser.add_argument("--max-iterations", type=int, default=80)
    given = parser.parse_args()
    curve, options = knot(given.name), RelaxOptions(max_iterations=given.max_iterations)
    start = Task(curve=curve).refined()

    def unbounded() -> Relaxation:
        return hopping(Run(start_problem(start, options), start.curve, options))

    print("other work   pools                seconds   of the processors")
    for busy in (0, os.cpu_count() or 1):
        with ExitStack() as stack:
            for _ in range(busy):
                process = stack.enter_context(subprocess.Popen([sys.executable, "-c", SPIN]))
                stack.callback(process.kill)
            for words, work in (("one thread (relax)", relax(curve, options)), ("as NumPy has them", unbounded())):
                began, processor = time.perf_counter(), time.process_time()
                for _ in work:
                    pass
                seconds, processor = time.perf_counter() - began, time.process_time() - processor
                print(f"{busy} processes  {words:19} {seconds:8.2f}   {processor:8.2f}", flush=True)
    profile = cProfile.Profile(builtins=False)  # tracing built-in functions would cost more than they take
    profile.runcall(list, relax(curve, options))
    tiles, lapack = shares(pstats.Stats(profile))
    for words, share in (("tiles", tiles), ("tiles and LAPACK", tiles + lapack)):
        print(
            f"{words}: {share:.0%} of the time, so two threads gain a factor of {1.0 / (1.0 - 0.5 * share):.2f} at most"
        )
    return 0


def shares(profiled: pstats.Stats) -> tuple[float, float]:
    """The shares of the whole time that the default energy and metric, and the factorisations, take."""
    own, within, total = Counter[str](), Counter[str](), 0.0
    for (file, _, function), (_, _, seconds, cumulative, _) in profiled.stats.items():  # type: ignore[attr-defined]
        name = f"{Path(file).parent.name}/{Path(file).stem}.{function}"
        own[name], within[name], total = own[name] + seconds, within[name] + cumulative, total + seconds
    tiles = sum(within[name] for name in ("energies/moebius.value_and_derivative", "metrics/moebius.at"))
    return tiles / total, (within["saddle/dense.cholesky"] + own["metrics/inner_product.inverse"]) / total


if __name__ == "__main__":
    sys.exit(main())
