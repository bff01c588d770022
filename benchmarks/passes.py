"""Strand moves in space on hard diagrams: what they cost, how far they come, and whether others accept them.

    python benchmarks/passes.py [NAME or FILE …]

Without names: the famous unknots of the table, closures of random braids that are unknots, and scrambled knots.  Codes
of diagrams that others have published are given as files.
"""

import argparse
import tempfile
import time
from pathlib import Path

from hard_curves import hard_unknot
from mobius_flow.core import Iterate, Trajectory, WithOutcome, read_curve
from mobius_flow.core.knots import HARD_UNKNOTS, knot, knot_type, scramble
from mobius_flow.core.knots.diagrams import views
from mobius_flow.core.proof import verify
from mobius_flow.core.untangle import untangled


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("curves", nargs="*", metavar="NAME or FILE")
    curves = {name: read_curve(name) if Path(name).exists() else knot(name) for name in parser.parse_args().curves}
    if not curves:
        curves = {name: knot(name) for name in HARD_UNKNOTS}
        curves |= {f"random {crossings}": hard_unknot(crossings, seed=1) for crossings in (100, 200, 300)}
        names = ("5_2", "7_4", "8_19", "L6a4")
        curves |= {f"scrambled {name}": scramble(knot(name, 100), 1, moves=6000) for name in names}
    columns = ("curve", "vertices", "crossings", "left", "moves", "meshes", "legs", "s", "verified", "type")
    print("|", " | ".join(columns), "|\n" + "|---" * len(columns) + "|", flush=True)
    for name, curve in curves.items():
        seen = min((view.crossings for view in views(curve, 12)), default=0)
        began, work = time.process_time(), WithOutcome(untangled(curve))
        stages, found = list(work), work.outcome
        seconds = time.process_time() - began
        trajectory = Trajectory()
        frames = [(curve, ()), *((each, path) for s in stages for each, path in ((s.start, ()), (s.end, s.path)))]
        told = ((shown, path) for k, (shown, path) in enumerate(frames) if path or k % 2 or not k)
        for index, (shown, path) in enumerate(told):
            trajectory.add(Iterate(index, shown, 0.0, 0.0, 0.0, path, True, 0.0, "passes"))
        with tempfile.TemporaryDirectory() as folder:
            trajectory.save(f"{folder}/passes.npz")
            verdict = verify(f"{folder}/passes.npz")
        made = found.crossings, found.moves, len(stages), sum(len(stage.path) for stage in stages), f"{seconds:.1f}"
        last = stages[-1].end if stages else curve
        row = (name, len(curve), seen, *made, "yes" if verdict.accepted else "NO", knot_type(last))
        print("|", " | ".join(map(str, row)), "|", flush=True)


if __name__ == "__main__":
    main()
