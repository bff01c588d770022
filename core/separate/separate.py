"""Ropes where curves were: moved as little as their radii allow, every motion proved that of ropes.

Of all displacements u from the given curve, with R the radius of each component, the ropes minimise

    ½ Σ ∫ (a |u|²/R² + T |u'|² + b R² |u''|²) ds / R

among those that keep clear, by Newton steps with the Gauss–Newton part of the barrier in `contacts`.  At first they are
as thin as the curve has room for; the share λ of their radii then follows the room that steps make, and where the
barrier begins follows λ.  Kept lengths are held by an augmented Lagrangian.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from ..base.arguments import check_known, checked
from ..base.deadline import TimeLimit, check_time
from ..base.errors import CurveError, OptionError
from ..base.messages import COMPONENT, Message
from ..base.threads import BLAS
from ..base.types import BoolArray, FloatArray
from ..collision import check_clear, check_embedded, is_free, rope_motion
from ..collision.gap import written
from ..curve import Curve, at_edges
from ..curve.obstacle import Obstacle
from ..descent.task import Task, check_units
from ..driver import Outcome, Relaxation, RelaxOptions, Result, Status, finish
from ..driver.relax import within
from ..io.trajectory import Iterate
from .contacts import Contacts, contacts
from .crossings import AXES, Crossing, lead_apart

ANCHOR, TENSION, BENDING = 1e-3, 0.02, 0.3  # a, T and b: bends are some four radii long
BEGINS, TOUCHING = 1.2, 1.03  # where the barrier begins, over what is needed: on the way, and at rest
FOLLOWS = 8.0
INEXTENSIBLE = 100.0  # stiffness of kept lengths


@dataclass(frozen=True, kw_only=True)
class SeparateOptions:
    """How curves become ropes: their ``radius``, one or one for each component, who goes ``over``, and ``lengths``."""

    radius: float | tuple[float, ...]
    over: str | None = None
    lengths: str = "free"
    free_ends: bool = False
    time_limit: float | None = None

    def __post_init__(self) -> None:
        radii = np.ravel(self.radius)
        if radii.dtype.kind not in "iuf" or not (len(radii) and np.isfinite(radii).all() and (radii > 0.0).all()):
            raise OptionError(f"radius is {self.radius!r:.60}; it must be a number above 0, or one for each component")
        object.__setattr__(self, "radius", tuple(map(float, radii)))
        if self.over is not None:
            check_known("over", self.over, tuple(AXES))
        check_known("lengths", self.lengths, ("free", "keep"))


def stiffness(curve: Curve, radius: FloatArray) -> sp.csr_array:
    """K with ½ uᵀKu the quadratic form, for each coordinate of a displacement; shape (n, n)."""
    mesh, ell = curve.mesh, curve.edge_lengths
    R, own = radius[mesh.edge_component], radius[mesh.component]
    slope = (sp.diags_array(1.0 / ell) @ mesh.difference).tocsr()
    before, after = mesh.incoming[mesh.inner], mesh.outgoing[mesh.inner]
    turn = slope[after] - slope[before]
    anchor = sp.diags_array(ANCHOR * mesh.scatter(0.5 * ell, 0.5 * ell) / own**3)
    tension = slope.T @ sp.diags_array(TENSION * ell / R) @ slope
    bending = turn.T @ sp.diags_array(2.0 * BENDING * own[mesh.inner] / (ell[before] + ell[after])) @ turn
    return (anchor + tension + bending).tocsr()


class Ropes:
    """What is minimised, with a share of the radii that is kept, and its Newton steps."""

    def __init__(
        self, given: Curve, radius: FloatArray, held: BoolArray, obstacles: Sequence[Obstacle], keep: bool
    ) -> None:
        self.given, self.radius, self.held, self.obstacles = given, radius, held, obstacles
        self.stiffness = stiffness(given, radius)
        self.full = sp.kron(self.stiffness, sp.eye_array(3)).tocsc()
        self.free = np.flatnonzero(np.repeat(~held, 3))
        self.weight = 1.0  # of the barrier
        self.pull = np.zeros(given.mesh.edges) if keep else None  # multipliers of kept lengths

    def contacts(self, curve: Curve, within: float) -> Contacts:
        return contacts(curve, self.radius, self.given.edge_lengths, within, self.obstacles)

    def moves(self, found: Contacts) -> BoolArray:
        """Which contacts are not between what is held alone."""
        return ~(self.held[found.vertices] | (found.first == 0.0).all(axis=2)).all(axis=1)

    def near(self, curve: Curve, within: float) -> Contacts:
        """What is nearer than ``within`` times what it needs, and moves."""
        found = self.contacts(curve, within)
        moves = self.moves(found)
        return Contacts(*(each[moves] for each in found))

    def room(self, curve: Curve) -> float:
        """The share of the radii that there is room for, up to 1.25."""
        return float(self.near(curve, 1.25).value.min(initial=1.25))

    def stretches(self, curve: Curve) -> tuple[FloatArray, FloatArray]:
        """Changes of length over radius, and the tension that they and the multipliers make; shape (edges,)."""
        stretch = (curve.edge_lengths - self.given.edge_lengths) / self.radius[curve.mesh.edge_component]
        return stretch, self.pull + INEXTENSIBLE * stretch

    def pull_back(self, curve: Curve) -> None:
        """Let the multipliers take over the tension of kept lengths."""
        if self.pull is not None:
            self.pull = self.stretches(curve)[1]

    def value(self, curve: Curve, share: float, begins: float) -> float:
        """What is minimised; infinite where ropes meet."""
        total = self.energy(curve) + self.weight * float(self.near(curve, begins).barrier(share, begins)[0].sum())
        if self.pull is not None:
            stretch, tension = self.stretches(curve)
            total += 0.5 * float(stretch @ (tension + self.pull))
        return total

    def direction(self, curve: Curve, share: float, begins: float) -> tuple[FloatArray, float]:
        """A Newton step, shape (n, 3), and the decrease that it promises, twice."""
        n, near = len(curve), self.near(curve, begins)
        _, slope, curvature = near.barrier(share, begins)
        g = self.stiffness @ (curve.vertices - self.given.vertices) + self.weight * near.sum_first(slope, n)
        H = self.full + self.weight * near.sum_squares(curvature, n)
        if self.pull is not None:
            mesh, (_, tension) = curve.mesh, self.stretches(curve)
            scale = self.radius[mesh.edge_component][:, None]
            tau = curve.edge_vectors / curve.edge_lengths[:, None]
            spread = sp.kron(mesh.difference, sp.eye_array(3)).tocsr()
            along = sp.block_diag([*(tau / scale)[:, None]], format="csr") @ spread  # by the coordinates
            g += (along.T @ tension).reshape(n, 3)
            H = H + INEXTENSIBLE * along.T @ along
            across = np.eye(3) - tau[:, :, None] * tau[:, None]
            taut = np.maximum(tension, 0.0) / curve.edge_lengths / scale[:, 0]
            H = H + spread.T @ sp.block_diag([*(taut[:, None, None] * across)], format="csr") @ spread
        factor = splu(
            H[self.free][:, self.free].tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        step = np.zeros(3 * n)
        step[self.free] = -factor.solve(g.ravel()[self.free])
        return step.reshape(n, 3), -float(g.ravel() @ step)

    def step(self, curve: Curve, share: float, begins: float) -> tuple[Curve | None, float, float]:
        """The proved end of a step that lowers what is minimised, None if there is none, its size, and the decrement."""
        move, decrement = self.direction(curve, share, begins)
        before = self.value(curve, share, begins)
        size = min(1.0, 0.9 / max(float((np.linalg.norm(move, axis=1) / self.radius[curve.mesh.component]).max()), 1e-9))
        while size > 1e-7:
            check_time()
            end = curve.with_vertices(curve.vertices + size * move)
            if self.value(end, share, begins) <= before - 1e-4 * size * decrement:
                motion = rope_motion(curve.mesh, curve.vertices, end.vertices, share * self.radius, self.obstacles)
                if motion.proved:
                    return end, size, decrement
                size *= max(0.75 * motion.time, 0.25)
            else:
                size *= 0.5
        return None, 0.0, decrement


    def energy(self, curve: Curve) -> float:
        """The quadratic form of the displacement."""
        u = curve.vertices - self.given.vertices
        return 0.5 * float((self.stiffness @ u * u).sum())

    def iterate(
        self, index: int, curve: Curve, share: float, size: float = 0.0, decrement: float = 0.0
    ) -> Iterate:
        """An iterate that is a rope of a share of the radii, or none if that is 0."""
        return Iterate(
            index=index,
            curve=curve,
            energy=self.energy(curve),
            gradient_norm=float(np.sqrt(max(decrement, 0.0))),
            step_size=size,
            path=(curve.vertices,) if index else (),
            certified=True,
            edge_length_error=float(np.abs(np.log(curve.edge_lengths / self.given.edge_lengths)).max()),
            method="separate",
            pins=tuple(np.flatnonzero(self.held).tolist()),
            radius=tuple((share * self.radius).tolist()) if share else None,
        )

    def outcome(self, curve: Curve, share: float, crossings: tuple[Crossing, ...]) -> "Separated":
        """How it ended, with the place where it is tight if there is too little room."""
        moved = float(np.linalg.norm(curve.vertices - self.given.vertices, axis=1).max())
        told = [Message("no point moved by more than {moved:.3g}", moved=moved)]
        told += [each.sentence for each in crossings[:3]]
        if len(crossings) > 3:
            told.append(Message("{count} more crossings were led apart", count=len(crossings) - 3))
        facts: dict[str, Any] = {"share": share, "crossings": crossings, "moved": moved}
        if share > 1.0 - 1e-5:
            return Separated(Status.CONVERGED, (Message("separated: all ropes keep clear"), *told), **facts)
        found = self.contacts(curve, 1.25)
        k = int(found.value.argmin())
        i, j = found.edges[k].tolist()
        place = at_edges(curve, (i,) if j < 0 else (i, j))
        one, other = (
            Message(COMPONENT, number=int(curve.mesh.edge_component[max(each, 0)]) + 1) for each in (i, j)
        )
        where = Message("between {one} and {other}", one=one, other=other)
        if j < 0:
            where = Message("between {one} and an obstacle", one=one)
        elif curve.mesh.next[i] == j or curve.mesh.next[j] == i:
            where = Message("at a corner of {one}", one=one)
        tight = "there is room for {share:.1f} % of the radius only; it is tight {where}, near {place}"
        reason = Message(tight, share=100.0 * share, where=where, place=written(np.array(place.position)))
        return Separated(Status.STALLED, (Message("stalled: {reason}", reason=reason), *told), place=place, **facts)


@dataclass(frozen=True)
class Separated(Outcome):
    """How a separation ended.

    - ``share``: of the radii that was reached: 1 where there was room.
    - ``crossings``: centre lines that met at the start, and who went over whom.
    - ``moved``: how far any vertex has moved from the given curve.
    """

    share: float = 0.0
    crossings: tuple[Crossing, ...] = ()
    moved: float = 0.0


@checked
def separate(
    curve: Curve | Task,
    radius: Any,
    *,
    over: str | None = None,
    lengths: str = "free",
    callback: Callable[[Iterate], None] | None = None,
) -> Result:
    """Make ropes of curves that are nearer than their radii, touch, or run through each other; see the module.

    ``radius`` is one number, or one for each component.  Ends and pins stay in place, and obstacles clear.  Where
    centre lines meet, the later one goes over, as seen from the axis ``over`` (x, y, z, -x, -y or -z; by default that
    in which they extend least where they meet); from the first curve without such places on every motion is proved to
    be that of ropes.  ``lengths``: free, or keep, those of all edges.

    The result's outcome is a `Separated`.  If there is less room it is stalled, with the place where it is tight, and
    the curve is the best that was reached.  Raises CurveError if the curve cannot be led apart where it meets itself,
    or touches an obstacle; OptionError for wrong values.
    """
    options = SeparateOptions(radius=radius, over=over, lengths=lengths)
    task = Task.of(curve)
    return finish(separating(task, options), task, RelaxOptions(), callback)


def separating(task: Task, options: SeparateOptions) -> Relaxation:
    """Yield the iterates of a separation; return how it ended, a `Separated`.  Raises as `separate` does."""
    work = BLAS.bounding(_iterates(task, options))
    return work if options.time_limit is None else within(TimeLimit(options.time_limit), work)


def _iterates(task: Task, options: SeparateOptions) -> Relaxation:
    """The given curve, if it is embedded, the first one whose centre lines do not meet, and the ropes from there on."""
    curve, mesh = task.curve, task.curve.mesh
    check_units(curve)
    if curve.dimension != 3:
        raise CurveError(f"the curve has dimension {curve.dimension}; ropes are separated in space")
    radius, parts = np.array(options.radius), len(mesh.component_sizes)
    if len(radius) not in (1, parts):
        raise OptionError(f"radius has {len(radius)} numbers for {parts} components; give one, or one for each")
    if not curve.edge_lengths.min() > 0.0:
        check_embedded(curve)  # which says where
    check_clear(curve, task.obstacles)
    held = np.zeros(mesh.size, dtype=bool)
    held[[*task.pins, *mesh.ends.ravel().tolist()]] = True
    ropes = Ropes(curve, np.broadcast_to(radius, parts).copy(), held, task.obstacles, options.lengths == "keep")
    apart, crossings = lead_apart(curve, ropes.radius, ropes.stiffness, held, options.over, task.obstacles)
    led = curve.with_vertices(apart)
    check_embedded(led)
    check_clear(led, task.obstacles)
    if led is not curve and not crossings and is_free(mesh, curve.vertices, apart, task.obstacles):
        yield ropes.iterate(0, curve, 0.0)
        return (yield from _separated(ropes, led, 1, ()))
    return (yield from _separated(ropes, led, 0, tuple(crossings)))


def _separated(ropes: Ropes, now: Curve, index: int, crossings: tuple[Crossing, ...]) -> Relaxation:
    """The iterates from an embedded curve to ropes at rest."""
    found = ropes.contacts(now, 1.0)
    # no rope is thicker than what is held leaves room for
    most = min(1.0, (1.0 - 1e-6) * float(found.value[~ropes.moves(found)].min(initial=2.0)))
    room = ropes.room(now)

    def thinner(room: float) -> float:
        """The share that leaves Newton steps, which double little gaps, the more to do the less room there is."""
        return room * (0.5 + 0.4 * min(room, 1.0))

    share, shares = min(most, thinner(room)), [0.0]
    yield ropes.iterate(index, now, share)
    settling = list[float]()  # weights of the barrier once there is room
    for _ in range(400):
        shares.append(share)
        begins = min(BEGINS * most, FOLLOWS * share)
        ropes.weight = settling[0] if settling else ropes.weight
        for _ in range(20 if settling else 3):
            end, size, decrement = ropes.step(now, share, begins)
            if end is not None:
                now, index = end, index + 1
                yield ropes.iterate(index, now, share, size, decrement)
            if end is None or decrement < 1e-3 * (ropes.energy(now) if settling else 0.0):
                break
        ropes.pull_back(now)
        room = ropes.room(now)
        if settling:
            settling.pop(0)
            if not settling:
                break
            continue
        vain = len(shares) > 12 and share < 1.01 * shares[-12]
        if room > most and share > 0.85 * most or vain:
            share = min(most, 0.995 * room if vain else most)
            settling = [0.1, 0.01, 0.001]
        else:
            if share < 1.03 * shares[-2]:
                ropes.weight *= 1.5
            share = max(share, min(most, thinner(room)))
    return ropes.outcome(now, share, crossings)
