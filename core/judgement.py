"""The judgement of an iterate: converged, a saddle, composite, out of iterations, or still on its way."""

from dataclasses import replace

import numpy as np

from .constraints import Parts
from .curve import Curve
from .curve.distances import arc_distance_of_pairs
from .curve.refine import STRAND_RATIO
from .descent import Point
from .energies import MoebiusEnergy
from .energies.near_pairs import near_pairs
from .iterate import Iterate, Status
from .knots.composite import Ball, knotted_ball
from .options import RelaxOptions
from .parting import split
from .stability import stability
from .types import FloatArray

LENGTHS_REACHED = 1e-6  # max |log ℓ/ℓ⁰| that a converged curve may have
COMPOSITE_KNOT = 140.0  # less energy than any composite: two trefoils (74.4 each) less a circle make 144.8,
COMPOSITE_LINK = 90.0  # two Hopf links (47.5 each) 91


def judged(point: Point, iterate: Iterate, options: RelaxOptions) -> tuple[Iterate, tuple[FloatArray, float] | None]:
    """The iterate with its status, and from a saddle the way down: a direction and its negative curvature."""
    bound = options.tolerance * np.sqrt(abs(point.energy))
    feasible = not point.problem.geometry.prescribes or iterate.edge_length_error <= LENGTHS_REACHED
    way_down = None
    if iterate.gradient_norm <= bound and feasible:
        message = f"converged: projected gradient {iterate.gradient_norm:.3g} ≤ {bound:.3g}"
        parts = point.problem.constraints.parts
        if parts is not None:
            alone = sum(MoebiusEnergy().value(part) for part in split(iterate.curve, parts))
            message += (
                "; parts that are not linked, which would drift apart for ever, are held in their places; the sum of "
                f"their own energies is {alone:.6g}"
            )
        iterate = replace(iterate, status=Status.CONVERGED, message=message)
        if options.stability or options.escape_saddles:
            found = stability(point)
            kind = f"; a saddle with index {found.index}" if found.index else "; a minimum"
            iterate = replace(iterate, negative_eigenvalues=found.index, message=message + kind)
            if options.escape_saddles and found.index:
                iterate = replace(iterate, status=Status.RUNNING, message="")
                way_down = found.directions[0], float(found.eigenvalues[0])
    # an energy that does not see size gains by letting one part of a composite shrink for ever
    if iterate.status is Status.CONVERGED and point.problem.objective.energy.scale_exponent == 0.0:
        iterate = _unless_composite(iterate, point.problem.constraints.parts)
    if iterate.status is Status.RUNNING and iterate.index >= options.max_iterations:
        message = f"stopped after {iterate.index} iterations, as asked for"
        iterate = replace(iterate, status=Status.ITERATION_LIMIT, message=message)
    return iterate, way_down


def _unless_composite(iterate: Iterate, parts: Parts | None) -> Iterate:
    """The converged iterate; stalled if a part of it is composite, for then only the mesh keeps it from going on."""
    curves = [iterate.curve] if parts is None else split(iterate.curve, parts)
    ball = next((ball for curve in curves if (ball := _cutting_ball(curve)) is not None), None)
    if ball is None:
        return iterate
    place = ", ".join(f"{x:.3g}" for x in ball.center)
    message = (
        "stalled: strands pull tight, and would do so for ever: the curve is composite, knotted both inside and "
        f"outside the ball of radius {ball.radius:.3g} around ({place}), and has no shape of least energy"
    )
    return replace(iterate, status=Status.STALLED, message=message)


def _cutting_ball(curve: Curve) -> Ball | None:
    """A ball that proves a curve composite, looked for only where there is energy enough for that."""
    components = len(curve.mesh.component_sizes)
    if MoebiusEnergy().value(curve) < (COMPOSITE_KNOT if components == 1 else COMPOSITE_LINK):
        return None
    return knotted_ball(curve)


def unresolved(curve: Curve) -> bool:
    """Whether strands, not merely edges of very different lengths, are so near that the barrier still acts."""
    i, j = near_pairs(curve)
    distance = np.linalg.norm(curve.midpoints[i] - curve.midpoints[j], axis=1)
    return bool(np.any(arc_distance_of_pairs(curve, i, j) > STRAND_RATIO * distance))
