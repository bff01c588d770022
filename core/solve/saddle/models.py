"""Models of inner products, cheaply inverted: by symbols, what a wave along the curve costs by frequency; and of links.

Fast Fourier transforms serve where edges are alike, resolvents of the Laplacian along the curve for order 3/2 and any
edge lengths.  For λ > 0 we have λ^{-3/2} = 2/π ∫ σ^{1/2} (λ + σ)⁻² dσ and λ^{1/2} = 1/π ∫ σ^{-1/2} λ (λ + σ)⁻¹ dσ.  By
the trapezoidal rule in log σ both are sums over a few σ, and with a symbol f(σ) in place of σ^{3/2}, or one in place of
σ^{1/2}, slowly varying in comparison, they are near 1/f(λ), or near this one at λ.  Each resolvent is a sparse
factorisation with three entries a row, for all components at once: together several times slower than a Fourier
transform, but insensitive to the mesh.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
import scipy.sparse as sp
from scipy.fft import irfft, rfft

from ...base import FloatArray
from ...curve import Mesh
from .tangent_space import LinearMap, factorised

LEAST = 1e-6  # modulated value, relative to the largest one: where edges double back it may be 0

Symbol = Callable[[FloatArray], FloatArray]
"""A positive function of frequencies."""


class Model(Protocol):
    """An inner product M that is cheaply inverted."""

    def solve(self, f: FloatArray) -> FloatArray:
        """M⁻¹ f; shape (n, k)."""

    def tension(self, tangents: FloatArray) -> LinearMap:
        """A map near the inverse of Σ_k diag(t_k) D M⁻¹ Dᵀ diag(t_k), D the edge differences; (n,) to (n,).

        It leads from changes of edge lengths to tensions that cause them, for t = τ/ℓ of shape (n, m).
        """


@dataclass(frozen=True, eq=False)
class Parameter:
    """A way to run along the components of a mesh, each at its own constant speed: by index, or by arc length."""

    mesh: Mesh
    positions: FloatArray  # of each vertex, 0 at the first one of its component; shape (n,)
    periods: FloatArray  # of each component; shape (components,)

    @classmethod
    def of_steps(cls, mesh: Mesh, steps: FloatArray) -> "Parameter":
        """The parameter that grows by so much from each vertex to the next one; shape (n,)."""
        ends = np.cumsum(steps) - steps
        starts = mesh.offsets[:-1]
        return cls(mesh, ends - ends[starts][mesh.component], np.add.reduceat(steps, starts))

    def waves(self, frequencies: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Cosines and sines of about these frequencies, 0 on components that are too short; shapes (n, k)."""
        turns = np.rint(np.multiply.outer(self.periods, frequencies) / (2.0 * np.pi))
        phase = (2.0 * np.pi * turns / self.periods[:, None])[self.mesh.component] * self.positions[:, None]
        # of either sign at random, lest components move together
        signs = np.random.default_rng(1).choice(np.array([-1.0, 1.0]), len(self.periods))
        amplitude = ((turns > 0.0) * signs[:, None])[self.mesh.component]
        return amplitude * np.cos(phase), amplitude * np.sin(phase)

    def symbol(self, apply: LinearMap, weights: FloatArray, highest: float) -> Symbol:
        """Rayleigh quotients Σ u A u / Σ w u² of waves u, interpolated between logarithms.

        Below the lowest frequency, one turn, the symbol is constant; above the ``highest`` one tried, in radians per
        unit of the parameter, it grows like its third power, as that of an inner product of order 3/2 does.  ``apply``
        is u to A u, (n, k) to (n, k), ``weights`` w has shape (n,).  A LinAlgError says if a quotient is not positive.
        """
        turn = 2.0 * np.pi / float(self.periods.max())
        # more than twelve, spread evenly on a logarithmic scale, do not save an iteration
        frequencies = turn * np.unique(np.rint(np.geomspace(1.0, max(1.0, highest / turn), 12)))
        waves = np.stack(self.waves(frequencies))
        images = np.stack([apply(wave) for wave in waves])
        quotients = np.sum(waves * images, axis=(0, 1)) / np.sum(weights[:, None] * waves**2, axis=(0, 1))
        constant = np.ones((len(weights), 1))
        rounding = 100.0 * np.finfo(np.float64).eps * float(np.abs(apply(constant)).sum() / weights.sum())
        if not quotients.min() > rounding:
            raise np.linalg.LinAlgError("matrix is not positive definite: a Rayleigh quotient is not positive")
        logarithms, last = (np.log(frequencies), np.log(quotients)), frequencies[-1]
        return lambda f: np.exp(np.interp(np.log(np.maximum(f, turn)), *logarithms)) * np.maximum(f / last, 1.0) ** 3


def autocorrelation(t: FloatArray) -> FloatArray:
    """Means of ⟨t_I, t_{I+d}⟩ over I, for t of period k; shapes (..., k, m) -> (..., k)."""
    count = t.shape[-2]
    return np.asarray(irfft(np.sum(np.abs(rfft(t, axis=-2)) ** 2, axis=-1), count) / count)


