"""One trial: a motion out of a minimum, and the way down from where it ends."""

from dataclasses import dataclass
from itertools import islice

import numpy as np

from ...types import FloatArray
from ..interventions import ON_A_FIXED_MESH
from ..loop import iterates
from ..run import Run
from .motions import Motion


@dataclass(frozen=True, eq=False)
class Trial:
    """What a trial has come to.

    Attributes
    ----------
    run
        The relaxation at its end, on the mesh and in the problem of the minimum that was left.
    path
        Ends of the straight legs of the whole way, each (n, m), in the user's units.
    certified
        Whether all of them were proved.
    iterations
        Steps that were taken, by the motion and by the relaxation.
    """

    run: Run
    path: tuple[FloatArray, ...]
    certified: bool
    iterations: int


def trial(run: Run, motion: Motion, rng: np.random.Generator, below: float) -> Trial:
    """Leave the point that a run has reached, and relax on the same mesh until the objective is ``below`` a value.

    It ends earlier where the relaxation does, or where no iterations are left.  Raises LinAlgError where a curve on the
    way is too degenerate to be computed with.
    """
    steps = list(islice(motion(run.point, rng), run.iterations_left))
    path = [leg.end.placed for step in steps for leg in step.legs]
    start = run.iterate.curve.with_vertices(path[-1]) if path else run.iterate.curve
    relaxing = Run(run.problem, start, run.options, run.iterations_left - len(steps))
    for iterate in iterates(relaxing, ON_A_FIXED_MESH):
        path += iterate.path
        if iterate.energy < below:
            break
    certified = relaxing.iterate.certified and all(step.certified for step in steps)
    return Trial(relaxing, tuple(path), certified, len(steps) + relaxing.iterate.index)
