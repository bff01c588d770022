"""Where a relaxed curve has come to rest: at a minimum of the energy, or at a saddle."""

from dataclasses import dataclass, replace

from ...core import Curve, CurveError, RelaxOptions, Status, minimize

MAX_POINTS = 1500  # a dense eigenvalue problem: some fifteen seconds
_ITERATIONS = 100  # that lead from points rounded to Blender's numbers back to a critical point


@dataclass(frozen=True)
class Rest:
    """Where a curve rests.

    Attributes
    ----------
    index
        Number of independent directions that lead down, None if it is not at rest.
    words
        The same in words.
    """

    index: int | None
    words: str

    @classmethod
    def of(cls, curve: Curve, options: RelaxOptions) -> "Rest":
        """Look at the end of a relaxation that was done with these options.

        Raises
        ------
        MobiusFlowError
            If the curve has too many points, or the options leave no way to tell.
        """
        if len(curve) > MAX_POINTS:
            raise CurveError(f"The curves have {len(curve)} points; minimum or saddle is told up to {MAX_POINTS}")
        options = replace(options, vertices=len(curve), max_iterations=_ITERATIONS)
        result = minimize(curve, replace(options, stability=True, escape_saddles=False, balance=False))
        index = result.outcome.negative_eigenvalues
        if result.status is Status.ITERATION_LIMIT:
            return cls(None, "not at rest yet; press Continue first")
        if index is None:
            return cls(None, result.message)
        if not index:
            return cls(0, "at a minimum, no small motion lowers the energy")
        ways = "one way leads" if index == 1 else f"{index} independent ways lead"
        return cls(index, f"at a saddle, {ways} down; press Leave Saddle")
