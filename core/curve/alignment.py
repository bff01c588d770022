"""Best ways to lay one shape on another: over rotations, starting points, directions and orders of components.

Strands are compared at samples that are evenly spread over each component.  For a given rotation the best starting
points of all pairs of components are maxima of cross-correlations, which an FFT gives for all of them; for given
starting points the best rotation is Kabsch's (Acta Cryst. A 32, 1976).  Alternating between the two climbs to a
maximum from each of many rotations.
"""

from dataclasses import dataclass
from itertools import compress

import numpy as np
from scipy.spatial.transform import Rotation

from ..base import FloatArray
from .curve import Curve
from .refine import evenly

SAMPLES = 256  # of a component: half a spacing is some 0.01 radii of gyration


@dataclass(frozen=True, eq=False)
class Freedom:
    """The similarities that are allowed: rotations about any axis, or about one; and shifts and scalings, or none."""

    axis: FloatArray | None = None  # the only axis, of length 1, or 0 for no rotations; shape (3,)
    fixed: FloatArray | None = None  # a point that neither shifts nor scalings may move; shape (3,)

    def best(self, covariances: FloatArray) -> FloatArray:
        """The rotations R with the largest tr(RᵀK), of each K = Σ y xᵀ; shapes (k, 3, 3)."""
        if self.axis is None:
            u, _, v = np.linalg.svd(covariances)
            u[:, :, 2] *= np.linalg.det(u @ v)[:, None]
            return np.asarray(u @ v)
        across = np.cross(np.eye(3), self.axis)  # the matrix of u ↦ axis × u
        cosine = np.trace(covariances, axis1=1, axis2=2) - self.axis @ covariances @ self.axis
        return _about(self.axis, np.arctan2(np.einsum("ij,kij->k", across, covariances), cosine))

    def starts(self) -> FloatArray:
        """Rotations all over, the identity first; shape (k, 3, 3)."""
        if self.axis is not None:
            return _about(self.axis, np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False))
        turns = np.random.default_rng(1).normal(size=(400, 4))
        return np.asarray(Rotation.from_quat(np.concatenate([[[0, 0, 0, 1]], turns])).as_matrix())


def _about(axis: FloatArray, angles: FloatArray) -> FloatArray:
    return np.asarray(Rotation.from_rotvec(angles[:, None] * axis).as_matrix())


@dataclass(frozen=True, eq=False)
class Alignment:
    """The similarity x ↦ target + scale · R (x − source) that takes a curve approximately to another one."""

    rotation: FloatArray  # R, shape (3, 3)
    scale: float
    source: FloatArray
    target: FloatArray
    order: tuple[int, ...]  # for each of its components the matching one of the other
    backwards: tuple[bool, ...]  # whether that is traversed in its opposite direction
    begins: tuple[float, ...]  # the share of its length, so traversed, at which the curve's first vertex lies
    distance: float  # that remains, root mean square, in radii of gyration
    angle: float  # of the rotation, in radians

    @property
    def as_given(self) -> bool:
        """Whether components keep their order and their directions."""
        return self.order == tuple(range(len(self.order))) and not any(self.backwards)

    @property
    def cost(self) -> float:
        """The quantity to minimise: the distance, and a bit for changes of order or direction and for rotations."""
        # in radii of gyration, by which one may lie worse that keeps directions and order, or needs no rotation
        return self.distance + 0.03 * (not self.as_given) + 0.01 * self.angle / np.pi

    def moved(self, vertices: FloatArray, share: float) -> FloatArray:
        """Vertices, shape (n, m), after a share of the motion."""
        rotation = Rotation.from_rotvec(share * Rotation.from_matrix(self.rotation).as_rotvec()).as_matrix()
        m = vertices.shape[1]
        place = (self.source + share * (self.target - self.source))[:m]
        return np.asarray(place + self.scale**share * (vertices - self.source[:m]) @ rotation[:m, :m].T)


