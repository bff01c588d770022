"""When a relaxation ends of itself: at a critical point, or after as many iterations as were asked for."""

import numpy as np

from .outcome import Outcome, converged, out_of_iterations
from .run import Run

LENGTHS_REACHED = 1e-6  # max |log ℓ/ℓ⁰| that a converged curve may have


def termination(run: Run) -> Outcome | None:
    """How the run ends where it stands; None if it goes on."""
    iterate, bound = run.iterate, run.options.tolerance * float(np.sqrt(abs(run.point.energy)))
    feasible = not run.problem.geometry.prescribes or iterate.edge_length_error <= LENGTHS_REACHED
    if run.point.gradient_norm <= bound and feasible:
        norm = run.point.with_own_metric().gradient_norm
        if norm <= bound:
            return converged(norm, bound)
    return out_of_iterations(iterate.index) if run.at_limit else None
