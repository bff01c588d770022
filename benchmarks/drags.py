"""Random drags, violent ones among them: no contact, no other type, no hang.

    python benchmarks/drags.py [DRAGS] [SEED]

Curves are dragged ten times each while they relax: gently, far away, to and fro from step to step, through the middle
of the curve, with pins left and two strands in turn.  For each run the path is verified like its file, the type is
identified before and after, and the cost of a drag is reported.
"""

import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from mobius_flow.core import Curve, Hand, Obstacle, RelaxOptions, Task, Trajectory, relax
from mobius_flow.core.knots import knot, knot_type
from mobius_flow.core.proof import verify

_OF_A_RUN = 10
_MOVES = 12  # iterates of a drag
_FREE = 4  # iterates after it
_CURVES = ("0_1", "3_1", "4_1", "5_2", "L2a1", "L5a1", "8_19", "3_1#3_1", "goeritz")
_KINDS = ("gentle", "far", "shaken", "through", "huge")


def targets(kind: str, held: np.ndarray, curve: Curve, rng: np.random.Generator) -> Iterator[np.ndarray]:
    """Where the hand goes, iterate by iterate."""
    size = float(np.ptp(curve.vertices, axis=0).max())
    middle = curve.vertices.mean(axis=0)
    way = rng.normal(size=3) * {"gentle": 0.3, "far": 3.0, "shaken": 2.0, "through": 0.0, "huge": 1e6}[kind] * size
    for k in range(1, _MOVES + 1):
        if kind == "shaken":
            yield held + rng.normal(size=3) * 2.0 * size
        elif kind == "through":
            yield held + (middle - held) * 4.0 * k / _MOVES
        else:
            yield held + way * (k / _MOVES if kind == "gentle" else 1.0)


def run(name: str, rng: np.random.Generator, told: Counter[str], room: Path) -> float:
    """Do one run; return the seconds of its slowest iterate. Raises AssertionError if a promise is broken."""
    curve = knot(name, int(rng.integers(60, 140)))
    size, beside = np.ptp(curve.vertices), curve.vertices[:, 0].min() * 1.1
    wall = Obstacle([[beside, -size, -size], [beside, size, -size], [beside, 0.0, size]], [[0, 1, 2]], "wall")
    task = Task(curve=curve, obstacles=(wall,)) if rng.random() < 0.3 else Task(curve=curve)
    hand, options = Hand(), RelaxOptions(vertices=len(curve), mesh="fixed", untangle="never", max_iterations=60)
    trajectory, slowest, drags, plan = Trajectory(None, task.obstacles), 0.0, 0, iter(())
    last, asked, rest = None, time.perf_counter(), 0
    for iterate in relax(task, options, hand):
        slowest = max(slowest, time.perf_counter() - asked)
        trajectory.add(iterate)
        last = iterate
        assert iterate.certified, f"{name}: not certified at iterate {iterate.index}"
        assert np.isfinite(iterate.curve.vertices).all()
        if (target := next(plan, None)) is not None:
            hand.move(target)
        elif rest:
            rest -= 1
            if rest == _FREE - 1:
                hand.release(pin=bool(rng.random() < 0.1))
        elif drags < _OF_A_RUN:
            kind = str(rng.choice(_KINDS))
            component = int(rng.integers(len(curve.mesh.component_sizes)))
            share = float(rng.random())
            hand.grab(component, share)
            piece = iterate.curve.mesh.slices[component]
            held = iterate.curve.vertices[piece][int(share * (piece.stop - piece.start - 1))]
            plan, rest = targets(kind, held, iterate.curve, rng), _FREE
            drags += 1
            told[kind] += 1
        asked = time.perf_counter()
    assert last is not None
    told["run that ended before its drags"] += drags < _OF_A_RUN
    path = room / "drags.npz"
    trajectory.save(path)
    verdict = verify(path)
    assert verdict.accepted, f"{name}: {verdict}"
    before, after = knot_type(curve), knot_type(last.curve)
    assert before.names == after.names, f"{name}: was {before}, is {after}"
    told["leg verified"] += verdict.legs
    told["type identified"] += bool(before.names)
    return slowest


def main(drags: int, seed: int) -> None:
    """Do as many drags as asked for."""
    rng, told, slowest, began = np.random.default_rng(seed), Counter[str](), 0.0, time.perf_counter()
    with tempfile.TemporaryDirectory() as room:
        for k in range(-(-drags // _OF_A_RUN)):
            slowest = max(slowest, run(_CURVES[k % len(_CURVES)], rng, told, Path(room)))
            print(f"\r{sum(told[kind] for kind in _KINDS)} drags, no contact, no other type", end="", flush=True)
    print(f"; {time.perf_counter() - began:.0f} s, slowest iterate {slowest:.2f} s")
    print(", ".join(f"{what}: {count}" for what, count in told.items()))


if __name__ == "__main__":
    given = [int(each) for each in sys.argv[1:]]
    main(*given, *(1000, 1)[len(given) :])
