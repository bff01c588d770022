"""Motions between unrelated polygons of the same type, and refusals: the tables in docs/morph.md.

    OPENBLAS_NUM_THREADS=1 python benchmarks/morphs.py
    OPENBLAS_NUM_THREADS=1 python benchmarks/morphs.py --only 8_19,perko

A row tells the numbers of vertices of both curves and the most on the way, how far apart their shapes met, in radii of
gyration, the legs, processor seconds of morph, of verify and of the stand-alone checker, and what these say. Exit
status 1: a motion is not found, not accepted by both, or does not begin and end with the curves, or none is refused
that should be.
"""

import argparse
import re
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

from hard_curves import hard_unknot, lattice_knot, lattice_unknot
from mobius_flow.core import Curve, Iterate, NoMotionError, RelaxOptions, Trajectory, morph
from mobius_flow.core.knots import knot, knot_type, scramble, smooth_knot
from mobius_flow.core.knots.planar import drawn
from mobius_flow.core.proof import verify
from mobius_flow.core.proof.checker import check

# two reduced diagrams of 10_161, of writhe 8 and 10, that tables listed as two knots for 75 years
PERKO = (
    "Gauss: U1+O2+U3+U4+O5+O6+U7+U8+O9+O1+U2+O3+O10-U5+O8+U9+O4+U10-U6+O7+",
    "Gauss: O1+U8+O2+U1+O4+U7+U9+O6+U5+O3+O7+U10+O8+U2+U6+O9+O10+U4+U3+O5+",
)
KINDS: Mapping[str, Callable[[str], Curve]] = {
    "lattice": lattice_knot, "braid": knot, "smooth": smooth_knot, "unknot": knot, "code": knot,
    "diagram": lambda name: drawn(knot_type(knot(name)).diagram),  # reduced, with straight lines, and lifted
    "messy": lambda name: scramble(smooth_knot(name, 60), seed=1), "plat": lambda word: knot(f"plat({word})"),
    "random": lambda size: hard_unknot(int(size), seed=7), "steps": lambda size: lattice_unknot(int(size), seed=3),
}  # fmt: skip
PAIRS = {
    "ochiai": "unknot ochiai-1 / unknot thistlethwaite",
    "ochiai-2": "unknot ochiai-2 / unknot ochiai-3",
    "ochiai-4": "unknot ochiai-4 / unknot goeritz",
    "culprit": "steps 40 / unknot culprit",
    "freedman": "unknot freedman-he-wang / unknot tuzun-sikora",
    "random": "random 20 / unknot d28",
    "3_1": "lattice 3_1 / messy 3_1",
    "4_1": "lattice 4_1 / braid m4_1",
    "5_1": "braid 5_1 / diagram 5_1",
    "5_2": "plat 2,2,-1,-1,2 / messy 5_2",
    "6_1": "lattice 6_1 / diagram 6_1",
    "6_2": "braid 6_2 / messy 6_2",
    "6_3": "lattice 6_3 / braid m6_3",
    "7_1": "lattice 7_1 / smooth 7_1",
    "7_2": "lattice 7_2 / diagram 7_2",
    "7_4": "lattice 7_4 / messy 7_4",
    "7_6": "diagram 7_6 / braid 7_6",
    "7_7": "lattice 7_7 / diagram 7_7",
    "8_5": "braid 8_5 / diagram 8_5",
    "8_17": "lattice 8_17 / diagram 8_17",
    "8_19": "lattice 8_19 / messy 8_19",
    "8_20": "diagram 8_20 / braid 8_20",
    "9_42": "lattice 9_42 / diagram 9_42",
    "9_46": "braid 9_46 / diagram 9_46",
    "10_124": "lattice 10_124 / diagram 10_124",
    "perko": f"code {PERKO[0]} / code {PERKO[1]}",
    "hopf": "lattice L2a1 / messy L2a1",
    "L5a1": "lattice L5a1 / plat 2,-1,2,-1,2",
    "L6a4": "lattice L6a4 / diagram L6a4",
    "L6n1": "braid L6n1 / diagram L6n1",
}
DIFFERENT = (
    ("3_1", "m3_1"), ("7_1", "m7_1"), ("3_1#3_1", "3_1#m3_1"), ("5_1", "10_132"), ("6_1", "9_46"),
    ("8_8", "10_129"), ("10_161", "10_162"), ("ochiai-3", "4_1"), ("L5a1", "braid(1,-1)"), ("L6a4", "L6n1"),
)  # fmt: skip
HOPS = RelaxOptions(hops=10)  # where shapes do not meet at once


def row(name: str) -> bool:
    """Print a row; return whether all is well."""
    kinds = (text.split(" ", 1) for text in PAIRS[name].split(" / "))
    (a, b), words = (KINDS[kind](one) for kind, one in kinds), PAIRS[name].replace("code Gauss: ", "")
    way: list[Iterate] = []
    began = time.process_time()
    try:
        result = morph(a, b, HOPS, way.append)
    except NoMotionError as error:
        print(f"{name:9} {words:42.42} {time.process_time() - began:6.1f} s  {error}", flush=True)
        return False
    found = time.process_time()
    trajectory = Trajectory()
    for iterate in way:
        trajectory.add(iterate)
    with TemporaryDirectory() as room:
        trajectory.save(Path(room, "t.npz"))
        saved = time.process_time()
        verdict = verify(Path(room, "t.npz"))
        verified = time.process_time()
        alone = check(Path(room, "t.npz"))
    checked = time.process_time()
    ends = ((a, way[0].curve), (b, way[-1].curve))
    exact = all(sorted(x.vertices.tolist()) == sorted(y.vertices.tolist()) for x, y in ends)
    apart = re.search(r"met, (\S+)", result.message)
    print(
        f"{name:9} {words:42.42} {len(a):4} {len(b):4} {max(len(each.curve) for each in way):5} "
        f"{apart[1] if apart else '?':>7} {verdict.legs:5} {found - began:6.1f} "
        f"{verified - saved:5.1f} {checked - verified:5.1f}  {'accepted' if verdict.accepted else verdict.reason}"
        f"{'' if alone.accepted else f', {alone}'}{'' if exact else ', OTHER ENDS'}",
        flush=True,
    )
    return verdict.accepted and alone and exact and result.certified


def refused(a: str, b: str) -> bool:
    """Print why no motion leads from one knot to another; return whether that is so."""
    began = time.process_time()
    try:
        morph(knot(a), knot(b), HOPS)
    except NoMotionError as error:
        print(f"{a:9} {b:12} {time.process_time() - began:5.2f} s  {error}", flush=True)
        return "no motion leads" in str(error)
    return False


def main() -> int:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", metavar="A,B,…", help=f"pairs, such as {', '.join(PAIRS)}")
    only = parser.parse_args().only
    names = only.split(",") if only else list(PAIRS)
    if unknown := [name for name in names if name not in PAIRS]:
        parser.error(f"pair {unknown[0]!r} is unknown; choose from {', '.join(PAIRS)}")
    good = [row(name) for name in names] + [refused(*pair) for pair in DIFFERENT]
    print(f"{sum(good)} of {len(good)} as they should be")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
