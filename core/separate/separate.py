"""Ropes where curves were: moved as little as their radii allow, every motion proved that of ropes.

Of all displacements u from the given curve, with R the radius of each component, the ropes minimise

    ½ Σ ∫ (a |u|²/R² + T |u'|² + b R² |u''|²) ds / R

among those that keep clear, by Newton steps with the Gauss–Newton part of the barrier in `contacts`.  At first they are
as thin as the curve has room for; the share λ of their radii then follows the room that steps make, and where the
barrier begins follows λ.  Kept lengths are held by an augmented Lagrangian.
"""

from collections.abc import Callable, Iterator, Sequence
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
from ..collision import check_clear, check_embedded, is_free, is_rope, rope_motion
from ..collision.gap import written
from ..curve import Curve, at_edges
from ..curve.measures import bending_radii
from ..curve.obstacle import Obstacle
from ..curve.pins import Pins
from ..descent.task import Task, check_units
from ..driver import Outcome, Relaxation, RelaxOptions, Result, Status, finish
from ..driver.relax import within
from ..io.trajectory import Iterate
from .contacts import Contacts, contacts
from .crossings import AXES, Crossing, lead_apart

ANCHOR, TENSION, BENDING = 1e-3, 0.02, 0.3  # a, T and b: bends are some four radii long
BEGINS, TOUCHING = 1.2, 1.03  # where the barrier begins, over what is needed: on the way, and at rest
FOLLOWS = 8.0
INEXTENSIBLE = 1000.0  # stiffness of kept lengths,
KEPT = 1e-3  # part by which they may differ at the end; ten times as much while ropes grow


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
        self.share, self.most = 0.0, 1.0  # of the radii that are kept, and that what is held allows
        self.pull = np.zeros(given.mesh.edges) if keep else None  # multipliers of kept lengths

    def near(self, curve: Curve, within: float) -> tuple[Contacts, Contacts]:
        """What is nearer than ``within`` times what it needs: what moves, and what is held."""
        found = contacts(curve, self.radius, self.given.edge_lengths, within, self.obstacles)
        still = (self.held[found.vertices] | (found.first == 0.0).all(axis=2)).all(axis=1)
        return tuple(Contacts(*(each[part] for each in found)) for part in (~still, still))

    def room(self, curve: Curve) -> float:
        """The share of the radii that there is room for, up to 1.25; what is held may allow no more than ``most``."""
        moving, still = self.near(curve, 1.25)
        self.most = min(1.0, (1.0 - 1e-6) * float(still.value.min(initial=2.0)))
        return float(moving.value.min(initial=1.25))

    def thicken(self, curve: Curve, share: float) -> None:
        """Keep a larger share of the radii from now on, if it is larger: no more than the curve is proved a rope of."""
        share = min(share, self.most)
        while share > max(self.share, 1e-12):
            if is_rope(curve.mesh, curve.vertices, curve.vertices, share * self.radius, self.obstacles):
                self.share = share
            share = max(0.7 * share, self.share)

    def stretches(self, curve: Curve) -> tuple[FloatArray, FloatArray]:
        """Changes of length over radius, and the tension that they and the multipliers make; shape (edges,)."""
        stretch = (curve.edge_lengths - self.given.edge_lengths) / self.radius[curve.mesh.edge_component]
        return stretch, self.pull + INEXTENSIBLE * stretch

    def length_error(self, curve: Curve) -> float:
        """The largest relative change of a length that is to be kept."""
        return 0.0 if self.pull is None else float(np.abs(curve.edge_lengths / self.given.edge_lengths - 1.0).max())

    def pull_back(self, curve: Curve) -> None:
        """Let the multipliers take over the tension of kept lengths."""
        if self.pull is not None:
            self.pull = self.stretches(curve)[1]

    def value(self, curve: Curve, near: Contacts, share: float, begins: float) -> float:
        """What is minimised; infinite where ropes meet."""
        total = self.energy(curve) + self.weight * float(near.barrier(share, begins)[0].sum())
        if self.pull is not None:
            stretch, tension = self.stretches(curve)
            total += 0.5 * float(stretch @ (tension + self.pull))
        return total

    def step(self, curve: Curve) -> tuple[Curve | None, float, float]:
        """The proved end of a Newton step that lowers what is minimised, None without one, its size, the decrement.

        The decrement is twice what the whole step would lower it by if it were quadratic.
        """
        n, mesh, share, begins = len(curve), curve.mesh, self.share, min(BEGINS * self.most, FOLLOWS * self.share)
        near, _ = self.near(curve, begins)
        _, slope, curvature = near.barrier(share, begins)
        g = self.stiffness @ (curve.vertices - self.given.vertices) + self.weight * near.sum_first(slope, n)
        H = self.full + self.weight * near.sum_squares(curvature, n)
        if self.pull is not None:
            _, tension = self.stretches(curve)
            scale, tau = self.radius[mesh.edge_component], curve.edge_vectors / curve.edge_lengths[:, None]
            spread = sp.kron(mesh.difference, sp.eye_array(3)).tocsr()
            along = sp.block_diag([*(tau / scale[:, None])[:, None]], format="csr") @ spread
            across = (np.maximum(tension, 0.0) / scale / curve.edge_lengths)[:, None, None]
            across = across * (np.eye(3) - tau[:, :, None] * tau[:, None])
            g = g + (along.T @ tension).reshape(n, 3)
            H = H + INEXTENSIBLE * along.T @ along + spread.T @ sp.block_diag([*across], format="csr") @ spread
        factor = splu(
            H[self.free][:, self.free].tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        flat = np.zeros(3 * n)
        flat[self.free] = -factor.solve(g.ravel()[self.free])
        move, decrement = flat.reshape(n, 3), -float(g.ravel() @ flat)
        before = self.value(curve, near, share, begins)
        # no further than the radius at a time: a barrier knows nothing of what lies behind what is near
        size = 0.9 / max(0.9, float((np.linalg.norm(move, axis=1) / self.radius[mesh.component]).max()))
        while size > 1e-7:
            check_time()
            end = curve.with_vertices(curve.vertices + size * move)
            if self.value(end, self.near(end, begins)[0], share, begins) <= before - 1e-4 * size * decrement:
                motion = rope_motion(mesh, curve.vertices, end.vertices, share * self.radius, self.obstacles)
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

    def iterate(self, index: int, curve: Curve, size: float = 0.0, decrement: float = 0.0) -> Iterate:
        """An iterate that is a rope of the share of the radii that is kept."""
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
            radius=tuple((self.share * self.radius).tolist()) if self.share else None,
        )

    def outcome(self, curve: Curve, crossings: tuple[Crossing, ...]) -> "Separated":
        """How it ended, with the place where it is tight if there is too little room."""
        moved = float(np.linalg.norm(curve.vertices - self.given.vertices, axis=1).max())
        told = [Message("no point moved by more than {moved:.3g}", moved=moved)]
        told += [each.sentence for each in crossings[:3]]
        if len(crossings) > 3:
            told.append(Message("{count} more crossings were led apart", count=len(crossings) - 3))
        facts: dict[str, Any] = {"share": self.share, "crossings": crossings, "moved": moved}
        if self.length_error(curve) > KEPT:
            change = np.abs(curve.edge_lengths / self.given.edge_lengths - 1.0)
            k = int(change.argmax())
            one, place = Message(COMPONENT, number=int(curve.mesh.edge_component[k]) + 1), at_edges(curve, (k,))
            kept = "lengths cannot be kept: that of {one} changes by up to {change:.2g} %, near {place}"
            reason = Message(kept, one=one, change=100.0 * change[k], place=written(np.array(place.position)))
            return Separated(Status.STALLED, (Message("stalled: {reason}", reason=reason), *told), place=place, **facts)
        if self.share == 1.0:
            return Separated(Status.CONVERGED, (Message("separated: all ropes keep clear"), *told), **facts)
        near = max(self.near(curve, 1.25), key=lambda each: -each.value.min(initial=2.0))
        i, j = near.edges[near.value.argmin()].tolist()
        place = at_edges(curve, (i,) if j < 0 else (i, j))
        one, other = (Message(COMPONENT, number=int(curve.mesh.edge_component[max(each, 0)]) + 1) for each in (i, j))
        where = Message("between {one} and {other}", one=one, other=other)
        if j < 0:
            where = Message("between {one} and an obstacle", one=one)
        elif curve.mesh.next[i] == j or curve.mesh.next[j] == i:
            where = Message("at a corner of {one}", one=one)
        elif one == other:
            where = Message("between parts of {one}", one=one)
        tight = "there is room for {share:.1f} % of the radius only; it is tight {where}, near {place}"
        reason = Message(tight, share=100.0 * self.share, where=where, place=written(np.array(place.position)))
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
    free_ends: bool = False,
    callback: Callable[[Iterate], None] | None = None,
) -> Result:
    """Make ropes of curves that are nearer than their radii, touch, or run through each other; see the module.

    ``radius`` is one number, or one for each component.  Pins stay in place, ends too unless they are free.  Where
    centre lines meet, the later one goes over, as seen from the axis ``over`` (x, y, z, -x, -y or -z; by default that
    in which they extend least where they meet); from the first curve without such places on every motion is proved to
    be that of ropes.  ``lengths``: free, or keep, those of all edges.

    The result's outcome is a `Separated`.  If there is less room it is stalled, with the place where it is tight, and
    the curve is the best that was reached.  Raises CurveError if the curve cannot be led apart where it meets itself,
    or touches an obstacle; OptionError for wrong values.
    """
    options = SeparateOptions(radius=radius, over=over, lengths=lengths, free_ends=free_ends)
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
    if not (curve.edge_lengths.min() > 0.0 and bending_radii(curve).min() > 1e-9 * radius.min()):
        check_embedded(curve)  # which says where it doubles back
    check_clear(curve, task.obstacles)
    held = np.zeros(mesh.size, dtype=bool)
    ends = () if options.free_ends else mesh.ends.ravel()
    pins, keep = np.array([*task.pins, *ends], dtype=np.intp), options.lengths == "keep"
    held[Pins.of(curve, np.unique(pins)).vertices if keep else pins] = True  # no kept length gives taut arcs way
    ropes = Ropes(curve, np.broadcast_to(radius, parts).copy(), held, task.obstacles, keep)
    apart, crossings = lead_apart(curve, ropes.radius, ropes.stiffness, held, options.over, task.obstacles)
    led = curve.with_vertices(apart)
    check_embedded(led)
    check_clear(led, task.obstacles)
    if led is not curve and not crossings and is_free(mesh, curve.vertices, apart, task.obstacles):
        yield ropes.iterate(0, curve)
        return (yield from _separated(ropes, led, 1, ()))
    return (yield from _separated(ropes, led, 0, tuple(crossings)))


