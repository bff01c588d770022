"""The shortest rope of radius 1: a primal–dual interior-point method, whose multipliers are the forces at contacts.

    minimise  f = Σ √(Σ p Σ ℓ²/p)  over components,  subject to  c ≥ 0  (`contacts`)

f is the length where edges have the proportions p, and makes them so.  Steps are Newton's for  ∇f = Σ z ∇c  and
z = −B'(c):

    (D²f − Σ z D²c + Σ k ∇c ∇cᵀ + δ D²f) dx = −∇f − Σ B' ∇c,    dz = −B' − z − k ⟨∇c, dx⟩,

with the barrier  B(c) = −μ (log(c/h) − 2 (c/h − 1) + ((c/h)² − 1)/2)  up to the margin h and 0 from there on, smoothly,
as a logarithm would depend on what is listed, and  k = z/c + B'' + B'/c.  Of the walls' curvature Σ z D²c so much is
counted as leaves the matrix definite, but for a small shift: all of it near the end, little where contacts of polygons
are notched, where steps along negative eigenvectors would lead from notch to notch.  δ shortens steps that are far too
long.  Of a step so much is taken that f + Σ B falls enough, no c loses most of itself, no vertex moves more than half a
radius, and the motion is proved.  μ and h fall once the rope is well centred, that is, when steps promise very little
(Nocedal and Wright, *Numerical Optimization*, ch. 19).

The unknowns are the vertices, or the controls of cubic B-splines on which these lie: smooth ropes, which need fewer.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import SuperLU

from ..base.deadline import check_time
from ..base.types import FloatArray
from ..curve import Curve
from ..curve.pins import holds
from ..energies.edge_pairs import EdgePairs
from ..solve.saddle.tangent_space import factorised
from .contacts import Contacts

FALL = 0.2  # of μ


def outward(curve: Curve) -> FloatArray:
    """Where ends of arcs are pulled, straight ahead; unit vectors of shape (arcs, 2, m)."""
    x, ends = curve.vertices, curve.mesh.ends
    ahead = x[ends] - x[ends + np.array([1, -1])]
    return np.asarray(ahead / np.linalg.norm(ahead, axis=2, keepdims=True))


@dataclass(eq=False)
class InteriorPoint:
    """The rope reached so far, of radius 1, and the forces z at its contacts.

    ``proved`` tells of vertices whether the straight motion there is proved that of a rope.  ``gap`` is Σ z c relative
    to the length, ``residual`` |∇f − Σ z ∇c| relative to |∇f|; both are 0 at the shortest rope.  Ends of arcs are held.
    ``basis``, (n, controls), makes vertices of unknowns; the identity, unless it is given.
    """

    curve: Curve
    mu: float
    proved: Callable[[FloatArray], bool]
    margin: float = 0.3  # of distances beyond 2, at which the barrier begins
    longest: float = 0.5  # that a vertex moves at once
    centred: float = 0.001  # decrease that Newton's step promises, in μ for each constraint, below which μ falls
    patience: int = 15  # steps that bring as little: then it falls, too
    basis: sp.csr_array | None = None
    proportions: FloatArray | None = None  # of edges; None for equally long ones
    drawn: float = 0.0  # out of the knot, by ends that were led on
    gap: float = field(default=np.inf, init=False)
    residual: float = field(default=np.inf, init=False)
    contacts: Contacts = field(init=False)
    forces: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        mesh = self.curve.mesh
        self._delta, self._counted = 0.0, 1.0
        self._least_margin = float(np.mean(self.curve.edge_lengths)) ** 2 / 8.0  # by that polygons' distances are off
        free = self.basis
        if free is None:
            free = sp.eye_array(mesh.size, format="csc")[:, ~holds(mesh, mesh.ends.ravel())]
        self._unknowns, self._coordinates = sp.csr_array(free), sp.csr_array(sp.kron(free, sp.eye_array(3)))
        self._list(Contacts.near(self.curve, 1.5 * self.margin))

    def run(self, gap: float | None, most: int = 400) -> Iterator[float]:
        """Yield the share of Newton's step that was taken, until the gap and a tenth of the residual are small.

        Without a gap it ends as soon as the rope is centred, and μ falls only with the squares of edges.
        """
        merits: list[float] = []
        weight = self.mu / float(np.mean(self.curve.edge_lengths)) ** 2
        for _ in range(most):
            check_time()
            share, decrement = self.step()
            little = self.centred * self.mu * len(self.forces)
            merits.append(self.merit)
            still = len(merits) > self.patience and merits[-1] > merits[-1 - self.patience] - little
            centred = decrement < little or still
            if gap is None and centred:
                return
            given_up = still and len(merits) > 4 * self.patience
            if gap is not None and self.gap <= gap and (self.residual <= 10.0 * gap or given_up):
                return
            yield share
            if gap is None:
                self.mu = min(self.mu, weight * float(np.mean(self.curve.edge_lengths)) ** 2)
            elif self.gap > gap and centred:
                fall = max(FALL, 0.7 * gap / self.gap)
                self.mu, self.margin = fall * self.mu, max(self._least_margin, fall**0.5 * self.margin)
                self._list()
                merits.clear()

    @property
    def merit(self) -> float:
        """The length without what was drawn out, and the barrier function: what comes down at one μ."""
        return self.curve.length - self.drawn + self._walls(self.contacts.values(self.curve.vertices))

    @property
    def excess(self) -> float:
        """The length of arcs, less how far out ends are where they are pulled: of straight ropes nothing is left."""
        pulled = np.sum(outward(self.curve) * self.curve.vertices[self.curve.mesh.ends])
        return float(self.curve.component_lengths @ ~np.asarray(self.curve.mesh.closed) - pulled)

    def step(self) -> tuple[float, float]:
        """Take a step; the share of Newton's that is taken, and by how much the barrier function was to fall."""
        x, mesh = self.curve.vertices, self.curve.mesh
        if np.linalg.norm(x - self._listed, axis=1).max() > 0.2 * self.margin:
            self._list()
        contacts, z = self.contacts, self.forces
        jet = contacts.jet(EdgePairs.of(mesh, x, contacts.i, contacts.j))
        c, first = jet.value, jet.first
        push = self._push(c)
        k = z / c + 2.0 * np.sqrt(self.mu * push / c) / self.margin
        # f = Σ w ℓ²/2 with these weights, to first order; elsewhere it is less
        p = np.ones(mesh.edges) if self.proportions is None else self.proportions
        sums, squares = (np.add.reduceat(each, mesh.edge_offsets[:-1]) for each in (p, self.curve.edge_lengths**2 / p))
        weight = np.sqrt(sums / squares)[mesh.edge_component] / p
        self._elastic = mesh.difference.T @ sp.diags_array(weight) @ mesh.difference
        slope = self._elastic @ x
        unknowns = self._unknowns
        residual = unknowns.T @ (slope - contacts.sum_of(first, z))
        gathered = (len(x) / unknowns.shape[1]) ** 0.5  # by so much forces on controls are larger, about
        self.residual = float(np.linalg.norm(residual) / np.linalg.norm(slope)) / gathered
        self.gap = float(z @ c) / self.curve.length
        right = contacts.sum_of(first, push) - slope
        factor = self._factorised(*contacts.second(x, first, z, k))

        def solve(force: FloatArray) -> FloatArray:
            return np.asarray(unknowns @ factor.solve((unknowns.T @ force).ravel()).reshape(-1, 3))

        dx = solve(right)
        decrement, dz = float(np.sum(right * dx)), push - z - k * contacts.along(first, dx)

        def taken(share: float) -> tuple[FloatArray, float, FloatArray] | None:
            """Where a share of the step leads, if that may be: vertices, the barrier function, and all c."""
            there = x + share * dx + share * share * bend
            value, values = self._barrier(there)
            falls = value <= now - 1e-4 * share * decrement + 1e-13 * abs(now) and bool((values > 0.1 * c).all())
            return (there, value, values) if falls and self.proved(there) else None

        now, longest = self._barrier(x)[0], self.longest / max(float(np.linalg.norm(dx, axis=1).max()), 1e-12)
        share = min(1.0, longest)
        # walls are curved: the way bends so that constraints change as they would along a straight one
        missed = c + share * contacts.along(first, dx) - contacts.values(x + share * dx)
        bend = solve(contacts.sum_of(first, k * missed))
        bend *= (np.linalg.norm(bend, axis=1).max() < share * np.linalg.norm(dx, axis=1).max()) / share**2
        while (found := taken(share)) is None:
            share *= 0.6
            if share < 1e-8:
                self._delta = max(4.0 * self._delta, 1e-4)
                return 0.0, decrement
        while self._delta > 0.0 and 1.0 <= share <= 0.5 * longest:  # δ may have made the step far too short
            further = taken(2.0 * share)
            if further is None or further[1] >= found[1]:
                break
            found, share = further, 2.0 * share
        if share > 0.2:  # with ½ open ropes stay where steps are too short
            self._delta = self._delta / 4.0 if self._delta > 1e-6 else 0.0
        elif share < 0.02:
            self._delta = max(4.0 * self._delta, 1e-4)
        there, _, values = found
        self.curve = self.curve.with_vertices(there)
        push = self._push(values)
        self.forces = np.clip(z + dz, push / 20.0, 20.0 * push)  # one by one: some of those far away always vanish
        return share, decrement

    def _push(self, c: FloatArray) -> FloatArray:
        """−B', the forces of a centred rope."""
        return self.mu * np.clip(1.0 - c / self.margin, 0.0, None) ** 2 / c

    def _walls(self, c: FloatArray) -> float:
        """Σ B; infinite on walls and behind them."""
        if not (c > 0.0).all():
            return np.inf
        x = np.minimum(c / self.margin, 1.0)
        return -self.mu * float((np.log(x) - 2.0 * (x - 1.0) + 0.5 * (x * x - 1.0)).sum())

    def _barrier(self, vertices: FloatArray) -> tuple[float, FloatArray]:
        """f + Σ B, with f as about the present rope, over all c, and those listed."""
        values = self.contacts.values(vertices)
        walls = self._walls(values)
        if np.isfinite(walls) and np.linalg.norm(vertices - self._listed, axis=1).max() > 0.25 * self.margin:
            walls = self._walls(Contacts.near(self.curve.with_vertices(vertices), self.margin).values(vertices))
        return 0.5 * float(np.sum(vertices * (self._elastic @ vertices))) + walls, values

    def _list(self, contacts: Contacts | None = None) -> None:
        """List the constraints again; those that remain keep their forces."""
        new, n = contacts or Contacts.near(self.curve, 1.5 * self.margin), self.curve.mesh.edges
        forces = self._push(new.values(self.curve.vertices))
        if contacts is None:
            old = self.contacts
            before, after = (each.i[: each.strands] * n + each.j[: each.strands] for each in (old, new))
            _, here, there = np.intersect1d(before, after, assume_unique=True, return_indices=True)
            forces[there] = self.forces[here]
            forces[new.strands :] = self.forces[old.strands :]
        self.contacts, self.forces, self._listed = new, forces, self.curve.vertices

    def _factorised(self, stiff: sp.csr_array, curved: sp.csr_array) -> SuperLU:
        """Factors of Newton's matrix by the unknowns, with so much of the walls' curvature that it is definite."""
        own = self._coordinates
        elastic = sp.csc_array(own.T @ sp.kron(self._elastic, sp.eye_array(3), format="csr") @ own)
        ridge = 1e-6 * elastic.diagonal().mean() * sp.eye_array(elastic.shape[0], format="csc")  # holds it in its place
        metric, curvature = elastic + 1e4 * ridge, own.T @ curved @ own
        matrix = own.T @ stiff @ own + elastic + ridge + self._delta * metric
        for shift in (0.0, 1e-4, 1e-3, 1e-2):  # negative eigenvalues that are small are lifted
            factor = factorised(matrix + curvature + shift * metric, symmetric=True)
            if (factor.U.diagonal() > 0.0).all():
                return factor
        self._counted = min(0.8, max(self._counted, 0.1) / 0.64)
        while True:
            factor = factorised(matrix + self._counted * curvature, symmetric=True)
            if self._counted == 0.0 or (factor.U.diagonal() > 0.0).all():
                return factor
            self._counted = 0.8 * self._counted if self._counted > 0.1 else 0.0
