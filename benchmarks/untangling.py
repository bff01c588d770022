"""What strand moves cost, and how they look: runs from tangled curves to the circle, or to a knot's least diagram.

    OPENBLAS_NUM_THREADS=1 python benchmarks/untangling.py CASE … [--seeds 5] [--untangle always] [--save FILE.npz]

A case is a name of `knot`, a file, or made by seed: scrambled:NAME of a knot's table, braid:100 crossings of an unknot,
rational:100 crossings in twists that undo each other (Kauffman and Lambropoulou 2012), backtrack:FILE a diagram that
Reidemeister's moves have made worse (both need spherogram).  Without cases: famous ones, and two of each kind.

"frames" are places on the way; "thickness" is the least over the start's; "turn" the most at a vertex, in degrees, and
the median over frames; "speed" the largest way of a point between two frames of the film over its median, and where.
"""

import argparse
import random
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from hard_curves import hard_unknot
from mobius_flow.core import Curve, Iterate, RelaxOptions, minimize, read_curve
from mobius_flow.core.collision import thickness
from mobius_flow.core.keys.key_options import Playing
from mobius_flow.core.keys.motion import recorded
from mobius_flow.core.keys.placement import Measure
from mobius_flow.core.knots import knot, scramble
from mobius_flow.core.knots.diagrams import simplified
from mobius_flow.core.knots.diagrams.codes import diagram_from_code
from mobius_flow.core.knots.diagrams.projection import views

CASES = ["haken", "ochiai-4", "scrambled:5_2", "scrambled:L6a4", "braid:100", "braid:200", "rational:100"]


def main(arguments: Sequence[str] | None = None) -> None:
    """Print a row for each case and seed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", default=CASES)
    parser.add_argument("--seeds", type=int, nargs="*", default=[1])
    parser.add_argument("--untangle", default="auto")
    parser.add_argument("--limit", type=float, default=600.0, help="seconds of each run, by the clock")
    parser.add_argument("--save", type=Path)
    given = parser.parse_args(arguments)
    print(f"{'case':24} seed    cr.   energy      s frames thick     turn      speed")
    for name, seed in ((name, seed) for name in given.cases for seed in given.seeds):
        began, iterates = time.process_time(), list[Iterate]()
        curve = made(name, seed)
        options = RelaxOptions(seed=seed, untangle=given.untangle, time_limit=given.limit)
        result = minimize(curve, options, callback=iterates.append)
        seconds = time.process_time() - began
        start = min(view.crossings for view in views(curve, 8))
        left = min(simplified(view).crossings for view in views(result.curve, 8))
        frames = [each.curve.with_vertices(x) for each in iterates for x in each.path or (each.curve.vertices,)]
        shown = frames[:: max(1, len(frames) // 400)]
        thick = min(thickness(each) for each in shown) / thickness(curve)
        turns = np.array([sharpest_turn(each) for each in frames])
        speed, at, count = film_speed(iterates)
        print(
            f"{Path(name).stem[-24:]:24} {seed:4} {start:3}→{left:3} {result.final_energy:8.3f} {seconds:6.1f} "
            f"{len(frames):6} {thick:5.2f} {turns.max():4.0f}, {np.median(turns):2.0f} {speed:5.2f} {at}/{count} "
            f"{'' if result.certified else 'NOT CERTIFIED '}{result.message}",
            flush=True,
        )
        if given.save:
            np.savez_compressed(given.save, *(each.vertices for each in frames))


def made(case: str, seed: int) -> Curve:
    """The curve of a case."""
    kind, _, name = case.rpartition(":")
    if kind == "scrambled":
        return scramble(knot(name, 100), seed, moves=800)
    if kind == "braid":
        return hard_unknot(int(name), seed)
    if kind == "rational":
        from spherogram import RationalTangle

        # consecutive convergents p/q and r/s of a continued fraction have p s − q r = ±1: N(p/q − r/s) is the unknot
        rng, left, p, q, r, s = np.random.default_rng(seed), int(name) // 2, 1, 0, 0, 1
        while left > 0:
            term = min(int(rng.integers(1, 4)), left)
            p, q, r, s, left = term * p + r, term * q + s, p, q, left - term
        return Curve.of((RationalTangle(p, q) + RationalTangle(-r, s)).numerator_closure())
    if kind == "backtrack":
        from spherogram import Link

        random.seed(seed)
        link = Link(diagram_from_code(Path(name).read_text(encoding="utf-8")).planar_code)
        link.backtrack(60, prob_type_1=0.2, prob_type_2=0.3)
        return Curve.of(link)
    return read_curve(case) if Path(case).exists() else knot(case)


def sharpest_turn(curve: Curve) -> float:
    """The largest angle by which a curve turns at a vertex, in degrees."""
    mesh, along = curve.mesh, curve.edge_vectors / curve.edge_lengths[:, None]
    inner = mesh.inner
    cosine = np.einsum("ij,ij->i", along[mesh.incoming[inner]], along[mesh.outgoing[inner]])
    return float(np.degrees(np.arccos(cosine.clip(-1.0, 1.0).min())))


def film_speed(iterates: Sequence[Iterate]) -> tuple[float, int, int]:
    """The largest way of a point from one whole frame to the next, over the median, where, and of how many."""
    motion, _ = recorded(iterates, Measure.RADIUS)
    timing = Playing().timed(motion.way).timing
    keys = motion.keys(lambda *_: True, timing.length, timing)
    times, points = timing.frames(motion.course(keys)), np.stack([key.points for key in keys.keys]).astype(float)
    whole = np.arange(np.ceil(times[0]), np.floor(times[-1]) + 1)
    k = np.clip(np.searchsorted(times, whole, side="right") - 1, 0, len(times) - 2)
    part = ((whole - times[k]) / (times[k + 1] - times[k]))[:, None, None]
    ways = np.linalg.norm(np.diff(points[k] * (1.0 - part) + points[k + 1] * part, axis=0), axis=2).max(axis=1)
    return float(ways.max() / np.median(ways)), int(ways.argmax()), len(ways)


if __name__ == "__main__":
    main()
