"""Parts of a link that are not linked would drift apart without limit: once far apart, each is held in place."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ...constraints import Parts
from ...curve import Curve
from ...descent import Step
from ...hierarchy import moebius_energy
from ...obstacle import Obstacle
from ...types import FloatArray, IntArray
from ..events import Change, Event
from ..outcome import Outcome
from ..run import Run

HELD = (
    "unlinked parts, which would drift apart without limit, are held in place; their own energies add up to "
    "{energy:.6g}"
)
INTERVAL = 5  # accepted steps between two looks
APART = 1.0  # gap between the balls around two parts, in radii of the larger one
MAX_PARTS = 50  # each has rows of its own in the linear systems


class SplitLinks:
    """Give every part that is far from the others a barycenter of its own among the constraints."""

    def __init__(self, run: Run) -> None:
        self._run = run

    def __call__(self, event: Event) -> Event | Change:
        """Look for parts now and then, and tell of them in the end."""
        run, constraints = self._run, self._run.problem.constraints
        if isinstance(event, Outcome) and event.converged and self._holds:
            alone = sum(moebius_energy(part)[0] for part in split(run.iterate.curve, constraints.parts))
            return event.adding(HELD, energy=alone)
        if isinstance(event, Step) and run.problem.geometry.prescribes and run.iterate.index % INTERVAL == 0:
            parts = separate_parts(run.iterate.curve, run.problem.obstacles)
            if max(parts) > max(constraints.parts or (0,)):
                constraints = constraints.of_parts(run.point.curve, parts)
                return Change(point=run.point.within(replace(run.problem, constraints=constraints)))
        return event

    @property
    def _holds(self) -> bool:
        """Whether barycenters of parts are held: none is where all have pins."""
        constraints = self._run.problem.constraints
        return constraints.parts is not None and any(True for _ in constraints.memberships(self._run.problem.mesh))


def separate_parts(curve: Curve, obstacles: Sequence[Obstacle] = ()) -> Parts:
    """For each component the number of its part, from 0; parts lie in balls that are far from each other.

    Disjoint balls prove that parts are not linked.  All is one part if there would be very many.  Obstacles are merged
    with what is near to them all: between walls nothing drifts away.
    """
    components = len(curve.mesh.component_sizes)
    if components == 1:
        return (0,)
    points = [curve.vertices, *(obstacle.corners.reshape(-1, curve.dimension) for obstacle in obstacles)]
    member = np.concatenate([curve.mesh.component, np.full(sum(map(len, points[1:])), components)])
    count = components + bool(obstacles)
    part = np.arange(count)
    while count > 1:
        fewer, merged = connected_components(_near(*_balls(np.concatenate(points), part[member])), directed=False)
        if fewer == count:
            break
        part, count = merged[part], fewer
    _, part = np.unique(part[:components], return_inverse=True)  # without one of obstacles alone
    return tuple(part.tolist()) if count <= MAX_PARTS else (0,) * components


def split(curve: Curve, parts: Parts | None) -> list[Curve]:
    """The parts as curves of their own."""
    if parts is None:
        return [curve]
    own = [np.flatnonzero(np.asarray(parts) == k) for k in range(max(parts) + 1)]
    return [
        Curve.from_components([curve.components[c] for c in each], [curve.mesh.closed[c] for c in each]) for each in own
    ]


def _balls(points: FloatArray, part: IntArray) -> tuple[FloatArray, FloatArray]:
    """Centres, shape (p, m), and radii, shape (p,), of balls around the points of p parts; shapes (k, m) and (k,)."""
    order = np.argsort(part, kind="stable")
    points, own = points[order], part[order]
    starts = np.searchsorted(own, np.arange(own[-1] + 1))
    centers = 0.5 * (np.minimum.reduceat(points, starts) + np.maximum.reduceat(points, starts))
    return centers, np.maximum.reduceat(np.linalg.norm(points - centers[own], axis=1), starts)


def _near(centers: FloatArray, radii: FloatArray) -> sp.coo_array:
    """Which balls are not far enough from each other to be parts; sparse, shape (p, p).

    A k-d tree per octave of radii finds the neighbours among balls that are no larger.
    """
    octave = np.frexp(radii)[1]
    found = []
    for level in np.unique(octave):
        large, small = np.flatnonzero(octave == level), np.flatnonzero(octave <= level)
        reach = (2.0 + APART) * float(radii[large].max())
        near = cKDTree(centers[large]).sparse_distance_matrix(cKDTree(centers[small]), reach, output_type="ndarray")
        i, j = large[near["i"]], small[near["j"]]
        kept = near["v"] < radii[i] + radii[j] + APART * np.maximum(radii[i], radii[j])
        found.append(np.stack([i[kept], j[kept]]))
    i, j = np.concatenate(found, axis=1)
    return sp.coo_array((np.ones(len(i), dtype=bool), (i, j)), shape=(len(radii), len(radii)))
