"""Steps by the method asked for, and by another one where that cannot go on: never stuck while there is a way."""

from dataclasses import replace

import numpy as np

from .descent import METHODS, Method, NoStep, Point, State, Step

HELPER = METHODS["flow-h3-2"]  # its metric does not see how near strands are, and so does not hold them together
HELPS = 10  # steps it takes when the other method finds none
PROGRESS = 1e-6  # relative decrease of energy without which asking it again is no use


class Stepper:
    """A method with its memory, and how far another one has to help out.

    Parameters
    ----------
    method
        The method asked for.
    """

    def __init__(self, method: Method) -> None:
        self._method = self._last = method
        self._state = State()
        self._helps = 0  # steps that the helper is still to take
        self._helped_at = np.inf  # energy at which it was asked last

    def restart(self) -> None:
        """Forget everything, because the mesh, the constraints or the curve is another one."""
        self._state = State(None, self._state.last_step)
        self._helps, self._helped_at = 0, np.inf

    def step(self, point: Point) -> Step | NoStep:
        """Take a step; the helper takes it if the method finds none.

        The step's point belongs to the same problem.
        """
        if not self._may_help(point):
            return self._by(self._method, point)
        if self._helps:
            self._helps = max(0, self._helps - 1)
            step = self._by(HELPER, point)
            if isinstance(step, Step):
                return step
            self._helps = 0
        step = self._by(self._method, point)
        if isinstance(step, NoStep) and point.energy < (1.0 - PROGRESS) * self._helped_at:
            self._helps, self._helped_at = HELPS, point.energy
            helped = self._by(HELPER, point)
            return helped if isinstance(helped, Step) else step
        return step

    def _may_help(self, point: Point) -> bool:
        fits = len(point.vertices) <= HELPER.metric.most_vertices
        return fits and point.problem.geometry.prescribes and self._method is not HELPER

    def _by(self, method: Method, point: Point) -> Step | NoStep:
        if method is not self._last:
            self._last, self._state = method, State()
        problem = point.problem
        if method is HELPER and problem.metric is not HELPER.metric:
            point = point.within(replace(problem, metric=HELPER.metric))
        try:
            step, self._state = method.rule.step(point, self._state)
            if isinstance(step, Step):
                step = step.within(problem)
                step.point.gradient_norm  # noqa: B018 (computed here, where its failure can be told)
        except np.linalg.LinAlgError as error:
            return NoStep(f"the curve has become too degenerate: {error}")
        return step