def _separated(ropes: Ropes, now: Curve, index: int, crossings: tuple[Crossing, ...]) -> Relaxation:
    """The iterates from an embedded curve to ropes at rest."""

    def steps(most: int, least: float) -> Iterator[Iterate]:
        """So many steps, up to a decrement of a part of the quadratic form."""
        nonlocal now, index
        for _ in range(most):
            end, size, decrement = ropes.step(now)
            if end is None or decrement <= least * ropes.energy(now):
                break
            now, index = end, index + 1
            yield ropes.iterate(index, now, size, decrement)
        ropes.pull_back(now)

    shares = list[float]()
    while len(shares) < 12 or ropes.share > 1.01 * shares[-12]:
        room, kept = ropes.room(now), ropes.length_error(now) <= 10.0 * KEPT
        if room > ropes.most and ropes.share > 0.85 * ropes.most and kept:
            break
        if kept:  # steps double little gaps, so that they have more to do the less room there is
            ropes.thicken(now, room * (0.5 + 0.4 * min(room, 1.0)))
        if not shares:
            yield ropes.iterate(index, now)
            if not ropes.share:
                return ropes.outcome(now, crossings)
        elif ropes.share < 1.03 * shares[-1] and kept:
            ropes.weight *= 1.5
        shares.append(ropes.share)
        yield from steps(3, 0.0)
    for ropes.weight in (0.1, 0.01, *[0.001] * 10):  # towards the least displacement, ropes touching
        if ropes.length_error(now) <= 10.0 * KEPT:
            ropes.thicken(now, 0.995 * ropes.room(now))
        yield from steps(20, 1e-3)
        if ropes.weight == 0.001 and ropes.length_error(now) <= KEPT:
            break
    share = ropes.share
    if ropes.length_error(now) <= KEPT:
        ropes.thicken(now, 0.995 * ropes.room(now))
    if ropes.share > share:
        yield ropes.iterate(index + 1, now)
    return ropes.outcome(now, crossings)
