"""Changes of mesh that follow the strands, with the proof that nothing touches meanwhile: along the way, or at rest."""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from ...base import BULK, FloatArray, IntArray, Message, MobiusFlowError, joined
from ...collision import Contact, survives_rounding
from ...curve import SPLIT, Curve, affordable_pieces, bending_radii, graded_spacing, halved, subdivide
from ...curve.refine import collapsed, normalised, onto_chords, superfluous
from ...descent import Leg, NoStep, Point, Problem, Step, check_refined
from ...energies import is_moebius_invariant
from ...energies.components import energy_scale
from ..move import Change, Move
from ..outcome import Outcome
from .links import is_unresolved, shrinking_ball


@dataclass(eq=False)
class Remesh(Move):
    """The adaptive mesh: shorter edges where strands are near, and around edges that are stuck."""

    interval: int = 5  # accepted steps between two looks at the mesh
    _just_refined: bool = field(default=False, init=False)  # around edges that were stuck: once is enough

    def stepped(self, step: Step) -> Change | None:
        self._just_refined = False
        return None if self.run.iterate.index % self.interval else self._change(None)

    def stuck(self, found: NoStep) -> NoStep | Change | None:
        if self.run.options.mesh != "adaptive":
            return replace(found, reason=joined((found.reason, Message("a finer or an adaptive mesh may help")), "; "))
        if found.limited_by is None or self._just_refined:
            return None
        change = self._change(found.limited_by)
        self._just_refined = change is not None
        return change

    def _change(self, stuck: Contact | None) -> Change | None:
        """Another mesh; None if this one is good or must stay. Around edges that are stuck it is finer in any case."""
        if self.run.options.mesh != "adaptive":
            return None
        problem, curve, resolution = self.run.problem, self.run.iterate.curve, self.run.resolution
        pins = problem.constraints.pins.vertices
        spacing = graded_spacing(curve, resolution)
        if stuck is not None:
            edges = np.arange(curve.mesh.edges)
            for edge in stuck.edges:
                near = curve.mesh.index_distance(np.full_like(edges, edge), edges) <= 2
                spacing[near] = np.minimum(spacing[near], 0.5 * curve.edge_lengths[near])
        removable = superfluous(curve, spacing, pins)
        # where it is not stuck, the mesh is good unless edges are too long, or a tenth of the vertices superfluous
        if stuck is None and len(removable) <= 0.1 * len(curve) and not (curve.edge_lengths > SPLIT * spacing).any():
            return None
        found = proved_remesh(problem, curve, removable, spacing)
        if found is None:
            return None
        step, other = found
        held = problem.constraints.pins.on(other)
        lengths = normalised(other, graded_spacing(other, resolution), held.vertices) / problem.units.scale
        constraints = replace(problem.constraints, lengths=lengths, pins=held)
        problem = replace(problem, mesh=other.mesh, constraints=constraints)
        return Change((step,), problem.at_curve(other))


def proved_remesh(
    problem: Problem, curve: Curve, removable: IntArray, spacing: FloatArray
) -> tuple[Step, Curve] | None:
    """The last motion on the old mesh, and the curve on the new one, with all collapses that are free.

    None if vertices would coincide.
    """
    while True:
        moved = onto_chords(curve, removable)
        free = problem.free_motion(curve.vertices, moved.vertices)
        if free.time == 1.0 or not len(removable):
            break
        assert free.contact is not None
        ends = [end[list(free.contact.edges)] for end in (curve.mesh.tails, curve.mesh.heads)]
        guilty = np.isin(removable, ends)
        removable = removable[~guilty] if guilty.any() else removable[:0]
    other = collapsed(moved, removable, spacing)
    if not all(survives_rounding(each, problem.obstacles) for each in (moved, other)):
        return None
    return Step((Leg(problem.at_curve(moved), free),), 0.0, None), other