def alignments(curve: Curve, other: Curve, freedom: Freedom) -> list[Alignment]:
    """Ways to lay a curve upon another one with as many components, closed and open ones; the best first."""
    from scipy.optimize import linear_sum_assignment  # which takes a while to import

    x, y = _samples(curve), _samples(other)
    source, target = (each.mean(axis=(0, 1)) if freedom.fixed is None else freedom.fixed for each in (x, y))
    radii = [np.sqrt(np.square(each).sum(axis=2).mean()) for each in (x - source, y - target)]
    scale = 1.0 if freedom.fixed is not None else float(radii[1] / radii[0])
    x, y = scale * (x - source) / radii[1], (y - target) / radii[1]
    # cross-correlations Σ_k y_{k+s} x_kᵀ of all pairs of components, in both directions, at all s.  Open components are
    # held at their ends: each is compared only with the one of its number, in the same direction
    closed, other_closed, count = np.array(curve.mesh.closed), np.array(other.mesh.closed), len(x)
    back = y[:, ::-1].copy()
    back[other_closed] = np.roll(back[other_closed], 1, axis=1)  # from the first vertex, too
    spectra = np.fft.rfft(np.stack([y, back]), axis=2), np.fft.rfft(x, axis=1).conj()
    products = np.fft.irfft(np.einsum("deka,ckb->cedkab", *spectra), SAMPLES, axis=3)
    correlations = products.reshape(count, count, 2 * SAMPLES, 9)
    allowed = np.repeat((closed[:, None] & other_closed)[:, :, None], 2 * SAMPLES, axis=2)
    allowed[~closed, ~closed, 0] = True
    rotations, rows = freedom.starts(), np.arange(count)
    for _ in range(12):
        # each rotation's best directions and shifts of all pairs, then the best order of components
        flat = rotations.reshape(-1, 9)
        scores, where = np.empty((count, count, len(flat))), np.empty((count, count, len(flat)), dtype=np.intp)
        for c, e in np.ndindex(count, count):
            values = np.where(allowed[c, e, :, None], correlations[c, e] @ flat.T, -1e300)
            scores[c, e], where[c, e] = values.max(axis=0), values.argmax(axis=0)
        orders = np.array([linear_sum_assignment(-scores[:, :, k])[1] for k in range(len(flat))])
        chosen = where[rows, orders, np.arange(len(flat))[:, None]]
        covariances = correlations[rows, orders, chosen].sum(axis=1).reshape(-1, 3, 3)
        before, rotations = rotations, freedom.best(covariances)
        if np.allclose(rotations, before):
            break
    squares = np.square(x).sum() + np.square(y).sum() - 2.0 * np.einsum("kij,kij->k", rotations, covariances)
    distances = np.sqrt(np.maximum(squares, 0.0) / (len(y) * SAMPLES))
    turned = chosen >= SAMPLES
    angles = Rotation.from_matrix(rotations).magnitude()
    columns = orders.tolist(), turned.tolist(), chosen % SAMPLES / SAMPLES, distances.tolist(), angles.tolist()
    found = [
        Alignment(rotation, scale, source, target, tuple(order), tuple(back), tuple(begin), distance, angle)
        for rotation, order, back, begin, distance, angle in zip(rotations, *columns, strict=True)
    ]
    found.sort(key=lambda each: each.cost)
    left = np.array([each.rotation for each in found])
    distinct: list[Alignment] = []
    while found:
        distinct.append(found[0])
        others = np.linalg.norm(left - left[0], axis=(1, 2)) > 0.3
        found, left = list(compress(found, others)), left[others]
    return distinct


def _samples(curve: Curve) -> FloatArray:
    """Points evenly spread along each component, in space; shape (components, samples, 3)."""
    found = np.zeros((len(curve.components), SAMPLES, 3))
    for k, (part, closed) in enumerate(zip(curve.components, curve.mesh.closed, strict=True)):
        found[k, :, : curve.dimension] = evenly(part, closed, SAMPLES)
    return found
