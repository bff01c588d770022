"""The adaptive mesh during a relaxation: when to change it, and the proof that nothing touches meanwhile."""

from dataclasses import dataclass, replace

import numpy as np

from .collision import FreeMotion, survives_rounding
from .curve import Curve
from .curve.remesh import Remeshed, graded_spacing, needs_remesh, remesh, superfluous
from .descent import Problem
from .types import FloatArray

INTERVAL = 5  # accepted steps between two looks at the mesh


@dataclass(frozen=True, eq=False)
class Adapted:
    """A curve on its new mesh.

    Attributes
    ----------
    moved
        The curve on the old mesh after the vertices to be removed have moved onto the chords of their neighbours.
    proof
        What is proved of that motion.
    curve
        The new polygon, in the user's units.
    problem
        The same problem on it.
    """

    moved: Curve
    proof: FreeMotion
    curve: Curve
    problem: Problem


def graded_problem(problem: Problem, curve: Curve, vertices: int | None) -> Problem:
    """The problem with target lengths that follow the gaps between strands, the total lengths kept."""
    spacing = graded_spacing(curve, vertices)
    for part in curve.mesh.slices:
        spacing[part] *= curve.edge_lengths[part].sum() / spacing[part].sum()
    return _on(problem, curve, spacing)


def adapt(problem: Problem, curve: Curve, vertices: int | None, stuck: tuple[int, int] | None) -> Adapted | None:
    """Change the mesh where neighbours are no longer nearer than strands; None if it is good or must stay.

    Parameters
    ----------
    curve
        In the user's units.
    vertices
        Number of vertices where no strands are near; None is the default.
    stuck
        Two edges that keep each other from moving: the mesh around them is refined whether it needs it or not.
    """
    spacing = graded_spacing(curve, vertices)
    if stuck is not None:
        for edge in stuck:
            near = curve.mesh.index_distance(np.full(len(curve), edge), np.arange(len(curve))) <= 2
            spacing[near] = np.minimum(spacing[near], 0.5 * curve.edge_lengths[near])
    elif not needs_remesh(curve, spacing):
        return None
    change, proof = _proved(problem, curve, vertices, spacing)
    if not (survives_rounding(change.moved) and survives_rounding(change.curve)):
        return None
    return Adapted(change.moved, proof, change.curve, _on(problem, change.curve, change.lengths))


def _proved(problem: Problem, curve: Curve, vertices: int | None, spacing: FloatArray) -> tuple[Remeshed, FreeMotion]:
    """The change of mesh with as many collapses as are free of contact, and the proof."""
    removable = superfluous(curve, spacing)
    while True:
        change = remesh(curve, vertices, removable, spacing)
        free = problem.free_motion(curve.vertices, change.moved.vertices)
        if free.time == 1.0 or not len(removable):
            return change, free
        assert free.pair is not None
        ends = [curve.mesh.tails[e] for e in free.pair] + [curve.mesh.heads[e] for e in free.pair]
        guilty = np.isin(removable, ends)
        removable = removable[~guilty] if guilty.any() else removable[:0]


def _on(problem: Problem, curve: Curve, lengths: FloatArray) -> Problem:
    constraints = replace(problem.constraints, lengths=lengths / problem.units.scale)
    return replace(problem, mesh=curve.mesh, constraints=constraints)
