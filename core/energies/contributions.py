"""Local contributions W of pairs of straight edges, as jets in (Δ, e, f)."""

from dataclasses import dataclass
from functools import cached_property

from .edge_pairs import DELTA, E, EdgePairs, F
from .inverse_square import inverse_square
from .jets import Jet


@dataclass(frozen=True, eq=False)
class Contributions:
    """What the barrier needs of pairs of edges."""

    pairs: EdgePairs

    @cached_property
    def _square(self) -> Jet:
        """|Δ|²."""
        return self.pairs.inner(DELTA, DELTA)

    @cached_property
    def _lengths(self) -> tuple[Jet, Jet]:
        """|e| and |f|."""
        return self.pairs.inner(E, E).sqrt(), self.pairs.inner(F, F).sqrt()

    @cached_property
    def _area(self) -> Jet:
        """|e| |f|."""
        return self._lengths[0] * self._lengths[1]

    def closeness(self) -> Jet:
        """q = |Δ|²/(|e| + |f|)²."""
        total = self._lengths[0] + self._lengths[1]
        return self._square * (total * total).reciprocal()

    def midpoint(self) -> Jet:
        """W_mid = (|e||f| + ⟨e, f⟩)/|Δ|² − 2 ⟨Δ, e⟩⟨Δ, f⟩/|Δ|⁴, the one-point rule."""
        s = self._square.reciprocal()
        p, q = self.pairs.inner(DELTA, E) * s, self.pairs.inner(DELTA, F) * s
        return (self._area + self.pairs.inner(E, F)) * s - (p * q).scaled(2.0)

    def exact(self) -> Jet:
        """W_exact = ∬ (1 − cos α)/r² over both edges, however near they are.

        The cosine part is elementary, a logarithm of the cross ratio of the four end points; only ∬ 1/r²
        needs quadrature.  Relative error of the values at most 1e-8; edges must not touch.
        """
        return self._area * inverse_square(self.pairs) - self._log_cross_ratio()

    def _log_cross_ratio(self) -> Jet:
        """∬ cos α / r² = log(|x₁−y₁| |x₀−y₀| / (|x₁−y₀| |x₀−y₁|)) for edges from x₀ to x₁ and y₀ to y₁."""

        def log_square(x: float, y: float) -> Jet:
            return self.pairs.inner((1.0, x, -y), (1.0, x, -y)).log()

        same = log_square(0.5, 0.5) + log_square(-0.5, -0.5)
        return (same - log_square(0.5, -0.5) - log_square(-0.5, 0.5)).scaled(0.5)