@dataclass(eq=False)
class FinerMesh(Move):
    """Split edges where strands are nearer than the mesh resolves, or report that this would help.

    Edges are split as soon as the energy still to be gained on a mesh is small against the mesh's error, and at rest in
    any case; at rest they are also split where the curve bends most, if its energy is too far from that of the spline
    through it.  The error is taken to be the change of the same curve's energy on the finer mesh, corners included.
    The gain to come is taken to be that of the last fifth of the steps on this mesh, so that saddles are not mistaken
    for minima unless they are crossed more slowly than all before, and at least as much as the gradient and the bulk of
    the Hessian's eigenvalues against J_C promise.
    """

    # the barrier acts below 3: strands may draw nearer by half; energies are within some 0.1 % then
    edges_per_gap: float = 6.0
    most: int = 10_000  # vertices, unless there are more: what the hierarchical solver has time for
    # that must be left: it takes two or three to regain what corners cost when their edges are split
    min_iterations: int = 5
    share: float = 0.1  # of the error, up to which a gain counts as small
    # relative error of an energy at rest above which vertices are added: estimates of it are a few per cent off
    accuracy: float = 9.5e-4
    aim: float = 0.9  # part of that error that added vertices are to leave
    affordable: int = 1000  # vertices for that: as many as second derivatives are factorised for
    pieces: int = 16  # of an edge: where pins nearly touch, no number of vertices resolves the gap between them
    recent: float = 0.8  # part of the steps on this mesh after which gains count
    pause: float = 1.1  # factor of the number of steps on this mesh from one check to the next

    def __post_init__(self) -> None:
        self._resolution = replace(self.run.resolution, edges_per_gap=self.edges_per_gap)
        self._given = len(self.run.point.vertices)
        self.started()

    def started(self) -> None:
        self._energies, self._looked, self._measured = [self.run.point.energy], 0, False

    def stepped(self, step: Step) -> Change | None:
        self._energies.append(self.run.point.energy)
        steps, energy = len(self._energies) - 1, self._energies[-1]
        if steps < self.pause * self._looked or len(self.run.point.vertices) < self._given or not self.run.feasible:
            return None
        # iterations must be left to relax as long on another mesh
        grown, left = math.isclose(self.run.iterate.grown, self.run.options.grow), self.run.iterations_left
        if not grown or left < max(len(self._energies), self.min_iterations):
            return None
        gain = max(self._energies[int(self.recent * steps)] - energy, 0.5 * self.run.point.gradient_norm**2 / BULK)
        if gain > self.share**2 * energy:  # errors are hardly a tenth of it
            return None
        self._looked, finer = steps, self._finer()
        if finer is None or gain > self.share * abs(finer.energy - energy) or shrinking_ball(self.run) is not None:
            return None  # a ball would go on shrinking, until that mesh does not resolve it either
        return Change(point=finer, resolution=self._resolution)

    def converged(self, outcome: Outcome) -> Outcome | Change | None:
        if self.run.frozen:
            return None
        finer = (self._finer() or self._more_exact()) if self.run.iterations_left >= self.min_iterations else None
        if finer is None:
            coarse = "strands are closer than this mesh resolves: a finer one would reach a lower energy"
            return outcome.adding(coarse) if is_unresolved(self.run.iterate.curve) else None
        return Change(point=finer, resolution=self._resolution)

    def _finer(self) -> Point | None:
        """The same curve on a finer mesh; None if that is not wanted, or there is none."""
        curve = self.run.iterate.curve
        if not (self.run.options.ends_finer and is_unresolved(curve)):
            return None
        spacing = graded_spacing(curve, self._resolution)
        if len(self.run.problem.constraints.pins) and (curve.edge_lengths / spacing).max() > self.pieces:
            return None
        pieces = affordable_pieces(curve, spacing, self.most)
        return split_edges(self.run.problem, curve, pieces) if pieces.max() > 1 else None

    def _more_exact(self) -> Point | None:
        """The same curve with edges halved where it bends most, as many as its energy's error asks for; None if none.

        Halving all of them would remove three quarters of the error.
        """
        problem, point, curve = self.run.problem, self.run.point, self.run.iterate.curve
        usual = self.run.options.ends_finer and problem.unconfined and is_moebius_invariant(problem.objective.energy)
        if not usual or self._measured or problem.objective.pull is not None:
            return None
        self._measured = True
        error = (point.energy - problem.objective.value(halved(point.curve))) / 0.75
        bound = self.accuracy * energy_scale(problem.mesh, point.energy)
        if not bound < error < np.inf:
            return None
        tau = curve.edge_vectors / curve.edge_lengths[:, None]
        bends = np.linalg.norm(tau[curve.mesh.next] - tau[curve.mesh.previous], axis=1)
        bends = np.round(bends / bends.max(), 2)  # what is alike by symmetry is treated alike
        share = min(1.0, (1.0 - self.aim * bound / error) / 0.75)
        pieces = np.where(bends >= np.quantile(bends, 1.0 - share), 2, 1)
        return split_edges(problem, curve, pieces) if pieces.sum() <= min(self.most, self.affordable) else None


def split_edges(problem: Problem, curve: Curve, pieces: IntArray) -> Point | None:
    """The same curve and problem with edges split into pieces; None if doubles are too coarse or vertices too many.

    Pieces next to the corners of a rope stay so long that its bending radii do.
    """
    mesh, ell = curve.mesh, curve.edge_lengths
    if problem.radius is not None and pieces.max() > 1:
        tangents = np.minimum(ell[mesh.incoming], ell[mesh.outgoing]) / bending_radii(curve)  # 2 tan(θ/2)
        shortest = problem.radius[mesh.edge_component] * np.maximum(tangents[mesh.tails], tangents[mesh.heads])
        allowed = (ell / np.maximum(shortest, 1e-9 * ell)).astype(np.intp)
        if (pieces := np.clip(pieces, 1, np.maximum(allowed, 1))).max() == 1:
            return None
    pieces = problem.constraints.symmetry.most(pieces, mesh)
    finer = subdivide(curve, pieces) if pieces.max() > 1 else curve
    try:
        check_refined(curve, finer, problem.obstacles)
        return problem.on(finer, np.repeat(problem.constraints.lengths / pieces, pieces) * problem.units.scale)
    except MobiusFlowError:
        return None
