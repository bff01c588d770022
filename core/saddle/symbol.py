"""The symbol of an inner product: what it costs a wave along the curve, by frequency."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.fft import irfft, rfft

from ..curve import Mesh
from ..types import FloatArray
from .krylov import LinearMap

FREQUENCIES = 12  # at which waves are tried, spread evenly on a logarithmic scale; more do not save an iteration
LEAST = 1e-6  # modulated value, relative to the largest one: where edges double back it may be 0

Symbol = Callable[[FloatArray], FloatArray]
"""A positive function of frequencies."""


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
        signs = np.random.default_rng(1).choice([-1.0, 1.0], len(self.periods))
        amplitude = ((turns > 0.0) * signs[:, None])[self.mesh.component]
        return amplitude * np.cos(phase), amplitude * np.sin(phase)

    def symbol(self, apply: LinearMap, weights: FloatArray, highest: float) -> Symbol:
        """Rayleigh quotients Σ u A u / Σ w u² of waves u, interpolated between logarithms.

        Below the lowest frequency, one turn, the symbol is constant; above the ``highest`` one tried, in radians per
        unit of the parameter, it grows like its third power, as that of an inner product of order 3/2 does.  ``apply``
        is u to A u, (n, k) to (n, k), ``weights`` w has shape (n,).  A LinAlgError says if a quotient is not positive.
        """
        turn = 2.0 * np.pi / float(self.periods.max())
        frequencies = turn * np.unique(np.rint(np.geomspace(1.0, max(1.0, highest / turn), FREQUENCIES)))
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
