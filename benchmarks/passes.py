"""Strand moves in space on hard diagrams: what they cost, how far they come, and whether others accept them.

    python benchmarks/passes.py [NAME or FILE …]

Without names: the famous unknots of the table, closures of random braids that are unknots, and scrambled knots.  Codes
of diagrams that others have published are given as files.
"""

import tempfile
import time
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import numpy as np
from hard_curves import hard_unknot
from mobius_flow.core import Curve, Iterate, Obstacle, Trajectory, read_curve
from mobius_flow.core.knots import HARD_UNKNOTS, knot, knot_type, scramble
from mobius_flow.core.knots.diagrams import views
from mobius_flow.core.proof import Verdict, verify
from mobius_flow.core.untangle import Stage, untangled
from words import words

SCRAMBLED = ("5_2", "7_4", "8_19", "L6a4")


def verdict(start: Curve, stages: Iterable[Stage], pins: Sequence[int] = (), walls: Sequence[Obstacle] = ()) -> Verdict:
    """The verdict of the independent check on stages."""
    trajectory = Trajectory(obstacles=walls)
    held = start.vertices[list(pins)]
    frames = [(start, ()), *((each, path) for s in stages for each, path in ((s.start, ()), (s.end, s.path)))]
    for index, (curve, path) in enumerate((c, p) for k, (c, p) in enumerate(frames) if p or k % 2 or not k):
        places = [int(np.flatnonzero((curve.vertices == point).all(axis=1))[0]) for point in held]
        trajectory.add(Iterate(index, curve, 0.0, 0.0, 0.0, path, True, 0.0, "passes", pins=tuple(places)))
    with tempfile.TemporaryDirectory() as folder:
        trajectory.save(f"{folder}/passes.npz")
        return verify(f"{folder}/passes.npz")


def curves(names: Sequence[str]) -> Iterator[tuple[str, Curve]]:
    """The cases with the given names or files, or all."""
    for name in names:
        yield name, read_curve(name) if Path(name).exists() else knot(name)
    if names:
        return
    for name in HARD_UNKNOTS:
        yield name, knot(name)
    for crossings in (100, 200, 300):
        yield f"random {crossings}", hard_unknot(crossings, seed=1)
    for name in SCRAMBLED:
        yield f"scrambled {name}", scramble(knot(name, 100), 1, moves=6000)


def main(names: Sequence[str]) -> None:
    """Print the table."""
    columns = ("curve", "vertices", "crossings", "left", "moves", "meshes", "legs", "s", "verified", "type")
    print("|", " | ".join(columns), "|\n" + "|---" * len(columns) + "|", flush=True)
    for name, curve in curves(names):
        seen = min((view.crossings for view in views(curve, 12)), default=0)
        began = time.process_time()
        stages = []
        work = untangled(curve)
        try:
            while True:
                stages.append(next(work))
        except StopIteration as end:
            found = end.value
        seconds = time.process_time() - began
        legs = sum(len(stage.path) for stage in stages)
        accepted = "yes" if verdict(curve, stages).accepted else "NO"
        made = found.crossings, found.moves, len(stages), legs, f"{seconds:.1f}"
        row = (name, len(curve), seen, *made, accepted, knot_type(stages[-1].end if stages else curve))
        print("|", " | ".join(map(str, row)), "|", flush=True)


if __name__ == "__main__":
    main(words(__doc__, "curves", (), str))
