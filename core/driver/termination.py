"""When a relaxation ends of itself: at a critical point, or after as many iterations as were asked for."""

import numpy as np

from ..curve import Mesh
from ..energies.components import energy_scale
from .options import RelaxOptions
from .outcome import Outcome, converged, out_of_iterations
from .run import Run

LENGTHS_REACHED = 1e-6  # max |log ℓ/ℓ⁰| that a converged curve may have


def termination(run: Run) -> Outcome | None:
    """How the run ends where it stands; None if it goes on."""
    bound = gradient_bound(run.options, run.problem.mesh, run.point.energy)
    if run.point.gradient_norm <= bound and _feasible(run):
        norm = run.point.with_own_metric().gradient_norm
        if norm <= bound:
            outcome = converged(norm, bound)
            return (
                outcome.adding("nothing can move: the curve is pinned, or straight between pins")
                if run.frozen
                else outcome
            )
    return at_limit(run) if run.iterations_left <= 0 else None


def gradient_bound(options: RelaxOptions, mesh: Mesh, energy: float) -> float:
    """Norm of the projected gradient at which a curve of this energy has come to rest."""
    return options.tolerance * float(np.sqrt(energy_scale(mesh, energy)))


def at_limit(run: Run) -> Outcome:
    """How a run ends that may not go on."""
    outcome = out_of_iterations(run.iterations)
    if _feasible(run):
        return outcome
    return outcome.adding(
        "lengths are still up to {percent:.2g} % off target", percent=100 * run.iterate.edge_length_error
    )


def _feasible(run: Run) -> bool:
    return not run.problem.geometry.prescribes or run.iterate.edge_length_error <= LENGTHS_REACHED
