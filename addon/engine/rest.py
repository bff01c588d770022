"""Where a relaxed curve has come to rest: at a minimum of the energy, or at a saddle."""

from dataclasses import dataclass, replace

from ...core import Curve, CurveError, RelaxOptions, Status, Task, minimize
from ...core.messages import Message

MAX_POINTS = 1500  # some ten seconds
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
    def of(cls, curve: Curve | Task, options: RelaxOptions) -> "Rest":
        """Look at the end of a relaxation that was done with these options.

        Raises
        ------
        MobiusFlowError
            If the curve has too many points, or the options leave no way to tell.
        """
        task = Task.of(curve)
        if len(task.curve) > MAX_POINTS:
            raise CurveError(
                Message(
                    "The curves have {count} points; minimum or saddle is told up to {most}",
                    count=len(task.curve),
                    most=MAX_POINTS,
                )
            )
        options = replace(options.at_rest(task.curve), max_iterations=_ITERATIONS, stability=True)
        result = minimize(task, options)
        index = result.outcome.negative_eigenvalues
        if result.status is Status.ITERATION_LIMIT:
            return cls(None, Message("not at rest yet; press Continue first"))
        if index is None:
            return cls(None, result.message)
        if not index:
            return cls(0, Message("at a minimum, no small motion lowers the energy"))
        if index == 1:
            return cls(1, Message("at a saddle, one way leads down; press Leave Saddle"))
        return cls(index, Message("at a saddle, {count} independent ways lead down; press Leave Saddle", count=index))