def modulated(symbol: Symbol, tau: FloatArray, lengths: FloatArray) -> Symbol:
    """What Σ_k diag(τ_k) K diag(τ_k) costs waves on edges, on an average along the curve, for K of a symbol.

    The kernel of K is multiplied by the autocorrelation of τ, on a uniform grid on which components follow each other.
    Waves that are too short for this grid do not see the curve turn.  Unit tangents have shape (edges, m), edge
    ``lengths`` (edges,).
    """
    ends, count = np.cumsum(lengths), 2 * len(lengths)
    spacing = ends[-1] / count
    nearest = np.searchsorted(ends[:-1], spacing * (np.arange(count) + 0.5))
    frequencies = 2.0 * np.pi / ends[-1] * np.arange(count // 2 + 1)
    values = rfft(autocorrelation(tau[nearest]) * irfft(symbol(frequencies), count)).real
    values = np.maximum(values, LEAST * values.max())
    return lambda f: np.where(f < frequencies[-1], np.interp(f, frequencies, values), symbol(f))


class Circulants:
    """M = W⁻¹ F W⁻¹, F circulant on each component, of one symbol, and W the mean edge length of the component.

    For edges of similar lengths: on a polygon of equal edges the seminorm of W^{3/2,2} is a circulant matrix, and J_C
    is spectrally equivalent to one.  It grows like ℓ⁻² with the edge length ℓ.  Where this varies from component to
    component, u/ℓ is the right unknown; along one component it is not, because multiplying by a function with jumps is
    not bounded in W^{3/2,2}: iterations would grow with n, whereas with one scale they only grow with the ratio of
    lengths.

    A model of the product ``apply``, u to A u, (n, k) to (n, k), on a mesh of closed components; ``lengths`` are those
    of the edges, shape (n,).  A LinAlgError says if A is not positive definite.
    """

    def __init__(self, mesh: Mesh, lengths: FloatArray, apply: LinearMap) -> None:
        self._transform = ComponentTransform(mesh)
        sizes = np.asarray(mesh.component_sizes)
        means = np.add.reduceat(lengths, mesh.offsets[:-1]) / sizes
        self._scale = means[mesh.component, None]
        one = np.ones(mesh.size)
        symbol = Parameter.of_steps(mesh, one).symbol(lambda v: self._scale * apply(self._scale * v), one, np.pi)
        values = self._transform.sampled(symbol)
        scales = (means[sizes == size, None] for size in np.unique(sizes))
        self._inverse = [scale**2 / value for scale, value in zip(scales, values, strict=True)]
        stretches = self._transform.sampled(lambda theta: 4.0 * np.sin(0.5 * theta) ** 2)
        self._compliance = [stretch / value for value, stretch in zip(values, stretches, strict=True)]

    def solve(self, f: FloatArray) -> FloatArray:
        return self._transform.filtered(f, self._inverse)

    def tension(self, tangents: FloatArray) -> LinearMap:
        """With D F⁻¹ Dᵀ, which is circulant, modulated by the directions of edges."""
        weighted = self._scale * tangents
        size = np.linalg.norm(weighted, axis=1, keepdims=True)
        # Factors of the circulant matrices nearest to Σ_k diag(t_k) F diag(t_k), whose entries are the means along the
        # diagonals: those of F times the autocorrelation of t (Chan, An optimal circulant preconditioner for Toeplitz
        # systems, SIAM J. Sci. Stat. Comput. 9, 1988)
        components = zip(self._transform.sizes, self._transform.rows, self._compliance, strict=True)
        modulated = (rfft(autocorrelation((weighted / size)[rows]) * irfft(f, n)).real for n, rows, f in components)
        factors = [1.0 / np.maximum(each, LEAST * each.max(axis=1, keepdims=True)) for each in modulated]
        return lambda g: self._transform.filtered(g[:, None] / size, factors)[:, 0] / size[:, 0]


class ComponentTransform:
    """Products with circulant matrices, one of the same symbol on each component.

    Components of one size are transformed together.  There are at most √(2n) different sizes, so thousands of small
    components are no slower than a large one.
    """

    def __init__(self, mesh: Mesh) -> None:
        sizes = np.asarray(mesh.component_sizes)
        self.sizes = [int(size) for size in np.unique(sizes)]
        self.rows = [mesh.offsets[:-1][sizes == size, None] + np.arange(size) for size in self.sizes]

    def sampled(self, symbol: Symbol) -> list[FloatArray]:
        """A symbol at the angles θ ∈ [0, π] from vertex to vertex that every size of components has."""
        return [symbol(2.0 * np.pi / size * np.arange(size // 2 + 1, dtype=np.float64)) for size in self.sizes]

    def filtered(self, u: FloatArray, factors: list[FloatArray]) -> FloatArray:
        """Circulant matrices of factors, which may be the same for all components of a size, times u; shape (n, k)."""
        if len(self.sizes) == 1:  # all components, one after the other
            return _filtered(u.reshape(-1, self.sizes[0], u.shape[1]), factors[0]).reshape(u.shape)
        result = np.empty_like(u)
        for rows, factor in zip(self.rows, factors, strict=True):
            result[rows] = _filtered(u[rows], factor)
        return result


def _filtered(u: FloatArray, factor: FloatArray) -> FloatArray:
    """Of components of one size; shape (components, size, k)."""
    waves = rfft(u, axis=1)
    waves *= factor[..., None]
    return np.asarray(irfft(waves, u.shape[1], axis=1))


class TwoLevel:
    """M⁻¹ = M₀⁻¹ + Z E⁻¹ Zᵀ with E = coupling + V Vᵀ, Z the indicators of the components.

    Components of a link hold each other like masses on springs.  Their graph may be long, such as that of a chain,
    which a model M₀ along the components, ``fine``, does not see; a sparse factorisation of one row a component does.
    ``coupling`` is positive semidefinite, ``vectors`` V have shape (components, r).  A LinAlgError says if E is
    singular.
    """

    def __init__(self, mesh: Mesh, fine: Model, coupling: sp.sparray, vectors: FloatArray) -> None:
        self._fine = fine
        self.tension = fine.tension  # as a whole components have no edge differences
        self._component, self._starts = mesh.component, mesh.offsets[:-1]
        self._rank = vectors.shape[1]
        border = sp.csr_array(vectors)
        # V Vᵀ would be dense
        self._factor = factorised(sp.block_array([[coupling, border], [border.T, -sp.eye_array(self._rank)]]))

    def solve(self, f: FloatArray) -> FloatArray:
        force = np.add.reduceat(f, self._starts, axis=0)
        padded = np.concatenate([force, np.zeros((self._rank, f.shape[1]))])
        shift = self._factor.solve(padded)[: len(force)]
        return np.asarray(self._fine.solve(f) + shift.take(self._component, axis=0))


class Resolvents:
    """M = f(−Δ) with the symbol f of an inner product, −Δ the Laplacian of linear elements with lumped mass.

    A model of the product ``apply``, u to A u, (n, k) to (n, k); ``lengths`` ℓ are those of the edges, shape (edges,).
    A LinAlgError says if A is not positive definite.
    """

    spacing: ClassVar[float] = 3.5  # of log σ: with 2.3 there is no iteration less, with 5 there are half as many more

    def __init__(self, mesh: Mesh, lengths: FloatArray, apply: LinearMap) -> None:
        mass, d = 0.5 * mesh.scatter(lengths, lengths), mesh.difference
        parameter = Parameter.of_steps(mesh, mesh.at_tails(lengths))
        # nine in ten edges are shorter than half of any wave tried
        symbol = parameter.symbol(apply, mass, np.pi / float(np.quantile(lengths, 0.9)))
        least, largest = (2.0 * np.pi / float(parameter.periods.max())) ** 2, 4.0 / float(lengths.min()) ** 2
        sigma = np.exp(np.arange(np.log(least), np.log(largest) + self.spacing, self.spacing))
        self._mass, self._lengths = mass[:, None], lengths[:, None]
        at_vertices = d.T @ sp.diags_array(1.0 / lengths) @ d
        at_edges = d @ sp.diags_array(1.0 / mass) @ d.T
        self._weights = 2.0 / np.pi * self.spacing * sigma**2 / symbol(np.sqrt(sigma))
        self._sigma, self._symbol = sigma, symbol
        self._at_vertices = [factorised(at_vertices + s * sp.diags_array(mass)) for s in sigma]
        self._at_edges = [factorised(at_edges + s * sp.diags_array(lengths)) for s in sigma]

    def solve(self, f: FloatArray) -> FloatArray:
        total = np.zeros_like(f)
        for weight, factor in zip(self._weights, self._at_vertices, strict=True):
            total += weight * factor.solve(self._mass * factor.solve(f))
        return total

    def tension(self, tangents: FloatArray) -> LinearMap:
        """By λ^{1/2} with the inverse of the modulated symbol, which is constant on long waves, in place of σ^{1/2}."""
        lengths = self._lengths[:, 0]
        symbol = modulated(lambda w: w**2 / self._symbol(w), tangents * self._lengths, lengths)
        stiffness = np.maximum.accumulate(1.0 / symbol(np.sqrt(self._sigma)))
        weights = self.spacing / np.pi * (stiffness - stiffness[0])

        def tension(change: FloatArray) -> FloatArray:
            right = lengths * change
            total = (stiffness[0] + np.sum(weights)) * change
            for weight, factor in zip(self._sigma * weights, self._at_edges, strict=True):
                total -= weight * factor.solve(right)
            return np.asarray(lengths * total)

        return tension
