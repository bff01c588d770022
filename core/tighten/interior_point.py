"""The shortest rope of radius 1: a primal–dual interior-point method, whose multipliers are the forces at contacts.

    minimise  f = Σ √(m Σ ℓ²)  over components of m edges,  subject to  c ≥ 0  (`contacts`)

f is the length where edges are equally long, and makes them so.  Steps are Newton's for  ∇f = Σ z ∇c  and  z c = μ:

    (D²f − Σ z D²c + Σ (z/c) ∇c ∇cᵀ + δ D²f) dx = −∇f + Σ (μ/c) ∇c,    dz = μ/c − z − (z/c) ⟨∇c, dx⟩,

where δ makes the matrix definite, and more where steps are too long.  Of a step so much is taken that the barrier
function f − μ Σ log c falls enough, no c loses nearly all of itself, no vertex moves more than half a radius, and the
motion is proved.  μ falls as soon as the rope is centred, that is, when steps promise little more (Nocedal and Wright,
*Numerical Optimization*, chapter 19).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, eigsh

from ..base.deadline import check_time
from ..base.types import FloatArray
from ..curve import Curve
from ..curve.pins import holds
from ..energies.edge_pairs import EdgePairs
from ..solve.symmetric import factorised
from .contacts import Contacts

CENTRED = 0.001  # decrease that Newton's step promises, in μ for each constraint, below which μ falls
PATIENCE = 15  # steps
WEIGHT = 0.03  # of the barrier
LONGEST = 0.5  # that a vertex moves at once, in radii: strands cannot change places
LEAST_MARGIN = 0.005


@dataclass(eq=False)
class InteriorPoint:
    """The rope reached so far, of radius 1, and the forces z at its contacts.

    ``proved`` tells of vertices whether the straight motion there is proved that of a rope.  ``gap`` is Σ z c relative
    to the length, ``residual`` |∇f − Σ z ∇c| relative to |∇f|; both are 0 at the shortest rope.  Ends of arcs are held.
    """

    curve: Curve
    mu: float
    proved: Callable[[FloatArray], bool]
    margin: float = 0.3  # of distances beyond 2, up to which strands are constraints
    gap: float = field(default=np.inf, init=False)
    residual: float = field(default=np.inf, init=False)

    def __post_init__(self) -> None:
        self.contacts = Contacts.near(self.curve, 1.5 * self.margin)
        self.forces = self._aims(self.contacts.values(self.curve.vertices))[0]
        self._listed, self._delta = self.curve.vertices, 0.0
        self._depth = 1.0
        self._free = ~holds(self.curve.mesh, self.curve.mesh.ends.ravel())

    def run(self, gap: float | None = None, most: int = 400) -> Iterator[float]:
        """Yield the share of Newton's step that was taken, until the rope is centred, and the gap this small."""
        merits: list[float] = []
        for _ in range(most):
            check_time()
            share, decrement = self.step()
            little = CENTRED * self.mu * len(self.forces)
            merits.append(self.excess + self._walls(self.contacts.values(self.curve.vertices)))
            still = len(merits) > PATIENCE and merits[-1] > merits[-1 - PATIENCE] - little
            least = self.mu if gap is None else 0.5 * gap * self.curve.length / len(self.forces)
            if gap is None:
                self.mu = min(self.mu, WEIGHT * float(np.mean(self.curve.edge_lengths)) ** 2)
                if decrement < little or still:
                    return
            elif self.gap <= gap and (self.residual <= 10.0 * gap or (still and self.mu <= least)):
                return
            yield share
            if self.mu > least and (decrement < little or still):
                fall = max(0.2, least / self.mu)
                self.mu *= fall
                self.margin = max(LEAST_MARGIN, self.margin * fall**0.5)
                self._list()
                merits = []

    @property
    def excess(self) -> float:
        """The length, less how far out ends are in their own directions: of straight ropes nothing is left."""
        x, (first, last) = self.curve.vertices, self.curve.mesh.ends.T
        ends, inner = np.append(first, last), np.append(first + 1, last - 1)
        outward = (x[ends] - x[inner]) / np.linalg.norm(x[ends] - x[inner], axis=1)[:, None]
        return self.curve.length - float(np.sum(outward * x[ends]))

    def step(self) -> tuple[float, float]:
        """Take a step; the share of Newton's that is taken, and by how much the barrier function was to fall."""
        x, mesh = self.curve.vertices, self.curve.mesh
        moved = float(np.linalg.norm(x - self._listed, axis=1).max())
        if moved > 0.2 * self.margin:
            self._list()
        contacts, z, mu = self.contacts, self.forces, self.mu
        jet = contacts.jet(EdgePairs.of(mesh, x, contacts.i, contacts.j))
        c, first = jet.value, jet.first
        aim, stiff = self._aims(jet.value)
        k = z / c + stiff
        # f = Σ w ℓ²/2 with these weights, to first order; elsewhere it is less
        squares = np.add.reduceat(self.curve.edge_lengths**2, mesh.edge_offsets[:-1])
        weight = np.sqrt(mesh.edge_counts / squares)
        self._elastic = mesh.difference.T @ sp.diags_array(weight[mesh.edge_component]) @ mesh.difference
        slope = self._elastic @ x
        residual = (slope - contacts.sum_of(first, z))[self._free]
        self.residual = float(np.linalg.norm(residual) / np.linalg.norm(slope))
        self.gap = float(z @ c) / self.curve.length
        right = contacts.sum_of(first, aim) - slope
        solve = self._factorised(contacts.hessian(x, first, z, k))
        dx = solve(right)
        decrement, dz = float(np.sum(right * dx)), aim - z - k * contacts.along(first, dx)

        def taken(share: float) -> tuple[FloatArray, float, FloatArray] | None:
            """Where a share of the step leads, if that may be: vertices, the barrier function, and all c."""
            there = x + share * dx + share * share * bend
            value, values = self._barrier(there)
            falls = value <= now - 1e-4 * share * decrement + 1e-13 * abs(now) and bool((values > 0.1 * c).all())
            return (there, value, values) if falls and self.proved(there) else None

        now, longest = self._barrier(x)[0], LONGEST / max(float(np.linalg.norm(dx, axis=1).max()), 1e-12)
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
        if share > 0.5:
            self._delta = self._delta / 4.0 if self._delta > 1e-6 else 0.0
        elif share < 0.02:
            self._delta = max(4.0 * self._delta, 1e-4)
        there, _, values = found
        self.curve = self.curve.with_vertices(there)
        shrinking = dz < 0.0
        most = min(1.0, 0.98 * float((-z[shrinking] / dz[shrinking]).min(initial=np.inf)))
        aim = self._aims(values)[0]
        self.forces = np.clip(z + most * dz, aim / 20.0, 20.0 * aim)
        return share, decrement

    def _aims(self, c):
        """B' and B''-part."""
        share = np.clip(1.0 - c / self.margin, 0.0, None)
        return self.mu * share**2 / c, 2.0 * self.mu * share / (self.margin * c)

    def _barrier(self, vertices: FloatArray) -> tuple[float, FloatArray]:
        """f + B, with f as about the present rope, and all c."""
        values = self.contacts.values(vertices)
        if np.linalg.norm(vertices - self._listed, axis=1).max() > 0.25 * self.margin:
            there = Contacts.near(self.curve.with_vertices(vertices), self.margin).values(vertices)
        else:
            there = values
        if not ((there > 0.0).all() and (values > 0.0).all()):
            return np.inf, values
        return 0.5 * float(np.sum(vertices * (self._elastic @ vertices))) + self._walls(there), values

    def _walls(self, values: FloatArray) -> float:
        x = np.minimum(values / self.margin, 1.0)
        return -self.mu * float((np.log(x) - 2.0 * (x - 1.0) + 0.5 * (x * x - 1.0)).sum())

    def _list(self) -> None:
        """List the constraints again; those that remain keep their forces."""
        old, n = self.contacts, self.curve.mesh.edges
        self.contacts = new = Contacts.near(self.curve, 1.5 * self.margin)
        forces = self._aims(new.values(self.curve.vertices))[0]
        before, after = (each.i[: each.strands] * n + each.j[: each.strands] for each in (old, new))
        _, here, there = np.intersect1d(before, after, assume_unique=True, return_indices=True)
        forces[there] = self.forces[here]
        forces[new.strands :] = self.forces[old.strands :]
        self.forces, self._listed = forces, self.curve.vertices

    def _factorised(self, hessian: sp.csr_array) -> Callable[[FloatArray], FloatArray]:
        """Solve with Newton's matrix, whose negative eigenvalues change sign, as they do in saddle-free Newton steps."""
        elastic = sp.kron(self._elastic, sp.eye_array(3), format="csr")
        free = np.flatnonzero(np.repeat(self._free, 3))
        ridge = 1e-6 * elastic.diagonal().mean() * sp.eye_array(elastic.shape[0], format="csr")  # holds it in its place
        metric = sp.csc_array((elastic + 1e4 * ridge)[free][:, free])
        matrix = sp.csc_array((hessian + elastic + ridge)[free][:, free]) + self._delta * metric
        factor = factorised(matrix)
        negative = int(np.sum(factor.U.diagonal() < 0.0))
        self.negative = negative
        lowest, modes = np.zeros(0), np.zeros((len(free), 0))
        if negative:
            while True:
                shifted = factorised(sp.csc_array(matrix + self._depth * metric))
                if (shifted.U.diagonal() > 0.0).all():
                    break
                self._depth *= 4.0
            inverse = LinearOperator(matrix.shape, matvec=shifted.solve, dtype=float)
            lowest, modes = eigsh(matrix, negative, metric, sigma=-self._depth, OPinv=inverse, tol=1e-3, v0=np.ones(len(free)))
            kept = lowest < 0.0
            lowest, modes = lowest[kept], modes[:, kept]
            self._depth = max(1e-3, 1.1 * -float(lowest.min(initial=0.0)))

        def solved(right: FloatArray) -> FloatArray:
            found, g = np.zeros_like(right), right[self._free].ravel()
            x = factor.solve(g) - modes @ (2.0 / lowest * (modes.T @ g))
            found[self._free] = x.reshape(-1, 3)
            return found

        return solved
